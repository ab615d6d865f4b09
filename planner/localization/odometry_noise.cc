#include "planner/localization/odometry_noise.h"

namespace jaywalk {
namespace {
// Unknown wheels: 5 cm and 2 degrees after a metre, 15 cm and 4 degrees after a turn of one radian (a laser that is not
// where it is said to be moves aside then).
constexpr double kPositionVarPerM = 0.05 * 0.05;
constexpr double kPositionVarPerRad = 0.15 * 0.15;
constexpr double kHeadingVarPerM = 0.035 * 0.035;
constexpr double kHeadingVarPerRad = 0.07 * 0.07;

constexpr double kWindowHeadingVar = 0.1 * 0.1;
constexpr double kWindowPositionVar = 0.14 * 0.14;
constexpr double kMapHeading = 0.005,
                 kMapM = 0.03;  // what the map may be off by: measured, docs/explanation/results.md#tracking-and-poses
constexpr double kWindowGain = 0.5;

// Kalman filter for the one number that WheelRadiusBias learns.
constexpr double kSurpriseHeadingVar = 0.015 * 0.015;
constexpr double kWheelHeadingVar = 0.03 * 0.03;     // a metre or radian
constexpr double kDriftChangeVar = 0.0005 * 0.0005;  // a metre or radian: tyres wear, loads shift
constexpr double kMostDriftVar = 0.06 * 0.06;

double squared_beyond(double value, double allowed) { return std::max(0.0, value * value - allowed * allowed); }

double way(const ArcStep& step) { return std::fabs(step.distance_m) + std::fabs(step.turn_rad); }

// By trial (decision localization).
constexpr double kDoubtfulSigmas = 3.0, kDoubtfulFit = 0.2, kBetterFit = 0.1;
constexpr double kFitGain = 0.1;  // of the running mean
// Without the wheels a search is wide. Scans more than 0.18 s apart would find other walls (Intel's: 0.45 degrees over
// 10 m, not 0.19), and by trial on Freiburg, whose wheels hop, what is found must stand out.
constexpr double kMostCoastedVar = 0.1 * 0.1, kMuchBetterFit = 0.3;

}  // namespace

OdometryNoise noise_of_unknown_wheels(const ArcStep& step) noexcept {
  const double metres = std::fabs(step.distance_m), radians = std::fabs(step.turn_rad);
  return {kPositionVarPerM * metres + kPositionVarPerRad * radians,
          kHeadingVarPerM * metres + kHeadingVarPerRad * radians};
}

void OdometryNoiseEstimator::Share::end_window() noexcept {
  believed = std::clamp(believed + kWindowGain * (worst - believed), kLeastShare, 1.0);
}

void OdometryNoiseEstimator::corrected(const Pose2& predicted, const Pose2& placed) noexcept {
  if (!begun_) return begin();
  moved_in_map_ = moved_in_map_ + (placed.position() - predicted.position());
  turned_ += wrap_angle(placed.heading - predicted.heading);
  turns_.moved(squared_beyond(turned_, kMapHeading) / std::max(window_.heading_var, kWindowHeadingVar));
  metres_.moved(0.5 * squared_beyond(norm(moved_in_map_), kMapM) / std::max(window_.position_var, kWindowPositionVar));
  if (window_.heading_var < kWindowHeadingVar) return;
  turns_.end_window();
  metres_.end_window();
  begin();
}

void WheelRadiusBias::corrected(double turn_rad) noexcept {
  const double metres = since_.distance_m, driven = way(since_);
  since_ = {};
  variance_ = std::min(variance_ + kDriftChangeVar * driven, kMostDriftVar);
  const double surprise_var = kSurpriseHeadingVar + kWheelHeadingVar * driven + metres * metres * variance_;
  if (std::fabs(turn_rad) > kMost * std::fabs(metres) + std::sqrt(kSurpriseHeadingVar + kWheelHeadingVar * driven))
    return;
  const double gain = variance_ * metres / surprise_var;
  turn_per_m_ = std::clamp(turn_per_m_ + gain * turn_rad, -kMost, kMost);
  variance_ -= gain * metres * variance_;
}

MatchResult SlipDetector::match(const MatchSample& sample, const EvidenceMap& still,
                                const OdometryPrior& wheels) noexcept {
  MatchResult found = best(sample, still, wheels);
  found.matched = found.matched && finite(found.belief.map_from_robot);
  if (found.matched) usual_fit_ += kFitGain * (found.fit - usual_fit_);
  contradicted_ = found.contradicted;
  return found;
}

MatchResult SlipDetector::best(const MatchSample& sample, const EvidenceMap& still,
                               const OdometryPrior& wheels) const noexcept {
  const MatchResult found = by_wheels(sample, still, wheels);
  const bool fits = found.matched ? found.fit >= usual_fit_ - kDoubtfulFit : !found.contradicted;
  if (fits || wheels.coasted.covariance(2, 2) > kMostCoastedVar) return found;
  return better(found, match_sample(sample, {still}, wheels.coasted), kMuchBetterFit);
}

MatchResult SlipDetector::by_wheels(const MatchSample& sample, const EvidenceMap& still,
                                    const OdometryPrior& wheels) const noexcept {
  const Pose2& predicted = wheels.map_from_robot;
  if (contradicted_ || !wheels.learnt) return match_sample(sample, {still}, {predicted, wheels.if_slipped});
  const MatchResult found = match_sample(sample, {still}, {predicted, wheels.covariance});
  if (!doubtful(found, wheels)) return found;
  return better(found, match_sample(sample, {still}, {predicted, wheels.if_slipped}), kBetterFit);
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
