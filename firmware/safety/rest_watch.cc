#include "firmware/safety/rest_watch.h"

#include <algorithm>
#include <cmath>

namespace jaywalk {
namespace {
/// A wheel's rim at rest: a Hall sensor's count of a VESC is 2 mm.
constexpr double kRolls_m = 0.005;
/// Time from the last reading that rolled to the first scan of the rest: a body sways after a stop.
constexpr Duration kSettles = std::chrono::milliseconds(200);
/// Smallest move: more than a scanner shakes in its mount, and what the localizer's match puts right by itself.
constexpr double kMove_m = 0.1, kMove_rad = 0.06;
/// Natural logarithm of a likelihood ratio, as MotionModel's for an arc that stands.
constexpr double kMoveEvidence = 27.0;
/// Share of what was compared that a place explains if the robot is there, and that none explains that it left: with
/// 0.5 for both, twelve people within two metres look like a move (safety_tests "stands among people").
constexpr double kPlaceExplains = 0.5, kLeftExplains = 0.35;
/// Least that is compared: as a share of what the first scan showed, and as a sum of weights (a wall's point has 1).
constexpr double kInView = 0.15, kLeastInView = 12.0;
/// Explained less than kFresh while the robot stands, within so much: things were moved, and the first scan is renewed.
constexpr double kFresh = 0.75, kStill_m = 0.02, kStill_rad = 0.01;
constexpr int kDoubtTimes = 3;
/// Standard deviation of the errors of a rest that has only begun, m; and what a scan adds to what is known of it.
constexpr double kNoiseAtFirst_m = 0.03, kNoiseGain = 0.2;

bool is_far(const Pose2& moved) {
  return norm(moved.position()) > kMove_m || std::fabs(wrap_angle(moved.heading)) > kMove_rad;
}

}  // namespace

RestWatch::RestWatch(const RobotModel& model, std::size_t scanner)
    : wheel_radius_m_(model.drive.wheel_radius_m),
      pair_(model.lasers()[scanner].robot_from_laser),
      back_(model.lasers()[scanner].robot_from_laser) {}

void RestWatch::begin_anew() noexcept {
  kept_ = false;
  doubts_ = changes_ = 0;
}

RestWatch::Says RestWatch::judge(const LaserScan& scan, const WheelState& wheels) noexcept {
  note(wheels);
  const bool is_new = scan.sequence != scan_seen_ && scan.sequence != 0;
  // A reading no older than the scan shows that the wheels stood for it.
  if (!is_new || rests_since_ == kNever || scan.stamp < rests_since_ + kSettles || wheels_stamp_ < scan.stamp)
    return Says::kNothing;
  scan_seen_ = scan.sequence;
  if (!pair_.usable(scan) || !back_.usable(scan)) return Says::kNothing;
  if (kept_ && pair_.is_kept()) return compare(scan);
  back_.keep(scan);
  keep(scan);
  return Says::kNothing;
}

void RestWatch::note(const WheelState& wheels) noexcept {
  if (wheels.sequence == wheels_seen_ || wheels.sequence == 0) return;
  const bool restarted = wheels.sequence < wheels_seen_;
  wheels_seen_ = wheels.sequence;
  if (!std::isfinite(wheels.left_rad) || !std::isfinite(wheels.right_rad)) return;
  const double left_m = wheel_radius_m_ * wheels.left_rad, right_m = wheel_radius_m_ * wheels.right_rad;
  const bool rolled = std::max(std::fabs(left_m - left_m_), std::fabs(right_m - right_m_)) > kRolls_m;
  wheels_stamp_ = wheels.stamp;
  if (rests_since_ != kNever && !rolled) return;
  left_m_ = left_m, right_m_ = right_m;
  if (restarted && rests_since_ != kNever) return;  // counted from elsewhere: scans tell whether the robot stood
  rests_since_ = wheels.stamp;
  begin_anew();
}

void RestWatch::keep(const LaserScan& scan) noexcept {
  begin_anew();
  first_ = scan;
  pair_.keep(scan);
  kept_ = true;
  fit_ = {};
  noise_m_ = kNoiseAtFirst_m;
  kept_weight_ = agreement(scan, {}).compared;
}

RestWatch::Agreement RestWatch::agreement(const LaserScan& scan, const Pose2& first_from_now) const noexcept {
  ScanPair::Fit gone{.kept_from_now = first_from_now, .noise_m = noise_m_};
  pair_.improve(scan, gone);
  ScanPair::Fit come{.kept_from_now = inverse(first_from_now), .noise_m = noise_m_};
  back_.improve(first_, come);
  const double compared = gone.compared + come.compared;
  return {compared, (gone.compared * gone.explained + come.compared * come.explained) / compared};
}

RestWatch::Says RestWatch::compare(const LaserScan& scan) noexcept {
  find(scan);
  const Agreement standing = agreement(scan, {}), there = agreement(scan, fit_.kept_from_now);
  const bool in_view = standing.compared >= kLeastInView && standing.compared >= kInView * kept_weight_;
  const bool nowhere = in_view && standing.explained < kLeftExplains && there.explained < kPlaceExplains;
  const bool moved = is_far(fit_.kept_from_now) && there.explained >= kPlaceExplains &&
                     there.explained * there.compared > standing.explained * standing.compared && is_likelier(scan);
  doubts_ = moved || nowhere ? std::min(doubts_ + 1, kDoubtTimes) : 0;
  if (doubts_ > 0) return doubts_ < kDoubtTimes ? Says::kDoubts : Says::kMoved;
  if (!in_view) return Says::kNothing;
  if (standing.explained > kFresh) noise_m_ += kNoiseGain * (fit_.noise_m - noise_m_);
  const bool stands =
      norm(fit_.kept_from_now.position()) < kStill_m && std::fabs(fit_.kept_from_now.heading) < kStill_rad;
  changes_ = stands && standing.explained < kFresh ? changes_ + 1 : 0;
  if (changes_ >= kDoubtTimes) keep(scan);
  return Says::kStands;
}

/// Starts from the place found last, since the robot may be under way in a person's hands, and from its rest.
void RestWatch::find(const LaserScan& scan) noexcept {
  back_.keep(scan);
  const ScanPair::Fit on = pair_.fit(scan, fit_.kept_from_now), rested = pair_.fit(scan, {});
  fit_ = on.explained * on.compared > rested.explained * rested.compared ? on : rested;
}

bool RestWatch::is_likelier(const LaserScan& scan) const noexcept {
  const Pose2& there = fit_.kept_from_now;
  const auto gone = pair_.advantage(pair_.errors(scan, there), pair_.errors(scan, {}), fit_.noise_m, false);
  const auto come =
      back_.advantage(back_.errors(first_, inverse(there)), back_.errors(first_, {}), fit_.noise_m, false);
  return ScanPair::without_greatest(gone) + ScanPair::without_greatest(come) > kMoveEvidence;
}

}  // namespace jaywalk
