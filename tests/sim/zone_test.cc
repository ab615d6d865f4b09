#include "hal/sim/free_grid.h"
#include "tests/support/catch.h"

using namespace jaywalk;
using namespace jaywalk::sim;

namespace {

const Zone kZone{{1.0, 2.0}, {1.0, 0.0}, 1.0};  // apex (1, 2), looks along x, 1 m

}  // namespace

TEST_CASE("a wall is in the zone ahead up to its reach, and alongside nearer than the reach over root 2") {
  struct Row {
    const char* name;
    WallSegment wall;
    bool is_in;
  };
  const Row rows[] = {{"across the way, within reach", {{1.99, 0.0}, {1.99, 4.0}}, true},
                      {"across the way, beyond it", {{2.01, 0.0}, {2.01, 4.0}}, false},
                      {"alongside: 0.707 m is the zone's half width", {{0.0, 2.70}, {5.0, 2.70}}, true},
                      {"alongside, farther off", {{0.0, 2.72}, {5.0, 2.72}}, false},
                      {"ends before the zone begins, which is at 1.1", {{0.0, 2.1}, {1.05, 2.1}}, false},
                      {"ends behind where it begins", {{0.0, 2.1}, {1.15, 2.1}}, true},
                      {"behind", {{0.9, 0.0}, {0.9, 4.0}}, false},
                      {"small and inside", {{1.5, 2.0}, {1.5, 2.01}}, true},
                      {"all across it", {{1.5, -50.0}, {1.5, 50.0}}, true}};
  for (const Row& row : rows) {
    CAPTURE(row.name);
    CHECK(kZone.meets(row.wall) == row.is_in);
  }
}

TEST_CASE("a disc counts from its edge: ahead, and at the zone's border, not behind") {
  CHECK(kZone.meets(Disc{{2.2, 2.0}, 0.21}));
  CHECK_FALSE(kZone.meets(Disc{{2.2, 2.0}, 0.19}));
  CHECK(kZone.meets(Disc{{1.0, 2.5}, 0.36}));  // 0.5 / root 2 = 0.354 from the border
  CHECK_FALSE(kZone.meets(Disc{{1.0, 2.5}, 0.35}));
  CHECK_FALSE(kZone.meets(Disc{{0.5, 2.0}, 0.4}));
}

TEST_CASE("the robot counts from its footprint, turned as it stands") {
  const Footprint longish{.front_m = 1.0, .rear_m = 0.2, .half_width_m = 0.2};
  CHECK((RobotBody{longish, {2.9, 2.0, kPi}}).in(kZone));  // its front reaches x = 1.9
  CHECK_FALSE((RobotBody{longish, {2.9, 2.0, 0.0}}).in(kZone));
  CHECK_FALSE((RobotBody{longish, {3.1, 2.0, kPi}}).in(kZone));
}

TEST_CASE("the gap between robot and disc is from edge to edge") {
  const RobotBody robot{{.front_m = 0.3, .rear_m = 0.2, .half_width_m = 0.1}, {1.0, 1.0, kPi / 2}};
  CHECK(robot.gap({{1.0, 2.0}, 0.25}) == Approx(1.0 - 0.3 - 0.25));
  CHECK(robot.gap({{2.0, 1.0}, 0.25}) == Approx(1.0 - 0.1 - 0.25));
  CHECK(robot.gap({{1.0, 1.4}, 0.25}) == 0.0);
}
