#include "firmware/safety/beam_filter.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace jaywalk {
namespace {

/// Width that a walking pedestrian may uncover between two scans: a fast walk's way, and noise, edges and legs.
constexpr double kWalk_mps = 2.0, kEdges_m = 0.15;
/// Fewer beams are flicker of an edge or of a dark surface.
constexpr std::size_t kLeastVanished = 4;
/// Beams without a vanished one that part two groups of them.
constexpr std::size_t kMostApart = 4;
/// A narrower angle, close by, may be an edge; a wider one needs a surface beside it that moves.
constexpr double kWide_rad = 10.0 * kPi / 180.0;
constexpr double kBeside_m = 0.7;  ///< a body's width and a step
constexpr double kMoved_m = 0.06;  ///< two standard deviations of a common scanner's range
/// Share of the reach in which a surface is certain to echo again.
constexpr double kSureShare = 0.9;
/// Age to which a surface is expected where its beam has told nothing since.
constexpr double kOldestSeen_s = 1.0;
constexpr double kMostWay_m = 1.0;  ///< between two scans; more is another robot

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

void FreeClaims::take(const LaserScan& scan, const Pose2& now_from_before) noexcept {
  learn_directions(scan);
  expect(scan, now_from_before);
  find_vanished(scan);
  believe_hits(scan);
  remember(scan);
}

void FreeClaims::strike_out(LaserScan& scan) const noexcept {
  for (std::size_t k = 0; k < beams_; ++k)
    if ((silent_ || doubt_[k] != Doubt::kNone) && scan.found_nothing(k)) scan.range_m[k] = 0.0F;
}

void FreeClaims::learn_directions(const LaserScan& scan) noexcept {
  const auto first = static_cast<double>(scan.first_angle_rad), step = static_cast<double>(scan.angle_step_rad);
  if (scan.beam_count == beams_ && first == first_rad_ && step == step_rad_) return;
  beams_ = scan.beam_count;
  first_rad_ = first;
  step_rad_ = step;
  all_round_ = static_cast<double>(beams_) * std::fabs(step) > 2.0 * kPi - 0.5 * std::fabs(step);
  surface_ = {};
  doubt_ = {};
  hit_ = scan.stamp;
}

void FreeClaims::expect(const LaserScan& scan, const Pose2& now_from_before) noexcept {
  expected_ = {};
  if (norm(now_from_before.position()) > kMostWay_m || step_rad_ == 0.0) return;
  const Transform2 to_now(now_from_before);
  for (std::size_t k = 0; k < beams_; ++k) {
    if (surface_[k].seen == kNever || to_seconds(scan.stamp - surface_[k].seen) > kOldestSeen_s) continue;
    const Vec2 place = to_now * surface_[k].in_laser;
    const double range_m = norm(place);
    const std::size_t beam = beam_towards(place);
    if (beam >= beams_ || range_m < static_cast<double>(scan.range_min_m) ||
        range_m > kSureShare * static_cast<double>(scan.range_max_m))
      continue;
    Surface& nearest = expected_[beam];
    if (nearest.seen == kNever || range_m < norm(nearest.in_laser)) nearest = {place, surface_[k].seen};
  }
}

/// beams_ or more where none looks there.
std::size_t FreeClaims::beam_towards(Vec2 in_laser) const noexcept {
  const double past_first = wrap_angle(atan2(in_laser.y, in_laser.x) - first_rad_) * (step_rad_ < 0.0 ? -1.0 : 1.0);
  const double turned = past_first < -0.5 * std::fabs(step_rad_) ? past_first + 2.0 * kPi : past_first;
  const auto beam = static_cast<std::size_t>(std::max(0.0, turned / std::fabs(step_rad_) + 0.5));
  return all_round_ ? at(beam) : beam;
}

void FreeClaims::find_vanished(const LaserScan& scan) noexcept {
  std::size_t begin = 0, hits = 0;
  for (std::size_t k = beams_; k > 0; --k) {
    if (!scan.is_hit(k - 1)) continue;
    ++hits;
    if (all_round_) begin = k;  // beyond the last beam is the first
  }
  if (hits >= kLeastBeams) hit_ = scan.stamp;
  silent_ = scan.stamp - hit_ > kSilent;
  Vanished vanished;
  const auto judge = [&] {
    if (has_failed(scan, vanished)) doubt(scan, vanished);
    vanished = {};
  };
  for (std::size_t k = begin; k < begin + beams_; ++k) {
    const std::size_t beam = at(k);
    const bool should_hit = expected_[beam].seen != kNever && doubt_[beam] == Doubt::kNone;
    if (scan.is_hit(beam) || (vanished.beams > 0 && k - vanished.last > kMostApart)) judge();
    if (should_hit && scan.found_nothing(beam)) add(scan, k, vanished);
  }
  judge();
}

void FreeClaims::add(const LaserScan& scan, std::size_t beam, Vanished& vanished) const noexcept {
  const Surface& surface = expected_[at(beam)];
  if (vanished.beams++ == 0) vanished.first = beam;
  vanished.last = beam;
  vanished.width_m += norm(surface.in_laser) * std::fabs(step_rad_);
  vanished.seen_s += to_seconds(scan.stamp - surface.seen);
}

bool FreeClaims::has_failed(const LaserScan& scan, const Vanished& vanished) const noexcept {
  if (vanished.beams < kLeastVanished) return false;
  const auto beams = static_cast<double>(vanished.beams);
  if (vanished.width_m > kEdges_m + kWalk_mps * vanished.seen_s / beams) return true;
  return beams * std::fabs(step_rad_) >= kWide_rad && !moves_beside(scan, vanished);
}

bool FreeClaims::moves_beside(const LaserScan& scan, const Vanished& vanished) const noexcept {
  const Vec2 first = expected_[at(vanished.first)].in_laser, last = expected_[at(vanished.last)].in_laser;
  for (std::size_t beam = 0; beam < beams_; ++beam) {
    if (!scan.is_hit(beam)) continue;
    const auto range_m = static_cast<double>(scan.range_m[beam]);
    const Vec2 hit = direction(scan.angle_rad(beam)) * range_m;
    if (!(std::min(distance(hit, first), distance(hit, last)) < kBeside_m)) continue;
    double moved_m = std::numeric_limits<double>::infinity();  // from what is expected of it and of the two beside it
    for (const std::size_t near : {beam, at(beam + 1), at(beam + beams_ - 1)})
      if (expected_[near].seen != kNever)
        moved_m = std::min(moved_m, std::fabs(range_m - norm(expected_[near].in_laser)));
    if (moved_m > kMoved_m) return true;
  }
  return false;
}

/// Free beams between and beside the vanished, as far again, are doubted with them.
void FreeClaims::doubt(const LaserScan& scan, const Vanished& vanished) noexcept {
  const auto join = [&](std::size_t beam) {
    if (expected_[beam].seen != kNever)
      doubt_[beam] = Doubt::kVanished;
    else if (doubt_[beam] == Doubt::kNone)
      doubt_[beam] = Doubt::kBeside;
  };
  const std::size_t wide = vanished.last - vanished.first + 1;
  for (std::size_t k = vanished.first; k <= vanished.last; ++k) join(at(k));
  for (const std::size_t step : {std::size_t{1}, beams_ - 1}) {  // to the next beam, to the one before
    std::size_t beam = at(step == 1 ? vanished.last : vanished.first);
    for (std::size_t gone = 0; gone < wide; ++gone) {
      if (!all_round_ && beam == (step == 1 ? beams_ - 1 : 0)) break;
      beam = at(beam + step);
      if (!scan.found_nothing(beam)) break;
      join(beam);
    }
  }
}

/// A beam that was doubted with others is believed again when none of those beside it is doubted for itself.
void FreeClaims::believe_hits(const LaserScan& scan) noexcept {
  for (std::size_t k = 0; k < beams_; ++k) {
    if (doubt_[k] == Doubt::kNone) continue;
    if (scan.is_hit(k))
      doubt_[k] = doubt_[k] == Doubt::kVanished ? Doubt::kHitOnce : Doubt::kNone;
    else if (doubt_[k] == Doubt::kHitOnce && scan.found_nothing(k))
      doubt_[k] = Doubt::kVanished;
  }
  for (std::size_t k = 0; k < beams_;) {
    std::size_t end = k;
    bool only_beside = true;
    for (; end < beams_ && doubt_[end] != Doubt::kNone; ++end)
      only_beside = only_beside && doubt_[end] == Doubt::kBeside;
    if (only_beside)
      std::fill(doubt_.begin() + static_cast<std::ptrdiff_t>(k), doubt_.begin() + static_cast<std::ptrdiff_t>(end),
                Doubt::kNone);
    k = end + 1;
  }
}

void FreeClaims::remember(const LaserScan& scan) noexcept {
  for (std::size_t k = 0; k < beams_; ++k) {
    if (scan.is_hit(k))
      surface_[k] = {direction(scan.angle_rad(k)) * static_cast<double>(scan.range_m[k]), scan.stamp};
    else if (doubt_[k] != Doubt::kNone || !scan.found_nothing(k))
      surface_[k] = expected_[k];
    else
      surface_[k] = {};
  }
}

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
    : laser_(model.lasers()[scanner]),
      track_width_m_(model.drive.track_width_m),
      has_wheels_(has_wheels),
      travel_(model.drive) {}

void BeamFilter::filter(LaserScan& scan, const WheelState& wheels) noexcept {
  blank(laser_.blanked, scan);
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
  const std::optional<Rolled> before = std::exchange(rolled_, travel_.expected_at(stamp));
  const Pose2 moved = before && rolled_ ? arc_of(*rolled_ - *before, track_width_m_) : Pose2{};
  return inverse(inverse(laser_.robot_from_laser) * moved * laser_.robot_from_laser);
}

}  // namespace jaywalk
