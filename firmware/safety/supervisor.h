#pragma once
#include <algorithm>
#include <limits>
#include <span>
#include <vector>

#include "firmware/safety/blind_gaps.h"
#include "firmware/safety/latency.h"
#include "firmware/safety/modes.h"
#include "firmware/safety/motion_model.h"
#include "firmware/safety/reaction.h"
#include "firmware/safety/reasons.h"
#include "firmware/safety/stop_zone.h"
#include "firmware/safety/unseen_walls.h"
#include "firmware/safety/watch.h"
#include "firmware/safety/wheel_proof.h"
#include "hal/types/laser_scan.h"
#include "hal/types/operator_input.h"
#include "hal/types/robot_model.h"
#include "hal/types/wheels.h"

namespace jaywalk {

struct SupervisorConfig {
  RobotModel model;
  Duration max_plan_age = std::chrono::milliseconds(1000);  ///< older: standstill
  Duration slow_plan_age = std::chrono::milliseconds(300);  ///< older: the slower the older
  double unwatched_speed_mps = 0.3;                         ///< SAFETY: where nothing watches the way
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

/// The last to speak before the wheels: the follower asks, the supervisor permits. It judges the raw scans, the wanted
/// twist and the ages of things, so that it does not depend on planner or tracker being right.
///
/// Each scanner is judged by itself, and one of several that is lost, late or blinded is a fault as the only one is.
/// Free ground is what they prove together.
///
/// A limit holds while its cause does. A fault stops; those of emergency stop, bus, drive and missed ticks, and on
/// wires all, are latched as well: motion resumes only after a rising edge of reset, seen with the button released and
/// a wanted twist of zero. Thread: the loop's; never allocates, never throws.
class Supervisor {
 public:
  explicit Supervisor(const SupervisorConfig& config);
  [[nodiscard]] Verdict judge(const Twist2& wanted, const SafetyInput& input) noexcept;
  [[nodiscard]] Mode mode() const noexcept { return mode_; }
  /// UnseenWalls' of the last tick: motion does well to keep off them, too.
  [[nodiscard]] std::span<const Vec2> unseen_walls() const noexcept { return unseen_walls_.points(); }
  /// False while an earlier fault waits for its reset, or the drives for their proof: ask for nothing until then.
  [[nodiscard]] bool takes_wishes() const noexcept;

 private:
  [[nodiscard]] Reason faults(const Twist2& wanted, const SafetyInput& input) noexcept;
  [[nodiscard]] Reason scan_faults(const SafetyInput& input) noexcept;
  [[nodiscard]] Reason scan_faults(std::size_t scanner, const SafetyInput& input) noexcept;
  [[nodiscard]] OfEach<BlindGaps> gaps() const noexcept { return OfEach<BlindGaps>(std::span(gaps_)); }
  [[nodiscard]] Reason wheel_faults(const SafetyInput& input) const noexcept;
  [[nodiscard]] Reason motion_faults(std::size_t scanner, const SafetyInput& input) noexcept;
  [[nodiscard]] bool answers_late(const MeasuredLatency& measured) const noexcept;
  [[nodiscard]] double unproved_share(const Twist2& twist) const noexcept;
  /// Ticks that did not happen, in a row with those that were skipped just before.
  [[nodiscard]] int missed_in_a_row(Time now) noexcept;
  void update_mode(Reason faults, const Twist2& wanted, const SafetyInput& input) noexcept;
  [[nodiscard]] Twist2 limited(Twist2 twist, const SafetyInput& input, Verdict& verdict) noexcept;
  [[nodiscard]] double plan_share(Time plan_stamp, Time now) const noexcept;
  [[nodiscard]] bool touched(const OfEach<LaserScan>& scans) const noexcept;
  [[nodiscard]] bool has_blanked() const noexcept {
    return std::any_of(gaps_.begin(), gaps_.end(), [](const BlindGaps& gaps) { return gaps.has_blanked(); });
  }
  [[nodiscard]] double reaction_s(const SafetyInput& input) const noexcept;
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
