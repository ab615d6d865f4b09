#include "planner/localization/slip_watch.h"

namespace jaywalk {
namespace {

// By trial (docs/tracking-findings.md, "Wheels that were long right").
constexpr double kDoubtfulSigmas = 3.0, kDoubtfulFit = 0.2, kBetterFit = 0.1;
constexpr double kFitGain = 0.1;  // of the running mean

}  // namespace

MatchResult SlipWatch::match(const ScanPoints& scan, const EvidenceMap& still, const WheelBelief& wheels) noexcept {
  MatchResult found = best(scan, still, wheels);
  found.matched = found.matched && finite(found.belief.map_from_robot);
  if (found.matched) usual_fit_ += kFitGain * (found.fit - usual_fit_);
  contradicted_ = found.contradicted;
  return found;
}

MatchResult SlipWatch::best(const ScanPoints& scan, const EvidenceMap& still, const WheelBelief& wheels) noexcept {
  const Pose2& predicted = wheels.map_from_robot;
  if (contradicted_ || !wheels.earned) return matcher_.match(scan, still, {predicted, wheels.if_slipped});
  const MatchResult found = matcher_.match(scan, still, {predicted, wheels.covariance});
  if (!doubtful(found, wheels)) return found;
  const MatchResult wider = matcher_.match(scan, still, {predicted, wheels.if_slipped});
  const double least_fit = found.matched ? found.fit + kBetterFit : usual_fit_ - kDoubtfulFit;
  return wider.matched && wider.fit > least_fit ? wider : found;
}

bool SlipWatch::doubtful(const MatchResult& found, const WheelBelief& wheels) const noexcept {
  if (!found.matched) return found.contradicted;
  if (found.fit < usual_fit_ - kDoubtfulFit) return true;
  const Row3 off = offset(wheels.map_from_robot, found.belief.map_from_robot);
  return inverse(wheels.covariance).quadratic(off) > kDoubtfulSigmas * kDoubtfulSigmas;
}

}  // namespace jaywalk
