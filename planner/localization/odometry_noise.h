#pragma once
// Errors of the wheels: noise and radius bias as matches showed them, and slip.
#include <algorithm>
#include <cmath>

#include "hal/types/geometry.h"
#include "planner/localization/odometry.h"
#include "planner/localization/scan_matcher.h"

namespace jaywalk {
/// By how much a drive may have gone wrong, as variances.
struct OdometryNoise {
  double position_var = 0.0;  ///< m^2, an axis
  double heading_var = 0.0;   ///< rad^2
};

/// Of wheels that nothing is known of: a random walk, a generous one.
[[nodiscard]] OdometryNoise noise_of_unknown_wheels(const ArcStep& step) noexcept;

/// Adds up by how much matches move and turn the robot from where its wheels had taken it. A window ends when unknown
/// wheels would have turned wrong by 6 degrees: after 8 m straight on, or 2 rad. What that came to in it at most,
/// beyond what the map itself may be off by, is what these wheels do wrong; windows are averaged. Worse wheels are
/// believed less at once, better ones more from window to window. Turns and metres are watched apart, since wheels that
/// turn wrong may count metres right: a turn that was put right moves nobody. A window, not a scan: how little single
/// matches correct is no proof of good wheels, since a match that trusts them corrects little. Thread: the loop's.
class OdometryNoiseEstimator {
 public:
  /// These wheels' doubt over that of unknown ones: at most 1, which is where they start, and never less than
  /// kLeastShare. The better of the two is taken for worse than it seems, the geometric mean of both: what slips on its
  /// way slips when it turns, too. By trial: either alone, or one for both, is worse (decision localization).
  [[nodiscard]] double metres() const { return metres_.beside(turns_); }
  [[nodiscard]] double turns() const { return turns_.beside(metres_); }
  [[nodiscard]] bool nothing_known() const { return metres_.believed >= 1.0 || turns_.believed >= 1.0; }

  void drove(const ArcStep& step) noexcept {
    const OdometryNoise more = noise_of_unknown_wheels(step);
    window_.position_var += more.position_var;
    window_.heading_var += more.heading_var;
  }
  /// After each match: where the wheels had taken the robot, and where the map has it.
  void corrected(const Pose2& predicted, const Pose2& placed) noexcept;
  /// The pose was moved by something else than scans: what has moved in this window tells nothing.
  void begin_anew() noexcept { begun_ = false; }

  static constexpr double kLeastShare = 0.0003;  ///< 0.9 mm and 0.035 degrees after a metre

 private:
  struct Share {
    double believed = 1.0;
    double worst = 0.0;  ///< that would explain what moved in this window so far

    /// What may be believed of it where `other` is so bad.
    [[nodiscard]] double beside(const Share& other) const noexcept {
      return std::sqrt(believed * std::max(believed, other.believed));
    }
    void moved(double explained_by) noexcept {
      worst = std::max(worst, explained_by);
      believed = std::clamp(std::max(believed, worst), kLeastShare, 1.0);
    }
    void end_window() noexcept;
  };
  void begin() noexcept {
    begun_ = true;
    window_ = {};
    moved_in_map_ = {};
    turned_ = metres_.worst = turns_.worst = 0.0;
  }

  Share metres_, turns_;
  bool begun_ = false;
  OdometryNoise window_;
  Vec2 moved_in_map_;  ///< by matches, in this window
  double turned_ = 0.0;
};

/// Wheels of unequal size turn the robot a little with every metre: learnt from the turns that matches put right.
/// Turning itself is left alone: what is wrong there goes away when the robot turns back. Thread: the loop's.
class WheelRadiusBias {
 public:
  /// rad a metre, to be added to what the wheels say; at most kMost to either side.
  [[nodiscard]] double turn_per_m() const { return turn_per_m_; }

  void drove(const ArcStep& step) noexcept {
    since_.distance_m += step.distance_m;
    since_.turn_rad += step.turn_rad;
  }
  /// A match turned the robot by `turn_rad` after what it drove since the last. What no drift explains, as of a wheel
  /// that spins in the air, is none.
  void corrected(double turn_rad) noexcept;
  /// The pose was moved by something else than wheels and scans: what was driven since the last match tells nothing.
  void begin_anew() noexcept { since_ = {}; }

  static constexpr double kMost = 0.12;

 private:
  double turn_per_m_ = 0.0;
  double variance_ = 0.06 * 0.06;
  ArcStep since_;  ///< the last match
};

/// Where the wheels put the robot at a scan, and how sure of it one is, with wheels as they have been and had nothing
/// been known of them since the last match.
struct OdometryPrior {
  Pose2 map_from_robot;
  Eigen::Matrix3d covariance, if_slipped;
  bool learnt = false;  ///< what is believed of the wheels is learnt; else there is nothing to take back
  PoseBelief coasted;   ///< had it gone on as it went from scan to scan, whatever the wheels say
};

/// Matches scans, and notices slip: a match that leaves the prediction by three standard deviations, or fits worse than
/// matches did lately, is tried again as if the wheels were unknown; that one is taken if it fits better. So is a scan
/// that the map contradicts, but none that sees next to nothing the map knows: that is no slip. Where neither fits as
/// matches did lately a third is tried, without the wheels, if the last scan is not long ago: one that spins in the air
/// turns the robot by more than any doubt of what it says. Thread: the loop's.
class SlipDetector {
 public:
  [[nodiscard]] MatchResult match(const MatchSample& sample, const EvidenceMap& still,
                                  const OdometryPrior& wheels) noexcept;

 private:
  [[nodiscard]] MatchResult best(const MatchSample& sample, const EvidenceMap& still,
                                 const OdometryPrior& wheels) const noexcept;
  [[nodiscard]] MatchResult by_wheels(const MatchSample& sample, const EvidenceMap& still,
                                      const OdometryPrior& wheels) const noexcept;
  /// `other` where it fits better `by` so much than what was found, or, where nothing was, nearly as matches did
  /// lately.
  [[nodiscard]] const MatchResult& better(const MatchResult& found, const MatchResult& other, double by) const noexcept;
  [[nodiscard]] bool doubtful(const MatchResult& found, const OdometryPrior& wheels) const noexcept;

  bool contradicted_ = false;  ///< the last scan was
  double usual_fit_ = 0.0;     ///< running mean of the matches'
};

}  // namespace jaywalk
