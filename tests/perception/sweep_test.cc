// A scanner that turns meets a body later than its scan's stamp, by up to a sweep, and at the beginning of its turn
// twice or not at all.
#include <algorithm>

#include "planner/tracking/tracker.h"
#include "tests/perception/watch.h"
#include "tests/support/catch.h"

using namespace jaywalk;
using namespace jaywalk::test;

namespace {

constexpr double kTurnS = 0.1;
constexpr std::uint32_t kBeams = 720;
constexpr double kRadiusM = 0.25;
constexpr Vec2 kNowhere{50.0, 50.0};

/// Where somebody is, and goes.
struct Walk {
  Vec2 from, velocity;
  [[nodiscard]] Vec2 at(double t_s) const { return from + velocity * t_s; }
};

/// From behind the robot on, counter-clockwise or clockwise.
Fan turn(double way) { return {.beams = kBeams, .first_rad = -way * kPi, .step_rad = way * 2.0 * kPi / kBeams}; }

double stamp_s(std::uint32_t k) { return (k - 1) * kTurnS; }

/// Scan `k`, from 1, of a laser that stands in the middle of the room: each beam at its own time.
LaserScan turned_scan(const Walk& walk, std::uint32_t k, const Fan& fan) {
  LaserScan scan = scan_of({}, {}, k, 0.0, fan);
  for (std::uint32_t b = 0; b < kBeams; ++b) {
    const Room room = with({{walk.at(stamp_s(k) + kTurnS * b / kBeams), kRadiusM}});
    const Fan beam{.beams = 1, .first_rad = scan.angle_rad(b), .step_rad = fan.step_rad};
    scan.range_m[b] = scan_of(room, {}, k * kBeams + b, kNoiseM, beam).range_m[0];
  }
  scan.stamp = time_from_seconds(stamp_s(k));
  scan.sweep = duration_from_seconds(kTurnS * (kBeams - 1) / kBeams);
  return scan;
}

struct Errors {
  std::size_t scans = 0;
  double mean_m = 0.0, worst_m = 0.0;
};

/// Of the only mover, from a second and a half after he came into the room, which was empty for two seconds before.
Errors errors_of(const Walk& walk, const Fan& fan) {
  Watch watch;
  std::uint32_t k = 0;
  while (k < 20) watch.tracker.update(turned_scan({kNowhere, {}}, ++k, fan), {});
  const Walk later{walk.at(-stamp_s(21)), walk.velocity};
  Errors errors;
  while (k < 60) {
    watch.tracker.update(turned_scan(later, ++k, fan), {});
    if (k <= 35) continue;
    const double off_m = distance(only_mover(watch.tracker).position_in_map, later.at(stamp_s(k)));
    errors.worst_m = std::max(errors.worst_m, off_m);
    errors.mean_m = (errors.mean_m * static_cast<double>(errors.scans) + off_m) / static_cast<double>(errors.scans + 1);
    ++errors.scans;
  }
  return errors;
}

/// Who stands before the robot after three seconds of it, by scans that say, or do not, how long they took.
Track stander_seen(bool with_sweep) {
  Watch watch;
  for (std::uint32_t k = 1; k <= 50; ++k) {
    LaserScan scan = turned_scan({k <= 20 ? kNowhere : Vec2{2.5, 1.0}, {}}, k, turn(1.0));
    if (!with_sweep) scan.sweep = Duration{0};
    watch.tracker.update(scan, {});
  }
  REQUIRE(watch.tracker.tracks().size() == 1);
  return watch.tracker.tracks()[0];
}

}  // namespace

TEST_CASE("who walks is where he was at the stamp of the scan, wherever and however a scanner turns") {
  // 1.2 m/s are 12 cm a turn. Past the front, the left, and behind both ways, where the turn begins: 0.044 to 0.09 m
  // off on average, and 0.08 to 0.18 m at worst, if he is taken to be there when he was seen.
  for (const Walk& walk : {Walk{{2.5, -2.4}, {0.0, 1.2}}, Walk{{-2.4, 2.5}, {1.2, 0.0}}, Walk{{-2.5, 2.4}, {0.0, -1.2}},
                           Walk{{-2.5, -2.4}, {0.0, 1.2}}, Walk{{-0.8, 0.02}, {-1.2, 0.0}},
                           Walk{{-5.4, 0.02}, {1.2, 0.0}}, Walk{{-4.4, 1.2}, {0.9, -0.7}}}) {
    for (const double way : {1.0, -1.0}) {
      const Errors errors = errors_of(walk, turn(way));
      INFO("from " << walk.from.x << ", " << walk.from.y << ", turning " << way);
      CHECK(errors.scans == 25);
      CHECK(errors.mean_m < 0.015);
      CHECK(errors.worst_m < 0.045);  // half of him is seen where the turn begins, half a turn later
    }
  }
}

TEST_CASE("who stands is where he is, however long a scanner takes to turn") {
  const Track turning = stander_seen(true), at_once = stander_seen(false);
  CHECK(turning.position_in_map == at_once.position_in_map);
  CHECK(turning.velocity_in_map == at_once.velocity_in_map);
}
