#pragma once
// Both ends of the wires in one process: for measuring and for tests that move time on by hand.
#include <algorithm>
#include <array>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "drivers/can/in_process_bus.h"
#include "firmware/robot/operator_desk.h"
#include "firmware/robot/realtime.h"
#include "firmware/robot/robot_file.h"
#include "firmware/robot/robot_loop.h"
#include "hal/sim/world.h"
#include "hil/emulators/byte_server.h"
#include "hil/far_end/far_devices.h"

namespace jaywalk::rig {

/// What scanner and encoders tell that is not so.
struct FalseSenses {
  BlankedSector repeats{0.0, 0.0};  ///< in the laser's frame: its ranges stay, but for noise and one beam that moves
  double mount_turned_rad = 0.0;    ///< the scanner in its mount
  bool counters_stand = false;      ///< both wheels' positions; their speeds go on
  bool speeds_stand = false;        ///< both wheels' speeds; their positions go on
  double feedback_ages = 0.0;       ///< seconds a second: the drives report what was, to half a second ago
  std::size_t scanner = 0;          ///< index of the scanner that these faults apply to
};

/// The simulated world as the far end of real wires: two drives turn its wheels, a scanner looks round in it. World
/// time is the clock's time since construction.
class SimulatedRobot {
 public:
  using Buses = std::array<CanBus*, 2>;

  /// `wiring` is the controller's side of the same wires; `buses`, a place on the bus for each drive, left and right,
  /// outlive it; `wires` are the scanners'. Throws StartupError.
  SimulatedRobot(const sim::Scenario& scenario, std::uint64_t seed, const RobotFile& wiring, const Buses& buses,
                 FarWires wires, Time now);

  void step(Time now);

  [[nodiscard]] const sim::Truth& truth() const noexcept { return world_.truth(); }
  [[nodiscard]] WheelDrive& drive(std::size_t side) noexcept { return *drives_[side]; }
  [[nodiscard]] emulators::ScannerServer& scanner(std::size_t index = 0) noexcept { return *eyes_[index]->scanner; }
  /// A second drive with the number of the one on this side comes to its own place on the bus, which outlives this,
  /// says everything before that one and obeys what that one is told; its own wheel turns in the air.
  void add_twin(std::size_t side, CanBus& bus) { twin_ = make_wheel_drive(wiring_, side, bus); }
  void deceive(const FalseSenses& senses) noexcept { senses_ = senses, deceived_ = world_.now(); }
  /// A person lifts the robot and puts it down there: `from_here`, seen from where it stands.
  void carry(const Pose2& from_here) noexcept { world_.plant().carry_to(truth().map_from_robot * from_here); }
  /// A frame that neither drive would send, as of another program. A place on the bus does not hear itself: so it goes
  /// out at both, and the controller hears it twice.
  void say_as_stranger(const CanFrame& frame) noexcept {
    for (CanBus* const bus : buses_) static_cast<void>(bus->send(frame));
  }
  /// m/s at the rim of the faster wheel, as the drives would have it.
  [[nodiscard]] double rim_speed() const noexcept {
    return std::max(std::fabs(drives_[0]->speed_radps()), std::fabs(drives_[1]->speed_radps())) * wheel_radius_m_;
  }
  /// The worse of the two drives' places on the bus.
  [[nodiscard]] CanHealth bus_health() const noexcept;

 private:
  struct Eye {
    std::size_t index;
    LaserModel laser;
    sim::Random noise;
    std::array<double, kMaxBeams> last_range_m{};  ///< of a beam, without its noise
    std::unique_ptr<emulators::ScannerServer> scanner{};
  };
  void look(Eye& eye, std::size_t first_beam, std::span<float> range_m);
  void turn_wheels();
  void read_encoders();
  [[nodiscard]] double range_along(Eye& eye, std::size_t beam);

  Time began_;
  sim::World world_;
  double wheel_radius_m_;
  Buses buses_;
  DriveWiring wiring_;
  std::unique_ptr<WheelDrive> twin_;  ///< null: none
  std::array<std::unique_ptr<WheelDrive>, 2> drives_;
  std::vector<std::unique_ptr<Eye>> eyes_;
  Time encoders_read_ = kNever;
  FalseSenses senses_;
  Time deceived_ = kNever;
  WheelState shown_;             ///< as the encoders show it
  std::deque<WheelState> read_;  ///< of the last half second, and the newest
};

/// A place on a bus, and when a frame left it last.
class WatchedBus final : public CanBus {
 public:
  /// Both outlive it.
  WatchedBus(CanBus& bus, Clock& clock) noexcept : bus_(bus), clock_(clock) {}

