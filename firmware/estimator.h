#pragma once
// The tick's step "Estimate": where the robot is, what stands around it and what moves.
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "firmware/control_setup.h"
#include "firmware/recording/tick_record.h"
#include "firmware/safety/blind_gaps.h"
#include "firmware/safety/felt_motion.h"
#include "hal/types/fixed_vector.h"
#include "hal/types/robot_model.h"
#include "planner/localization/localizer.h"
#include "planner/mapping/evidence_map.h"
#include "planner/tracking/tracker.h"

namespace jaywalk {

/// Localizer and tracker with the rules that feed them. Of a tick: update(), then with its plan's status
/// forget_where_stuck(), at its end end_tick(). Only the constructor allocates. Thread: the loop's.
class Estimator {
 public:
  explicit Estimator(const ControlSetup& setup);

  /// Takes the tick's scans, the oldest first. True with a new one that the tracks rest on; not with a doubtful pose.
  [[nodiscard]] bool update(const TickRecord& t) noexcept;
  /// Forgets what is mapped out of sight where the robot has stood for ten seconds with a goal and no path to it.
  void forget_where_stuck(const TickRecord& t) noexcept;
  void end_tick(const TickRecord& t) noexcept;

  [[nodiscard]] const PoseEstimate& pose() const noexcept { return pose_; }
  /// The pose by now: of a base that reports late or rarely, carried on at its last twist until that is stale.
  [[nodiscard]] PoseEstimate pose_at(Time now) const noexcept;
  [[nodiscard]] const Tracker& tracker() const noexcept { return tracker_; }
  [[nodiscard]] Pose2 map_from_robot_at_scan(std::size_t scanner = 0) const noexcept {
    return localizer_.map_from_robot_at_scan(scanner);
  }
  [[nodiscard]] Twist2 twist() const noexcept { return localizer_.twist(); }

 private:
  /// True where standing explains the scan of a robot at rest. Puts the pose in doubt where it was carried.
  [[nodiscard]] bool is_explained(const LaserScan& scan, const WheelState& wheels) noexcept;
  [[nodiscard]] bool take(const TickRecord& t, const LaserScan& scan) noexcept;

  bool sees_given_movers_;  ///< they come with the fix
  DriveTimes times_;
  Localizer localizer_;
  struct Rest {
    RestWatch watch;
    RestWatch::Says says = RestWatch::Says::kNothing;  ///< of its newest scan that said anything
  };
  std::vector<Rest> rests_;  ///< of each scanner
  Tracker tracker_;
  PoseEstimate pose_;
  std::array<std::uint32_t, kMostScanners> scans_seen_{};  ///< sequence of each scanner's newest
  std::uint32_t fix_seen_ = 0;
  std::array<bool, kMostScanners> frozen_{};  ///< the supervisor said so of the tick before
  bool stood_ = true;                         ///< the wheels were commanded nothing in the tick before
  Time had_way_ = kNever;                     ///< or moved, had no goal, or looked anew for one, last
};

/// Walls near the robot by its map that have stood for a second: a walker leaves others behind. Thread: the loop's.
class KnownWalls final : public KnownGround {
 public:
  explicit KnownWalls(const Footprint& footprint) : reach_m_(footprint.circumscribed_radius_m() + kBeyond_m) {}

  /// Points in the robot's frame, at most 3 cm apart along a wall; valid until the next call.
  [[nodiscard]] std::span<const Vec2> near(const EvidenceMap& still, const Pose2& map_from_robot) noexcept;

  /// Both as of that call's map and pose.
  [[nodiscard]] bool seen_free(Vec2 place) const noexcept override {
    return still_ != nullptr && still_->seen_free(still_->cell_at(map_from_robot_ * place));
  }
  void suppose(Vec2 place) noexcept override;

 private:
  static constexpr double kBeyond_m = 0.4;  ///< what stopping takes from 0.3 m/s, and the stop zone's margin

  double reach_m_;
  const EvidenceMap* still_ = nullptr;
  Pose2 map_from_robot_;
  FixedVector<Vec2, 2048> points_;
  FixedVector<Vec2, 256> supposed_;  ///< in the map
};

}  // namespace jaywalk
