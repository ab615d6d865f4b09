#pragma once
// Matching beside wheels that may slip, however long they were right.
#include "planner/localization/scan_matcher.h"

namespace jaywalk {

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
  [[nodiscard]] MatchResult match(const ScanPoints& scan, const EvidenceMap& still,
                                  const OdometryPrior& wheels) noexcept;

 private:
  [[nodiscard]] MatchResult best(const ScanPoints& scan, const EvidenceMap& still,
                                 const OdometryPrior& wheels) noexcept;
  [[nodiscard]] MatchResult by_wheels(const ScanPoints& scan, const EvidenceMap& still,
                                      const OdometryPrior& wheels) noexcept;
  /// `other` where it fits better `by` so much than what was found, or, where nothing was, nearly as matches did
  /// lately.
  [[nodiscard]] const MatchResult& better(const MatchResult& found, const MatchResult& other, double by) const noexcept;
  [[nodiscard]] bool doubtful(const MatchResult& found, const OdometryPrior& wheels) const noexcept;

  ScanMatcher matcher_;
  bool contradicted_ = false;  ///< the last scan was
  double usual_fit_ = 0.0;     ///< running mean of the matches'
};

}  // namespace jaywalk
