#include "apps/setup/clock_search.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "apps/setup/mount_search.h"
#include "hal/types/geometry.h"

namespace jaywalk {
namespace {

constexpr double kEnoughTurn_rad = 12.0, kLeast_rad = 3.0;
constexpr double kMost_s = 0.5, kTells_s = 0.1, kStep_s = 0.02;
constexpr double kAbout_s = 0.16;   // to each side of the least, for a parabola through it: it is flat by noise
constexpr double kApart_s = 0.25;   // of two headings that are compared
constexpr double kLikelier = 20.0;  // log of the likelihood ratio; chi-squared of one is 10.8 at 99.9 %, half of it 5.4

struct StampedHeading {
  double t_s = 0.0, rad = 0.0;  ///< the heading counts on over whole turns
};
using Headings = std::vector<StampedHeading>;

void append(Headings& headings, double t_s, double heading_rad) {
  const double turn = headings.empty() ? heading_rad : wrap_angle(heading_rad - headings.back().rad);
  headings.push_back({t_s, headings.empty() ? turn : headings.back().rad + turn});
}

Headings by_wheels(const sim::RecordedLog& log) {
  Headings wheels;
  for (const sim::OdometryPose& next : log.odometry) append(wheels, to_seconds(next.stamp), next.pose.heading);
  return wheels;
}

/// Those of the scans, without the wheels, until `wheels` have turned enough.
Headings by_scans(const sim::RecordedLog& log, const Headings& wheels) {
  sim::RecordedLog scans_alone = log;
  scans_alone.odometry.clear();
  Headings scans;
  std::size_t k = 1;
  double turned_rad = 0.0;
  live_through(scans_alone, [&](const LivedTick& tick) {
    for (; k < wheels.size() && wheels[k].t_s < to_seconds(tick.now); ++k)
      turned_rad += std::fabs(wheels[k].rad - wheels[k - 1].rad);
    const double t_s = to_seconds(tick.scan_stamp);
    if (scans.empty() || t_s > scans.back().t_s) append(scans, t_s, tick.map_from_robot_at_scan.heading);
    return turned_rad < kEnoughTurn_rad;
  });
  return turned_rad < kLeast_rad ? Headings{} : scans;
}

/// Between those before and after; the first and the last go on.
double heading_at(const Headings& headings, double t_s) {
  const auto after = std::upper_bound(headings.begin(), headings.end(), t_s,
                                      [](double t, const StampedHeading& h) { return t < h.t_s; });
  if (after == headings.begin()) return headings.front().rad;
  if (after == headings.end()) return headings.back().rad;
  const StampedHeading &a = *(after - 1), &b = *after;
  return a.rad + (b.rad - a.rad) * (t_s - a.t_s) / (b.t_s - a.t_s);
}

/// What the turns of both differ by, the wheels' read `ahead_s` later.
struct Difference {
  double sum_rad = 0.0;
  int turns = 0;
};

Difference difference(const Headings& scans, const Headings& wheels, double ahead_s) {
  Difference d;
  std::size_t from = 0;
  for (std::size_t k = 1; k < scans.size(); ++k) {
    const StampedHeading &a = scans[from], &b = scans[k];
    if (b.t_s - a.t_s < kApart_s) continue;
    const double turned = heading_at(wheels, b.t_s + ahead_s) - heading_at(wheels, a.t_s + ahead_s);
    d.sum_rad += std::fabs(b.rad - a.rad - turned);
    d.turns += 1;
    from = k;
  }
  return d;
}

}  // namespace

std::optional<double> found_clock_offset(const sim::RecordedLog& log) {
  const Headings wheels = by_wheels(log);
  if (wheels.size() < 2) return std::nullopt;
  const Headings scans = by_scans(log, wheels);
  if (scans.empty()) return std::nullopt;
  const auto at = [&](double ahead_s) { return difference(scans, wheels, ahead_s).sum_rad; };
  const Difference unshifted = difference(scans, wheels, 0.0);
  double best_s = 0.0, least_rad = unshifted.sum_rad;
  for (double ahead_s = -kMost_s; ahead_s <= kMost_s; ahead_s += kStep_s) {
    const double rad = at(ahead_s);
    if (rad < least_rad) best_s = ahead_s, least_rad = rad;
  }
  // Differences spread as Laplace's do, most of them small: their mean is the likeliest scale.
  const double likelier = unshifted.turns * (unshifted.sum_rad - least_rad) / least_rad;
  const double before = at(best_s - kAbout_s), after = at(best_s + kAbout_s);
  const double ahead_s = best_s + 0.5 * kAbout_s * (before - after) / (before - 2.0 * least_rad + after);
  const bool tells = std::fabs(ahead_s) > std::max(kTells_s, to_seconds(log.sweep)) && std::fabs(ahead_s) < kMost_s;
  return tells && likelier > kLikelier ? std::optional(ahead_s) : std::nullopt;
}

}  // namespace jaywalk
