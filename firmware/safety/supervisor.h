#pragma once
// Supervisor, and the modes of the robot.
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "firmware/safety/blind_gaps.h"
#include "firmware/safety/latency.h"
#include "firmware/safety/motion_model.h"
#include "firmware/safety/reasons.h"
#include "firmware/safety/stop_zone.h"
#include "firmware/safety/wheel_proof.h"
#include "hal/types/laser_scan.h"
#include "hal/types/operator_input.h"
#include "hal/types/robot_model.h"
#include "hal/types/wheels.h"

namespace jaywalk {
/// What the robot does, as far as safety is concerned.
enum class Mode : std::uint8_t {
  kStandby,   ///< the drives are not ready: not proved yet, or proved anew after a reset; no torque
  kArmed,     ///< ready, at rest, without a goal; torque holds the wheels
  kDriving,   ///< on the way to a goal
  kTurning,   ///< at the goal, on the way to the heading wanted there
  kStopping,  ///< ramps to rest: the goal is gone, or a fault that ends by itself is there
  kLatched    ///< a fault happened: ramps to rest and stays there until a person's reset
};

/// What decides about the next mode, in one tick.
struct ModeInput {
  bool fault = false;         ///< one is there now
  bool latches = false;       ///< and it waits for a reset when it is gone
  bool stop_pressed = false;  ///< the emergency stop's button, now
  bool reset_edge = false;    ///< a person's reset, its rising edge
  bool wants_zero = false;    ///< the wanted twist is zero, and a stick in its middle
  bool drives_ready = false;  ///< both proved and enabled, without trouble
  bool has_goal = false;      ///< or a stick that is not in its middle
  bool at_goal = false;       ///< where only the heading is left to be reached
  bool at_rest = false;       ///< nothing is permitted any more, that is: the ramp has ended
};

/// The mode after this tick's input. Latched is left by a reset's edge with the button released and a wanted twist of
/// zero, to standby, or to armed where the drives are ready; standby is left when the drives are ready and the wanted
/// twist is zero: there is no other way from a fault to motion. A fault that is still there latches again.
[[nodiscard]] constexpr Mode next_mode(Mode mode, const ModeInput& in) noexcept {
  const bool may_leave = in.reset_edge && in.wants_zero && !in.stop_pressed;
  if (in.latches && !(mode == Mode::kLatched && may_leave)) return Mode::kLatched;
  if (mode == Mode::kLatched && !may_leave) return Mode::kLatched;
  if (!in.drives_ready || (mode == Mode::kLatched && in.latches)) return Mode::kStandby;
  if (mode == Mode::kStandby && !in.wants_zero) return Mode::kStandby;
  if (mode == Mode::kLatched) return Mode::kArmed;
  if (in.fault) return in.at_rest ? Mode::kArmed : Mode::kStopping;
  if (in.has_goal) return in.at_goal ? Mode::kTurning : Mode::kDriving;
  return in.at_rest ? Mode::kArmed : Mode::kStopping;
}

struct SupervisorConfig {
  RobotModel model;
  Duration tick = std::chrono::milliseconds(20);
  bool needs_wheels = true;    ///< false only where a recording has none
  bool judges_motion = false;  ///< commanded against felt against seen: where wheels obey what is commanded here
  bool latches_all = false;    ///< on wires: any fault latches, once scans and wheels have been there (SAFETY 6)
  bool proves_wheels = false;  ///< on wires: drives that were set up go slowly until WheelProof is over
};

/// What the supervisor looks at; nothing of it comes from the planner but a stamp.
struct SafetyInput {
  OfEach<LaserScan> scans;  ///< of each scanner the newest
  const WheelState& wheels;
  const OperatorInput& input;
  Time plan_stamp = kNever;
  Time now = kNever;
  MeasuredLatency latency{};
  bool at_goal = false;                                             ///< only the heading is left to be reached
  double most_speed_mps = std::numeric_limits<double>::infinity();  ///< where it is; a person's rule, not a danger
  WheelCommand sent{};                                              ///< what the drive was sent in the tick before
  std::span<const Vec2> known_walls{};                              ///< near the robot and in its frame, of its map
  KnownGround* known_ground = nullptr;                              ///< of the same map; null: there is none
  bool pose_doubtful = false;                                       ///< where it is was guessed for too long
};

/// The last to speak before the wheels: it judges raw scans, the wanted twist and ages, whatever planner and tracker
/// say.
///
/// Each scanner is judged by itself; free ground is what they prove together. A limit holds while its cause does. A
/// fault stops; latched ones (ReasonKind), and on wires all, until next_mode() lets them go. Thread: the loop's.
class Supervisor {
 public:
  explicit Supervisor(const SupervisorConfig& config);
  [[nodiscard]] Verdict judge(const Twist2& wanted, const SafetyInput& input) noexcept;
  [[nodiscard]] Mode mode() const noexcept { return mode_; }
  /// UnseenWalls' of the last tick: motion does well to keep off them, too.
  [[nodiscard]] std::span<const Vec2> unseen_walls() const noexcept { return unseen_walls_.points(); }
  /// False while an earlier fault waits for its reset, or the drives for their proof: ask for nothing until then.
  [[nodiscard]] bool takes_wishes() const noexcept { return mode_ != Mode::kStandby && mode_ != Mode::kLatched; }

 private:
  [[nodiscard]] Reason faults(const Twist2& wanted, const SafetyInput& input) noexcept;
  [[nodiscard]] Reason scan_faults(const SafetyInput& input) noexcept;
  [[nodiscard]] Reason faults_of(std::size_t scanner, const SafetyInput& input) noexcept;
  [[nodiscard]] OfEach<BlindGaps> gaps() const noexcept { return OfEach<BlindGaps>(std::span(gaps_)); }
  [[nodiscard]] Reason wheel_faults(const SafetyInput& input) const noexcept;
  [[nodiscard]] double unproved_share(const Twist2& twist) const noexcept;
  /// Ticks that did not happen, in a row with those that were skipped just before.
  [[nodiscard]] int missed_in_a_row(Time now) noexcept;
  void update_mode(Reason faults, const Twist2& wanted, const SafetyInput& input) noexcept;
  [[nodiscard]] Twist2 limited(Twist2 twist, const SafetyInput& input, Verdict& verdict) noexcept;
  [[nodiscard]] double watched_share(const Twist2& twist, double reaction_s) const noexcept;
  [[nodiscard]] double proven_share(const Twist2& twist, double reaction_s) noexcept;
  [[nodiscard]] Twist2 braked(const Twist2& target) const noexcept;

  SupervisorConfig config_;
  StopZone stop_zone_;
  Watch watch_;
  UnseenWalls unseen_walls_;
  /// What is judged of one scanner by itself.
  struct Scanner {
    LaserModel laser;
    ScanTiming timing;
    SightLoss sight_loss;
    MotionModel motion;
    WheelProof wheel_proof;
  };
  std::vector<Scanner> scanners_;
  std::vector<BlindGaps> gaps_;  ///< of each
  Twist2 permitted_;             ///< last tick's
  bool lost_ahead_ = false;      ///< what lost beams could hide held it up, last tick
  int missed_ = 0;
  std::uint8_t faulty_ = 0;  ///< Verdict::faulty_scanners
  Time judged_ = kNever;
  Mode mode_;
  bool reset_before_ = false;
};

}  // namespace jaywalk
