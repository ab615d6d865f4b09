#include "firmware/safety/free_claims.h"

#include <algorithm>
#include <cmath>
#include <limits>

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

/// Distance of a hit from the surface expected of its beam and of the two beside it, m; infinity without one.
double FreeClaims::moved_m(std::size_t beam, double range_m) const noexcept {
  double least_m = std::numeric_limits<double>::infinity();
  for (const std::size_t near : {beam, at(beam + 1), at(beam + beams_ - 1)})
    if (expected_[near].seen != kNever)
      least_m = std::min(least_m, std::fabs(range_m - norm(expected_[near].in_laser)));
  return least_m;
}

bool FreeClaims::moves_beside(const LaserScan& scan, const Vanished& vanished) const noexcept {
  const Vec2 first = expected_[at(vanished.first)].in_laser, last = expected_[at(vanished.last)].in_laser;
  for (std::size_t beam = 0; beam < beams_; ++beam) {
    if (!scan.is_hit(beam)) continue;
    const auto range_m = static_cast<double>(scan.range_m[beam]);
    const Vec2 hit = direction(scan.angle_rad(beam)) * range_m;
    if (std::min(distance(hit, first), distance(hit, last)) < kBeside_m && moved_m(beam, range_m) > kMoved_m)
      return true;
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

}  // namespace jaywalk
