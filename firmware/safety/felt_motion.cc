#include "firmware/safety/felt_motion.h"

#include <algorithm>
#include <cmath>

namespace jaywalk {
namespace {

/// A loop that is silent for longer may have its drives' watchdogs stop them.
constexpr Duration kSilent = std::chrono::milliseconds(75);
/// An older reading is another fault's, of any drive.
constexpr double kOldest_s = 0.1;

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

FeltMotion::FeltMotion(const DriveModel& drive, const MotionLimits& limits)
    : wheel_radius_m_(drive.wheel_radius_m),
      ramp_mps2_(limits.brake_mps2),
      obeys_within_(duration_from_seconds(drive.times.obeyed_within_s())),
      oldest_(duration_from_seconds(std::max(drive.times.oldest_report_s(), kOldest_s))),
      apart_m_(kApart_m + limits.max_speed_mps * (drive.times.report_s + drive.times.late_s)) {}

void FeltMotion::keep(const Sent& sent) noexcept {
  const Sent& last = sent_[newest_];
  if (last.from != kNever && last.left_mps == sent.left_mps && last.right_mps == sent.right_mps) return;
  newest_ = (newest_ + 1) % kMostCommands;
  sent_[newest_] = sent;
}

/// Span of the commands that held at any time of the last obeys_within_; zero before the first.
FeltMotion::Span FeltMotion::commanded(double Sent::*wheel, Time now, bool zero_too) const noexcept {
  const double newest = sent_[newest_].*wheel;
  Span span{zero_too ? std::min(newest, 0.0) : newest, zero_too ? std::max(newest, 0.0) : newest};
  for (std::size_t back = 0; back < kMostCommands; ++back) {
    const Sent& sent = sent_[(newest_ + kMostCommands - back) % kMostCommands];
    span.least = std::min(span.least, sent.*wheel);
    span.greatest = std::max(span.greatest, sent.*wheel);
    if (sent.from == kNever || now - sent.from >= obeys_within_) break;
  }
  return span;
}

bool FeltMotion::is_off(Wheel& wheel, const Span& commanded, double felt_mps, double step_s) const noexcept {
  const double ramped = ramp_mps2_ * step_s;
  Span& may_be = wheel.may_be;
  may_be.greatest = std::max(commanded.greatest, may_be.greatest - ramped);
  may_be.least = std::min(commanded.least, may_be.least + ramped);
  const auto tolerance = [](double bound) { return kOff_mps + kOffShare * std::fabs(bound); };
  const double over = felt_mps - may_be.greatest - tolerance(may_be.greatest);
  const double under = may_be.least - tolerance(may_be.least) - felt_mps;
  wheel.off_m = std::clamp(wheel.off_m + std::max(over, under) * step_s, 0.0, 2.0 * kFault_m);
  return wheel.off_m > kFault_m;
}

/// One-sided sums each way: counters that are read less often than speeds lag and catch up.
void FeltMotion::compare(Wheel& wheel, double rolled_m, double felt_mps, double step_s) const noexcept {
  const double off_m = rolled_m - felt_mps * step_s;
  const double tolerated_m =
      kOff_mps * step_s + kApartShare * std::max(std::fabs(felt_mps) * step_s, std::fabs(rolled_m));
  wheel.ahead_m = std::clamp(wheel.ahead_m + off_m - tolerated_m, 0.0, 2.0 * apart_m_);
  wheel.behind_m = std::clamp(wheel.behind_m - off_m - tolerated_m, 0.0, 2.0 * apart_m_);
}

bool FeltMotion::contradicts_itself(const WheelState& wheels) noexcept {
  const Duration step = age(counted_.stamp, wheels.stamp);
  const double step_s = to_seconds(step), left_m = wheel_radius_m_ * (wheels.left_rad - counted_.left_rad),
               right_m = wheel_radius_m_ * (wheels.right_rad - counted_.right_rad);
  const bool follows = step > Duration{0} && step <= oldest_ && std::isfinite(left_m) && std::isfinite(right_m);
  counted_ = wheels;
  if (follows) {
    compare(left_, left_m, wheel_radius_m_ * wheels.left_radps, step_s);
    compare(right_, right_m, wheel_radius_m_ * wheels.right_radps, step_s);
  }
  return std::max({left_.ahead_m, left_.behind_m, right_.ahead_m, right_.behind_m}) > apart_m_;
}

bool FeltMotion::disobeys(const WheelCommand& command, const WheelState& wheels, Time now) noexcept {
  const Duration step = judged_ == kNever ? Duration{0} : now - judged_;
  judged_ = now;
  const double radius = wheel_radius_m_;
  keep({now - step, radius * command.left_radps, radius * command.right_radps});
  if (step > kSilent || wheels.trouble != DriveTrouble::kNone) zero_until_ = now + obeys_within_;
  const bool zero_too = zero_until_ != kNever && now < zero_until_;
  const bool readable = wheels.sequence > 0 && now - wheels.stamp <= oldest_ && std::isfinite(wheels.left_radps) &&
                        std::isfinite(wheels.right_radps);
  const auto judge = [&](Wheel& wheel, double Sent::*sent, double felt_radps) {
    const Span span = commanded(sent, now, zero_too);
    return is_off(wheel, span, readable ? radius * felt_radps : wheel.may_be.greatest,
                  to_seconds(std::clamp(step, Duration{0}, kSilent)));
  };
  const bool left = judge(left_, &Sent::left_mps, wheels.left_radps);
  const bool right = judge(right_, &Sent::right_mps, wheels.right_radps);
  const bool apart = readable && contradicts_itself(wheels);
  return left || right || apart;
}

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
