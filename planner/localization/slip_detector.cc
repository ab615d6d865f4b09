#include "planner/localization/slip_detector.h"

namespace jaywalk {
namespace {

// By trial (decision localization).
constexpr double kDoubtfulSigmas = 3.0, kDoubtfulFit = 0.2, kBetterFit = 0.1;
constexpr double kFitGain = 0.1;  // of the running mean
// Without the wheels a search is wide. Scans more than 0.18 s apart would find other walls (Intel's: 0.45 degrees over
// 10 m, not 0.19), and by trial on Freiburg, whose wheels hop, what is found must stand out.
constexpr double kMostCoastedVar = 0.1 * 0.1, kMuchBetterFit = 0.3;

}  // namespace

MatchResult SlipDetector::match(const ScanPoints& scan, const EvidenceMap& still,
                                const OdometryPrior& wheels) noexcept {
  MatchResult found = best(scan, still, wheels);
  found.matched = found.matched && finite(found.belief.map_from_robot);
  if (found.matched) usual_fit_ += kFitGain * (found.fit - usual_fit_);
  contradicted_ = found.contradicted;
  return found;
}

MatchResult SlipDetector::best(const ScanPoints& scan, const EvidenceMap& still, const OdometryPrior& wheels) noexcept {
  const MatchResult found = by_wheels(scan, still, wheels);
  const bool fits = found.matched ? found.fit >= usual_fit_ - kDoubtfulFit : !found.contradicted;
  if (fits || wheels.coasted.covariance(2, 2) > kMostCoastedVar) return found;
  return better(found, matcher_.match(scan, {still}, wheels.coasted), kMuchBetterFit);
}

MatchResult SlipDetector::by_wheels(const ScanPoints& scan, const EvidenceMap& still,
                                    const OdometryPrior& wheels) noexcept {
  const Pose2& predicted = wheels.map_from_robot;
  if (contradicted_ || !wheels.learnt) return matcher_.match(scan, {still}, {predicted, wheels.if_slipped});
  const MatchResult found = matcher_.match(scan, {still}, {predicted, wheels.covariance});
  if (!doubtful(found, wheels)) return found;
  return better(found, matcher_.match(scan, {still}, {predicted, wheels.if_slipped}), kBetterFit);
}

const MatchResult& SlipDetector::better(const MatchResult& found, const MatchResult& other, double by) const noexcept {
  const double least_fit = found.matched ? found.fit + by : usual_fit_ - kDoubtfulFit;
  return other.matched && other.fit > least_fit ? other : found;
}

bool SlipDetector::doubtful(const MatchResult& found, const OdometryPrior& wheels) const noexcept {
  if (!found.matched) return found.contradicted;
  if (found.fit < usual_fit_ - kDoubtfulFit) return true;
  return nis(wheels.map_from_robot, found.belief.map_from_robot, wheels.covariance) > kDoubtfulSigmas * kDoubtfulSigmas;
}

}  // namespace jaywalk
