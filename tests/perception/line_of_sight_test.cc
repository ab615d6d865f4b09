#include "planner/scan/line_of_sight.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "tests/perception/room.h"
#include "tests/support/catch.h"

using namespace jaywalk;
using namespace jaywalk::test;

namespace {

Room with_post() {
  Room room = rectangle(12.0, 10.0);
  room.discs = {{{2.0, 0.0}, 0.1}};
  return room;
}

}  // namespace

TEST_CASE("a place is seen taken, passed over or not at all") {
  const LaserScan scan = scan_of(with_post(), {}, 1);
  const LineOfSight sight(scan, {}, {}, {});
  CHECK(sight.at({1.9, 0.0}, 0.05) == Sight::kThere);    // the near side of the post
  CHECK(sight.at({1.5, 0.0}, 0.05) == Sight::kThrough);  // before it
  CHECK(sight.at({2.5, 0.0}, 0.05) == Sight::kUnseen);   // behind it
  CHECK(sight.at({2.0, 2.0}, 0.05) == Sight::kThrough);
  CHECK(sight.at({-1.0, 0.0}, 0.05) == Sight::kUnseen);  // outside 270 degrees
}

TEST_CASE("beside the first beam of a scan all round lies the last") {
  Room room = rectangle(12.0, 10.0);
  room.discs = {{{2.0, -0.06}, 0.05}};  // from 0.3 to 3.2 degrees right of ahead
  const LaserScan scan = scan_of(room, {}, 1, 0.0, {.beams = 720, .first_rad = 0.0, .step_rad = kPi / 360.0});
  const LineOfSight sight(scan, {}, {}, {});
  CHECK(sight.at({1.95, 0.02}, 0.08) == Sight::kThere);              // 2.35 degrees of tolerance, to the left of ahead
  CHECK(sight.at({1.95, 0.02}, 0.08, {710, 1}) == Sight::kThrough);  // those that end on it are not asked
  CHECK(sight.at({3.0, 0.02}, 0.08) == Sight::kUnseen);              // half behind it
}

TEST_CASE("a place is passed over only where all beams near it go on") {
  const LaserScan scan = scan_of(with_post(), {}, 1);
  const LineOfSight sight(scan, {}, {}, {});
  // 2.5 m away and 0.2 m aside of the post's shadow, which is 0.126 m half wide there: half of 0.3 m of beams is
  // blocked.
  CHECK(sight.at({2.5, 0.25}, 0.05) == Sight::kThrough);
  CHECK(sight.at({2.5, 0.14}, 0.05) == Sight::kUnseen);
}

TEST_CASE("a place where beams find nothing in their reach is empty, one where they were not measured is unseen") {
  Room room;
  room.discs = {{{2.0, 0.0}, 0.1}};
  LaserScan scan = scan_of(room, {}, 1);  // reaches 20 m
  const LineOfSight sight(scan, {}, {}, {});
  CHECK(sight.at({2.0, 1.0}, 0.05) == Sight::kEmpty);
  CHECK(sight.at({0.0, 15.9}, 0.05) == Sight::kEmpty);
  CHECK(sight.at({0.0, 16.1}, 0.05) == Sight::kUnseen);  // what is dark is not seen from so far
  CHECK(sight.at({1.9, 0.0}, 0.05) == Sight::kThere);
  CHECK(sight.at({2.5, 0.14}, 0.05) == Sight::kUnseen);  // half behind the post
  for (const float none : {0.0F, std::numeric_limits<float>::quiet_NaN()}) {
    for (float& range : scan.range_m) range = range < 20.0F ? range : none;
    CHECK(sight.at({2.0, 1.0}, 0.05) == Sight::kUnseen);
  }
}

TEST_CASE("beams that are not asked say nothing") {
  const LaserScan scan = scan_of(with_post(), {}, 1);
  const LineOfSight sight(scan, {}, {}, {});
  // Beam 405 is straight ahead, a third of a degree from the next. The post is seen by those within 2.87 degrees of it,
  // 397 to 413; the place is 3.6 degrees aside, at beam 415.8, and three beams to either side of it are asked.
  CHECK(sight.at({1.9, 0.12}, 0.1) == Sight::kThere);
  CHECK(sight.at({1.9, 0.12}, 0.1, {397, 413}) == Sight::kThrough);
  CHECK(sight.at({1.9, 0.12}, 0.1, {0, 810}) == Sight::kUnseen);
}

TEST_CASE("what was not measured proves nothing") {
  LaserScan scan = scan_of(with_post(), {}, 1);
  for (float& r : scan.range_m) r = std::numeric_limits<float>::quiet_NaN();
  CHECK(LineOfSight(scan, {}, {}, {}).at({1.5, 0.0}, 0.05) == Sight::kUnseen);
  scan.angle_step_rad = 0.0F;
  CHECK(LineOfSight(scan, {}, {}, {}).at({1.5, 0.0}, 0.05) == Sight::kUnseen);
  scan.beam_count = 0;
  CHECK(LineOfSight(scan, {}, {}, {}).at({1.5, 0.0}, 0.05) == Sight::kUnseen);
}

TEST_CASE("a clockwise scanner sees the same places") {
  LaserScan scan = scan_of(with_post(), {}, 1);
  std::reverse(scan.range_m.begin(), scan.range_m.begin() + scan.beam_count);
  scan.first_angle_rad = -scan.first_angle_rad;
  scan.angle_step_rad = -scan.angle_step_rad;
  const LineOfSight sight(scan, {}, {}, {});
  CHECK(sight.at({1.9, 0.0}, 0.05) == Sight::kThere);
  CHECK(sight.at({0.0, 2.0}, 0.05) == Sight::kThrough);
}

TEST_CASE("a robot that turns during the sweep looks along the beam that was there then") {
  // The beam to the post is number 405 of 811, in the middle of a sweep of 0.1 s: at 2 rad/s the robot has turned 0.1
  // rad by then, and the beam that ends on the post is another, 0.1 rad back. Beam k looks along -3/4 pi + k step + 0.2
  // k/810.
  LaserScan scan = scan_of(rectangle(12.0, 10.0), {}, 1);
  scan.sweep = duration_from_seconds(0.1);
  const double per_beam = static_cast<double>(scan.angle_step_rad) + 0.2 / 810.0;
  for (std::uint32_t b = 0; b < scan.beam_count; ++b) {
    const double looks = static_cast<double>(scan.first_angle_rad) + per_beam * b;
    scan.range_m[b] = std::fabs(looks) < 0.05 ? 1.9F : 5.0F;
  }
  const LineOfSight turning(scan, {}, {}, {.v_mps = 0.0, .w_radps = 2.0}), standing(scan, {}, {}, {});
  CHECK(turning.at({1.9, 0.0}, 0.05) == Sight::kThere);
  CHECK(standing.at({1.9, 0.0}, 0.05) == Sight::kThrough);
}

TEST_CASE("an empty scan sees nothing, whatever ranges an earlier one left behind") {
  LaserScan scan = scan_of(with_post(), {}, 1);
  const Vec2 place = direction(scan.angle_rad(0) - 0.3 * static_cast<double>(scan.angle_step_rad));  // beam -0.3
  CHECK(LineOfSight(scan, {}, {}, {}).at(place, 0.05) == Sight::kThrough);
  scan.beam_count = 0;
  CHECK(LineOfSight(scan, {}, {}, {}).at(place, 0.05) == Sight::kUnseen);
}
