#pragma once
#include <filesystem>

#include "firmware/far_end/in_process_robot.h"
#include "firmware/far_end/living_clock.h"
#include "firmware/faults/straight_planner.h"
#include "firmware/safety/reasons.h"

namespace jaywalk::faults {

class FaultBench;

/// What a fault is to do to the robot in the end.
enum class Outcome {
  kLatched,  ///< at rest, latched: no goal is taken before a reset
  kStopped,  ///< at rest; it may go on when the cause is gone
  kCrawls,   ///< 0.3 m/s at most (SAFETY 9), or at rest
  kDead      ///< the controller is gone: at rest by the drives' own watchdogs
};

/// One row of the matrix but for drive and speed.
struct FaultCase {
  const char* name;
  void (*strike)(FaultBench&);      ///< once, at speed
  void (*every_tick)(FaultBench&);  ///< and then again and again; may be null
  Reason reason;                    ///< one of these is to be named; kNone: none can be
  Duration limit;                   ///< from the fault to the moment from which on the wheels only slow down
  Outcome outcome;
  std::optional<DriveKind> only = {};  ///< of the one kind of drive that can have it
  /// An ODrive whose watchdog lets go, and a VESC in fault, brake nothing: no limit of ours holds for their distance.
  bool rolls_out = false;
};

struct FaultResult {
  const FaultCase* fault = nullptr;
  DriveKind drive = DriveKind::kCia402;
  double speed_mps = 0.0;
  Duration reaction{0};
  double stop_distance_m = 0.0;
  bool latched = false;
  std::string why_not = {};  ///< empty: ok
};

/// The whole controller with emulated drives and a scanner at the far end of its wires, in the simulated world's time.
/// It drives down a hall; a fault strikes at full speed, and what the world then sees is measured.
class FaultBench {
 public:
  /// `folder` is for the files of the run. Throws StartupError.
  FaultBench(DriveKind kind, double speed_mps, const std::filesystem::path& folder);

  [[nodiscard]] FaultResult suffer(const FaultCase& fault);

  // What strikes may use.
  [[nodiscard]] rig::InProcessRobot& robot() noexcept { return *robot_; }
  [[nodiscard]] rig::WheelDrive& left_drive() noexcept { return robot_->far_end().drive(0); }
  [[nodiscard]] rig::WheelDrive& right_drive() noexcept { return robot_->far_end().drive(1); }
  [[nodiscard]] const DriveWiring& wiring() const noexcept { return file_.drive; }
  [[nodiscard]] InProcessBus::Port& controllers_port() noexcept { return robot_->wires().port(0); }
  /// Another program's place on the bus.
  void say_as_stranger(const CanFrame& frame) noexcept { (void)robot_->wires().port(3).send(frame); }
  [[nodiscard]] StraightPlanner& planner() noexcept { return *planner_; }
  /// The loop does not run for so long, for ever with max().
  void hold_up(Duration time) noexcept;

 private:
  void watch() noexcept;
  void tick();
  void wait(Duration time);
  [[nodiscard]] bool reach_speed();
  [[nodiscard]] double rim_mps() noexcept;
  [[nodiscard]] bool named(Reason reason) const noexcept { return reason == Reason::kNone || has(seen_, reason); }
  [[nodiscard]] std::string complaint(const FaultCase& fault, const FaultResult& result);
  [[nodiscard]] std::string complaint_afterwards(const FaultCase& fault);

  DriveKind kind_;
  double speed_mps_;
  RobotFile file_;
  rig::HandLivingClock clock_;
  StraightPlanner* planner_ = nullptr;  ///< robot_'s
  std::unique_ptr<rig::InProcessRobot> robot_;
  Time due_{}, held_up_until_ = kNever;
  Time struck_ = kNever, last_fast_ = kNever;
  double speed_struck_ = 0.0, motors_struck_ = 0.0;
  double way_m_ = 0.0;  ///< since the fault
  Vec2 place_{};
  Reason seen_ = Reason::kNone;  ///< since the fault
  bool latched_ = false;
};

}  // namespace jaywalk::faults
