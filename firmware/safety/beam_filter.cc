#include "firmware/safety/beam_filter.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace jaywalk {
namespace {
constexpr double kWhole_m = 0.07;        ///< a cylinder that every scan is to show (SAFETY 8)
constexpr double kSlim_m = 0.02;         ///< width of a body that is believed at once; half of its beams may be lost
constexpr double kSameBody_m = 0.07;     ///< ranges of one body differ by so much, and
constexpr double kSameBodyBeams = 10.0;  ///< on a wall that is seen at 6 degrees, by so many times the beams' distance
constexpr double kAlong_m = 0.03;        ///< a range's noise between two scans: two standard deviations of 1 cm each
constexpr double kAside_m = 0.007;       ///< error of odometry between two scans: 5 ms of a stamp at 1.2 m/s
constexpr double kTurn_rad = 0.01;       ///< the same of its heading: 5 ms of a stamp at 1.5 rad/s
constexpr double kLeastApart_m = 1e-4;   ///< least distance between two beams, m: of what stands on the window

double range_of(const LaserScan& scan, std::size_t beam) { return static_cast<double>(scan.range_m[beam]); }

double step_of(const LaserScan& scan) { return std::fabs(static_cast<double>(scan.angle_step_rad)); }

/// Whether the beams about this one show a body of kSlim_m.
bool has_neighbours(const LaserScan& scan, std::size_t beam) {
  const double range = range_of(scan, beam), apart_m = std::max(range * step_of(scan), kLeastApart_m);
  if (kWhole_m < 3.0 * apart_m) return true;  // so far away a cylinder may be one beam
  const double beams = kSlim_m / apart_m;
  const auto needed = static_cast<std::size_t>(std::max(2.0, std::ceil(0.5 * beams)));
  const auto reach = static_cast<std::size_t>(std::max(2.0, beams));
  const std::size_t last = std::min<std::size_t>(beam + reach, scan.beam_count - 1U);
  std::size_t alike = 0;
  for (std::size_t k = beam - std::min(beam, reach); k <= last; ++k)
    alike += scan.is_hit(k) && std::fabs(range_of(scan, k) - range) < kSameBody_m + kSameBodyBeams * apart_m ? 1U : 0U;
  return alike >= needed;
}

}  // namespace

void LoneReturns::take(const LaserScan& scan, const Pose2& now_from_before) noexcept {
  std::swap(now_, before_);
  now_.scan = scan;
  for (std::size_t k = 0; k < scan.beam_count; ++k)  // of a recording: what was struck out
    if (!scan.too_near(k) && scan.range_m[k] < 0.0F) now_.scan.range_m[k] = -scan.range_m[k];
  const Transform2 before_from_now(inverse(now_from_before));
  const bool has_before = before_.scan.sequence != 0 && before_.scan.angle_step_rad != 0.0F;
  for (std::size_t k = 0; k < now_.scan.beam_count; ++k) {
    now_.times[k] = now_.scan.is_hit(k) ? kBelieved : std::uint8_t{0};
    if (now_.times[k] == 0 || has_neighbours(now_.scan, k)) continue;
    const Vec2 place = before_from_now * (direction(now_.scan.angle_rad(k)) * range_of(now_.scan, k));
    const std::uint8_t before_times = has_before ? times_before(place) : std::uint8_t{0};
    now_.times[k] = std::min<std::uint8_t>(kBelieved, static_cast<std::uint8_t>(before_times + 1U));
  }
}

std::uint8_t LoneReturns::times_before(Vec2 place) const noexcept {
  const auto step = static_cast<double>(before_.scan.angle_step_rad);
  const double middle = 0.5 * before_.scan.beam_count, ahead = before_.scan.angle_rad(0) + middle * step;
  const double range = norm(place);
  const double aside = (kAside_m / std::max(range, kAside_m) + kTurn_rad) / std::fabs(step) + 1.0;
  const double at = middle + wrap_angle(jaywalk::atan2(place.y, place.x) - ahead) / step;
  const auto last = static_cast<std::size_t>(std::clamp(at + aside + 1.0, 0.0, 2.0 * middle));
  std::uint8_t most = 0;
  for (auto k = static_cast<std::size_t>(std::clamp(std::ceil(at - aside), 0.0, 2.0 * middle)); k < last; ++k)
    if (std::fabs(range_of(before_.scan, k) - range) < kAlong_m) most = std::max(most, before_.times[k]);
  return most;
}

void LoneReturns::strike_out(LaserScan& scan) const noexcept {
  for (std::size_t k = 0; k < scan.beam_count; ++k)
    if (now_.scan.is_hit(k)) scan.range_m[k] = now_.times[k] < kBelieved ? -now_.scan.range_m[k] : now_.scan.range_m[k];
}

BeamFilter::BeamFilter(const RobotModel& model, std::size_t scanner, bool has_wheels)
    : blanked_(model.lasers()[scanner].blanked),
      robot_from_laser_(model.lasers()[scanner].robot_from_laser),
      track_width_m_(model.drive.track_width_m),
      has_wheels_(has_wheels),
      travel_(model.drive) {}

void BeamFilter::filter(LaserScan& scan, const WheelState& wheels) noexcept {
  blank(blanked_, scan);
  travel_.note(wheels);
  if (!has_wheels_ || scan.sequence == 0 || scan.beam_count < 2 || scan.beam_count > kMaxBeams) return;
  const bool is_new = std::exchange(sequence_, scan.sequence) != scan.sequence;
  const Pose2 moved = is_new ? now_from_before(scan.stamp) : Pose2{};
  if (is_new) lone_returns_.take(scan, moved);
  lone_returns_.strike_out(scan);
  if (is_new) free_claims_.take(scan, moved);
  free_claims_.strike_out(scan);
}

/// Pose of the laser at its scan before, in its frame at this one; none where the wheels do not tell.
Pose2 BeamFilter::now_from_before(Time stamp) noexcept {
  Rolled rolled;
  const bool known = travel_.expected_at(stamp, rolled);
  const Pose2 moved = known && rolled_known_ ? arc_of(rolled - rolled_, track_width_m_) : Pose2{};
  rolled_ = rolled;
  rolled_known_ = known;
  return inverse(inverse(robot_from_laser_) * moved * robot_from_laser_);
}

}  // namespace jaywalk
