#include "firmware/safety/felt_motion.h"

#include <algorithm>
#include <cmath>

namespace jaywalk {
namespace {
/// A loop that is silent for longer may have its drives' watchdogs stop them.
constexpr Duration kSilent = std::chrono::milliseconds(75);
/// An older reading is another fault's, of any drive.
constexpr double kOldest_s = 0.1;

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

}  // namespace jaywalk
