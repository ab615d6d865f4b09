#include "drivers/stop_ladder.h"

#include <algorithm>
#include <cmath>

namespace jaywalk {

StopLimits stop_limits(double brake_radps2, double tolerance_radps, Duration tick, const DriveTimes& drive) noexcept {
  StopLimits limits{.brake_radps2 = brake_radps2, .tolerance_radps = tolerance_radps};
  const Duration slower = duration_from_seconds(drive.slower_s(to_seconds(tick)));
  limits.response = std::max<Duration>(limits.response, std::chrono::milliseconds(20) + 2 * tick) + slower;
  limits.fresh = std::max({limits.fresh, 5 * tick / 2, duration_from_seconds(drive.oldest_report_s())});
  limits.tick = tick;
  limits.confirmation += slower;
  return limits;
}

StopStage StopLadder::update(Time now, bool stopping, bool trouble,
                             const std::array<WheelFeedback, 2>& wheels) noexcept {
  follow_orders(now, wheels);
  if (!stopping && stage_ == StopStage::kNone) {
    under_way_ = ended_ = false;
    return stage_;
  }
  // A stop that this ladder itself made trouble of is under way already.
  const bool new_trouble = trouble && !trouble_ && stage_ == StopStage::kNone;
  trouble_ = trouble_ || trouble;
  // Trouble that comes into a stop under way gives it no time anew.
  if (new_trouble && under_way_) stage_ = StopStage::kQuickStop;
  if (!under_way_ && (!ended_ || new_trouble)) begin(now, wheels);
  if (!under_way_) return stage_;
  if (!trouble_ && stage_ == StopStage::kNone && is_at_rest(now, wheels)) {
    under_way_ = false;
    ended_ = true;
    return stage_;
  }
  if (is_over(now) && !confirmed_) {
    confirmed_ = is_at_rest(now, wheels);
    if (!confirmed_) stage_ = StopStage::kSilent;
  }
  if (now - ordered_ > limits_.response && !is_kept(now, wheels)) climb(now);
  return stage_;
}

void StopLadder::reset() noexcept { *this = StopLadder(limits_); }

// What a wheel was told holds until now; what it is told in this cycle counts from now on.
void StopLadder::follow_orders(Time now, const std::array<WheelFeedback, 2>& wheels) noexcept {
  const bool is_first = followed_ == kNever;
  const double braked = is_first ? 0.0 : limits_.brake_radps2 * to_seconds(now - followed_);
  followed_ = now;
  for (std::size_t k = 0; k < wheels.size(); ++k) {
    const double told = std::fabs(wheels[k].told_radps);
    owed_radps_[k] = std::max(is_first ? told : told_radps_[k], owed_radps_[k] - braked);
    told_radps_[k] = told;
  }
}

void StopLadder::begin(Time now, const std::array<WheelFeedback, 2>& wheels) noexcept {
  under_way_ = true;
  ended_ = false;
  ordered_ = now;
  for (std::size_t k = 0; k < wheels.size(); ++k)
    speed_at_order_[k] = std::min(std::fabs(wheels[k].speed_radps), owed_radps_[k]);
  longest_s_ =
      std::max(speed_at_order_[0], speed_at_order_[1]) / limits_.brake_radps2 + to_seconds(limits_.confirmation);
  confirmed_ = false;
  // The drives are told to quick-stop at once where there is trouble.
  if (trouble_) stage_ = std::max(stage_, StopStage::kQuickStop);
}

// Written so that a ramp that is no number is over.
bool StopLadder::is_over(Time now) const noexcept { return !(to_seconds(now - ordered_) <= longest_s_); }

bool StopLadder::is_fresh(Time now, const WheelFeedback& wheel) const noexcept {
  return age(wheel.stamp, now) <= limits_.fresh;
}

bool StopLadder::is_kept(Time now, const std::array<WheelFeedback, 2>& wheels) const noexcept {
  const double braked = limits_.brake_radps2 * to_seconds(now - ordered_ - limits_.response);
  for (std::size_t k = 0; k < wheels.size(); ++k) {
    const double most = std::max(speed_at_order_[k] - braked, 0.0) + limits_.tolerance_radps;
    // Written so that a speed that is no number is not kept.
    if (!is_fresh(now, wheels[k]) || !(std::fabs(wheels[k].speed_radps) <= most)) return false;
  }
  return true;
}

bool StopLadder::is_at_rest(Time now, const std::array<WheelFeedback, 2>& wheels) const noexcept {
  return std::all_of(wheels.begin(), wheels.end(), [&](const WheelFeedback& wheel) {
    return is_fresh(now, wheel) && std::fabs(wheel.speed_radps) <= limits_.tolerance_radps;
  });
}

void StopLadder::climb(Time now) noexcept {
  if (stage_ == StopStage::kSilent || age(climbed_, now) < limits_.stage) return;
  stage_ = static_cast<StopStage>(static_cast<int>(stage_) + 1);
  // The network stop comes with a quick stop: it waits for no cycle that would be silent.
  if (!confirmed_ && is_over(now + limits_.tick)) stage_ = std::max(stage_, StopStage::kNetworkStop);
  climbed_ = now;
}

}  // namespace jaywalk
