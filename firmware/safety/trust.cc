#include "firmware/safety/trust.h"

#include <cmath>

namespace jaywalk {
namespace {

constexpr Duration kMostAhead = std::chrono::milliseconds(100);

bool has_directions(const LaserScan& scan) {
  return std::isfinite(scan.first_angle_rad) && std::isfinite(scan.angle_step_rad) && scan.angle_step_rad != 0.0F;
}

}  // namespace

bool is_trustworthy(const LaserScan& scan, const LaserModel& laser) noexcept {
  if (scan.beam_count != laser.beams || scan.beam_count > kMaxBeams || !has_directions(scan)) return false;
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

}  // namespace jaywalk
