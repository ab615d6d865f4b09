#include "hal/map_zones_file.h"

#include "tests/sim/made_worlds.h"
#include "tests/support/catch.h"

using namespace jaywalk;
using namespace jaywalk::sim;

namespace {

std::string keep_out(const std::string& points) { return "[[zones]]\nkind = \"keep_out\"\npoints = " + points + "\n"; }

std::string message(const std::string& zones) { return refused(kMap + kRobot + zones); }

}  // namespace

TEST_CASE("zones are read as they stand in the file") {
  const Scenario s =
      parsed(kMap + kRobot + keep_out("[[1, 1], [2.5, 1], [2.5, 2]]") +
             "[[zones]]\nkind = \"speed\"\nspeed_mps = 0.2\npoints = [[3, 1], [4, 1], [4, 2], [3, 2]]\n");
  REQUIRE(s.zones.size() == 2);
  CHECK(s.zones[0].kind == ZoneKind::kKeepOut);
  CHECK(s.zones[0].corners == std::vector<Vec2>{{1, 1}, {2.5, 1}, {2.5, 2}});
  CHECK(s.zones[1].kind == ZoneKind::kSpeed);
  CHECK(s.zones[1].speed_mps == 0.2);
  CHECK(s.zones[1].corners.size() == 4);
}

TEST_CASE("what is no polygon is refused with its line and a remedy") {
  check_refused({{keep_out("[[1, 1], [2, 1]]"), "s.toml:8: zones.points has 2 points; write [[x, y], [x, y], ...]"},
                 {keep_out("[[1, 1], [2, 1], [nan, 2]]"), "zones.points holds what is no number"},
                 {keep_out("[[1, 1], [2, 1], [2, 2, 0]]"), "zones.points has 3 elements"},
                 {keep_out("[[1, 1], [2, 1], [2e6, 2]]"), "zones.points lies at 2e+06 m"},
                 {keep_out("[[1, 1], [2, 1], [3, 1]]"), "zones.points encloses no area"},
                 {keep_out("[[1, 1], [2, 2], [2, 1], [1, 2.5]]"),
                  "zones.points crosses itself: side 1 meets side 3; give the corners in order"},
                 {keep_out("3"), "zones.points is not an array"},
                 {"[[zones]]\nkind = \"lake\"\npoints = [[1, 1], [2, 1], [2, 2]]\n", "choose one of keep_out, speed"},
                 {"[[zones]]\nkind = \"speed\"\npoints = [[1, 1], [2, 1], [2, 2]]\n", "speed_mps is missing"},
                 {keep_out("[[1, 1], [2, 1], [2, 2]]\nspeed_mps = 1"), "zones.speed_mps is not a known key"}},
                message);
}

TEST_CASE("too many zones or corners, and zones of places far from each other, are refused") {
  std::string many, corners;
  for (int k = 0; k < 65; ++k) {
    many += keep_out("[[1, 1], [2, 1], [2, 2]]");
    corners += (k == 0 ? "[" : ", [") + std::to_string(k) + ", " + std::to_string(k * k) + "]";
  }
  CHECK(holds(message(many), "zones has 65 zones; draw at most 64"));
  CHECK(holds(message(keep_out("[" + corners + "]")), "zones.points has 65 points"));
  CHECK(holds(message(keep_out("[[1, 1], [2, 1], [2, 2]]") + keep_out("[[500, 1], [501, 1], [501, 2]]")),
              "s.toml:11: zones.points lies more than 400 m from another keep-out zone"));
}

TEST_CASE("a goal in a keep-out zone, or too near for the body, is refused, a start is not") {
  // The goal is (8, 8); a P3-DX has an inscribed circle of 0.19 m, and 0.05 m are kept.
  CHECK(holds(message(keep_out("[[7, 7], [9, 7], [9, 9], [7, 9]]")), "s.toml:5: the goal lies in a keep-out zone"));
  CHECK(
      holds(message(keep_out("[[8.2, 7], [9, 7], [9, 9], [8.2, 9]]")), "the goal lies in a keep-out zone or too near"));
  CHECK(message(keep_out("[[8.3, 7], [9, 7], [9, 9], [8.3, 9]]")).empty());
  CHECK(message(keep_out("[[4, 4], [6, 4], [6, 6], [4, 6]]")).empty());
}
