#include "firmware/safety/latency.h"

#include <cmath>

namespace jaywalk {
namespace {
constexpr Duration kMostAhead = std::chrono::milliseconds(100);

constexpr double kMemory_s = 2.0;                      // of time in which commands changed
constexpr double kEnough_s = 0.3;                      // of it, before anything is said
constexpr Duration kAtRest = std::chrono::seconds(1);  // after which what was measured is forgotten
constexpr double kLongest_s = 0.05;                    // that a usual drive's reading stands for

double squares(const WheelState& felt, const WheelCommand& wanted) {
  const double left = felt.left_radps - wanted.left_radps, right = felt.right_radps - wanted.right_radps;
  return left * left + right * right;
}

}  // namespace

bool is_trustworthy(const LaserScan& scan, const LaserModel& laser) noexcept {
  if (scan.beam_count != laser.beams || scan.beam_count > kMaxBeams) return false;
  if (!std::isfinite(scan.first_angle_rad) || !std::isfinite(scan.angle_step_rad) || scan.angle_step_rad == 0.0F)
    return false;
  std::size_t measured = 0;
  for (std::size_t beam = 0; beam < scan.beam_count; ++beam)
    measured += scan.state(beam) != BeamState::kUnknown ? 1U : 0U;
  return measured >= kLeastBeams;
}

bool is_trustworthy(const WheelState& wheels) noexcept {
  return std::isfinite(wheels.left_rad) && std::isfinite(wheels.right_rad) && std::isfinite(wheels.left_radps) &&
         std::isfinite(wheels.right_radps);
}

bool is_older(Time stamp, Time now, Duration limit) noexcept {
  const Duration old = age(stamp, now);
  return old > limit || old < -kMostAhead;
}

DriveResponse::DriveResponse(const DriveModel& drive)
    : telling_radps_(kTelling_mps / drive.wheel_radius_m),
      delays_(
          std::min(static_cast<std::size_t>(most_drive_s(drive.times) / to_seconds(kDelayStep) + 1.5), kMostDelays)),
      longest_s_(std::max(kLongest_s, drive.times.report_s)) {}

/// The command that was in force then; null where it is not kept.
const WheelCommand* DriveResponse::command_at(Time time) const noexcept {
  const std::size_t kept = std::min(count_, kKept);
  for (std::size_t back = 1; back <= kept; ++back) {
    const WheelCommand& command = commands_[(count_ - back) % kKept];
    if (command.stamp <= time) return &command;
  }
  return nullptr;
}

/// Whether the commands of the longest delay before that time differ enough to tell delays apart.
bool DriveResponse::changed_before(Time time) const noexcept {
  const WheelCommand* const last = command_at(time);
  const Time first = time - (delays_ - 1) * kDelayStep;
  if (last == nullptr || command_at(first) == nullptr) return false;
  double most = 0.0;
  for (const WheelCommand& command : commands_) {
    if (command.stamp < first || command.stamp > time) continue;
    most = std::max(
        {most, std::fabs(command.left_radps - last->left_radps), std::fabs(command.right_radps - last->right_radps)});
  }
  return most > telling_radps_;
}

/// A stop, and what followed it, tells nothing about the drives that set out anew: a reset must not fail by it.
void DriveResponse::forget_at_rest(const WheelCommand& command) noexcept {
  if (command.left_radps != 0.0 || command.right_radps != 0.0) moved_ = command.stamp;
  if (command.stamp - moved_ <= kAtRest) return;
  misfit_ = {};
  told_s_ = seconds_ = 0.0;
}

void DriveResponse::add(const WheelState& wheels, const WheelCommand& command) noexcept {
  forget_at_rest(command);
  const bool is_new = wheels.sequence != seen_ && std::isfinite(wheels.left_radps) && std::isfinite(wheels.right_radps);
  seen_ = wheels.sequence;
  if (is_new && changed_before(wheels.stamp)) {
    const double step_s = std::clamp(told_ == kNever ? 0.0 : to_seconds(wheels.stamp - told_), 0.0, longest_s_);
    const double kept = std::max(0.0, 1.0 - step_s / kMemory_s);
    for (std::size_t k = 0; k < delays_; ++k)
      misfit_[k] = kept * misfit_[k] + step_s * squares(wheels, *command_at(wheels.stamp - k * kDelayStep));
    told_ = wheels.stamp;
    told_s_ += step_s;
    const auto best = std::min_element(misfit_.begin(), misfit_.begin() + delays_) - misfit_.begin();
    if (told_s_ >= kEnough_s) seconds_ = to_seconds(best * kDelayStep);
  }
  commands_[count_++ % kKept] = command;
}

void Latency::add(Time now, Duration took, const WheelState& wheels, const WheelCommand& command) noexcept {
  if (span_began_ == kNever || now - span_began_ > kSpan) {
    span_began_ = now;
    worst_before_ = worst_;
    worst_ = Duration{0};
  }
  worst_ = std::max(worst_, took);
  response_.add(wheels, command);
}

bool ScanTiming::is_stale(const LaserScan& scan, Time now) noexcept {
  bool two_lost = false;
  if (scan.sequence != sequence_) {
    if (sequence_ != 0 && scan.sequence > sequence_ && scan.stamp != kNever) {
      const double periods = to_seconds(scan.stamp - stamp_) * rate_hz_;
      two_lost = periods - static_cast<double>(scan.sequence - sequence_) > kOldestScanPeriods - 1.0;
    }
    sequence_ = scan.sequence;
    stamp_ = scan.stamp;
  }
  // A scan is as old as its last beam; the stop zone reckons with the first.
  const Duration limit = duration_from_seconds(kOldestScanPeriods / rate_hz_) + sweep_of(scan, rate_hz_);
  return two_lost || is_older(scan.stamp, now, limit);
}

}  // namespace jaywalk