  [[nodiscard]] bool send(const CanFrame& frame) noexcept override {
    const bool result = bus_.send(frame);
    sent_ = clock_.now();
    return result;
  }
  [[nodiscard]] bool receive(ReceivedFrame& received) noexcept override { return bus_.receive(received); }
  [[nodiscard]] CanHealth health() const noexcept override { return bus_.health(); }
  [[nodiscard]] Time sent() const noexcept { return sent_; }

 private:
  CanBus& bus_;
  Clock& clock_;
  Time sent_ = kNever;
};

/// The controller of a ROBOT.toml with the simulated robot at the far end of an in-process bus and of a real scanner's
/// wire. `step_far_end` is for the clock: whatever waits, waits by it, and the far end lives meanwhile.
class InProcessRobot {
 public:
  struct Run {
    std::filesystem::path out;                  ///< the folder for the run's files
    LoopRunner::MakePlanner make_planner = {};  ///< LoopRunner's
    TickObserver* observer = nullptr;           ///< gets every tick; outlives the robot. Null: nothing observes the run
    bool real_line = false;                     ///< of a Pioneer: a pseudo terminal or TCP port, not the in-process bus
  };

  /// `clock` outlives it. A scanner on a network is found at any free port of this machine. Throws StartupError.
  InProcessRobot(RobotFile file, const sim::Scenario& scenario, std::uint64_t seed, Clock& clock, const Run& run);

  /// Moves the far end on to now; notes when the first scanner's newest message was complete.
  void step_far_end();

  [[nodiscard]] SimulatedRobot& far_end() noexcept { return far_end_; }
  [[nodiscard]] ScannerConnection& laser() noexcept { return *lasers_.front(); }
  [[nodiscard]] std::span<const std::unique_ptr<ScannerConnection>> lasers() const noexcept { return lasers_; }
  [[nodiscard]] WiredDrive& drive() noexcept { return *drive_; }
  [[nodiscard]] OperatorDesk& desk() noexcept { return controls_.desk(); }
  [[nodiscard]] LoopRunner& runner() noexcept { return runner_; }
  [[nodiscard]] RobotLoop& loop() noexcept { return loop_; }
  [[nodiscard]] const WatchedBus& bus() const noexcept { return bus_; }
  /// Port 0 is the controller's, 1 and 2 are the drives' (left, right); the others are free.
  [[nodiscard]] InProcessBus& wires() noexcept { return wires_; }
  /// The device's end of a Pioneer's real line; null: none.
  [[nodiscard]] emulators::ServedBytes* far_line() noexcept { return far_line_.get(); }
  /// When the last byte of the scanner's message left, by message, from the first.
  [[nodiscard]] const std::vector<Time>& messages() const noexcept { return messages_; }

 private:
  InProcessRobot(RobotFile file, const sim::Scenario& scenario, std::uint64_t seed, Clock& clock, const Run& run,
                 FarWires wires);
  [[nodiscard]] SimulatedRobot::Buses places() noexcept;
  [[nodiscard]] Hal hal();

  TickObserver nobody_;
  TickObserver& observer_;
  Clock& clock_;
  RobotFile file_;
  InProcessBus wires_;
  std::unique_ptr<emulators::ServedBytes> far_line_;  ///< null: none
  std::unique_ptr<CanBus> line_;                      ///< its other end
  WatchedBus bus_;
  SimulatedRobot far_end_;
  std::vector<std::unique_ptr<ScannerConnection>> lasers_;
  std::unique_ptr<WiredDrive> drive_;
  OperatorControls controls_;
  LoopRunner runner_;
  StallGuard guard_;  ///< not started: time may stand still here
  RobotLoop loop_;
  std::vector<Time> messages_;
};

// Clocks by which the wires' far end lives while the controller sleeps, in the thread that sleeps.

/// How long the far end stands still at most.
inline constexpr Duration kLivingStep = std::chrono::milliseconds(1);

/// Time that a test moves on by hand. Thread: one.
class HandLivingClock final : public Clock {
 public:
  [[nodiscard]] Time now() noexcept override { return now_; }
  void sleep_until(Time wake) noexcept override {
    while (now_ < wake) {
      now_ += kLivingStep;
      if (live) live();
    }
  }
  std::function<void()> live;

 private:
  Time now_{};
};

/// Real time; any thread asks for it, one sleeps by it.
class RealLivingClock final : public Clock {
 public:
  [[nodiscard]] Time now() noexcept override { return steady_.now(); }
  void sleep_until(Time wake) noexcept override {
    do {
      if (live) live();
      steady_.sleep_until(std::min(wake, now() + kLivingStep));
    } while (now() < wake);
  }
  std::function<void()> live;

 private:
  SteadyClock steady_;
};

}  // namespace jaywalk::rig
