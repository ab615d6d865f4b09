#pragma once
#include <array>
#include <cstdint>
#include <deque>
#include <memory>
#include <span>
#include <vector>

#include "firmware/robot/robot_file.h"
#include "hal/sim/world.h"
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

  /// Moves drives, world and scanner on to now, by the clock.
  void step(Time now);

  [[nodiscard]] const sim::Truth& truth() const noexcept { return world_.truth(); }
  [[nodiscard]] WheelDrive& drive(std::size_t side) noexcept { return *drives_[side]; }
  [[nodiscard]] emulators::ScannerServer& scanner(std::size_t index = 0) noexcept { return *eyes_[index]->scanner; }
  /// A second drive with the number of the one on this side comes to its own place on the bus, which outlives this,
  /// says everything before that one and obeys what that one is told; its own wheel turns in the air.
  void add_twin(std::size_t side, CanBus& bus) { twin_ = make_wheel_drive(wiring_, side, bus); }
  /// From now on.
  void deceive(const FalseSenses& senses) noexcept { senses_ = senses, deceived_ = world_.now(); }
  /// A person lifts the robot and puts it down there: `from_here`, seen from where it stands.
  void carry(const Pose2& from_here) noexcept { world_.plant().carry_to(truth().map_from_robot * from_here); }
  /// A frame that neither drive would send, as of another program. A place on the bus does not hear itself: so it goes
  /// out at both, and the controller hears it twice.
  void say_as_stranger(const CanFrame& frame) noexcept {
    for (CanBus* const bus : buses_) static_cast<void>(bus->send(frame));
  }
  /// m/s at the rim of the faster wheel, as the drives would have it.
  [[nodiscard]] double rim_speed() const noexcept;
  /// The worse of the two drives' places on the bus.
  [[nodiscard]] CanHealth bus_health() const noexcept;

 private:
  /// A scanner and what it sees.
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

}  // namespace jaywalk::rig
