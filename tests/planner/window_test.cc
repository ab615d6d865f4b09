#include "planner/mapping/window.h"

#include "planner/cost_to_go/planner.h"
#include "tests/support/catch.h"

using namespace jaywalk;
using namespace jaywalk::field;

namespace {
const Window kNowhere{{0, 0}, 256, 0.1};
}

TEST_CASE("start and goal 22.5 m apart fit 256 cells, 23 m do not") {
  // 225 cells and 15 on either side make 255; 230 make 260.
  CHECK(grid_side_for({1.5, 1.5}, {24.0, 24.0}, 0.1) == 256);
  CHECK(grid_side_for({0.0, 0.0}, {23.0, 0.0}, 0.1) == 512);
  CHECK(grid_side_for({0.0, 0.0}, {-47.0, 3.0}, 0.1) == 512);
  CHECK(grid_side_for({0.0, 0.0}, {0.0, 90.0}, 0.1) == 1024);
  CHECK(grid_side_for({0.0, 0.0}, {110.0, 0.0}, 0.1) == 512);  // none holds both: a far guide leads on
}

TEST_CASE("a window that fits lies round robot and goal, on whole blocks, and stays, wherever the robot goes in it") {
  Window w = placed(kNowhere, {101.5, 51.5}, {124.0, 74.0});
  CHECK(w.low.i % kWindowBlock == 0);
  CHECK(w.holds({101.5, 51.5}, 5));
  CHECK(w.holds({124.0, 74.0}, 5));
  const CellIndex low = w.low;
  for (double s = 0.0; s <= 1.0; s += 0.01) {
    w = placed(w, {101.5 + 22.5 * s, 51.5 + 22.5 * s}, {124.0, 74.0});
    CHECK(w.low == low);
  }
}

TEST_CASE("with a far goal the window rolls by blocks when the robot nears its border, and seldom") {
  Window w = placed(kNowhere, {0.0, 0.0}, {100.0, 0.0});
  int rolls = 0;
  for (double x = 0.0; x < 60.0; x += 0.02) {
    const Window next = placed(w, {x, 0.0}, {100.0, 0.0});
    if (!(next.low == w.low)) ++rolls;
    CHECK(next.low.i % kWindowBlock == 0);
    CHECK(next.holds({x, 0.0}, 25));
    w = next;
  }
  CHECK(rolls >= 2);
  CHECK(rolls <= 5);
}

TEST_CASE("a new goal that could be inside moves the window over it") {
  const Window w = placed(kNowhere, {0.0, 0.0}, {-20.0, 0.0});
  CHECK_FALSE(w.holds({20.0, 0.0}, 0));
  CHECK(placed(w, {0.0, 0.0}, {20.0, 0.0}).holds({20.0, 0.0}, 5));
}

TEST_CASE("doubling keeps the middle") {
  GrowingWindow window({{-128, 64}, 256, 0.1}, 512);
  for (int k = 0; k < kPatience; ++k) window.note_walled_off(true);
  CHECK(window.now().side == 512);
  CHECK(window.now().low == CellIndex{-256, -64});
}

TEST_CASE("a goal outside projects onto the border along its line from the robot") {
  // From (128, 128) towards (628, 378) in cells: x leaves at 255, after 127 of 500; y is then 128 + 0.254*250 = 191.5.
  const Window w{{0, 0}, 256, 0.1};
  CHECK(projected_goal(w, {12.8, 12.8}, {62.8, 37.8}) == CellIndex{255, 191});
  CHECK(projected_goal(w, {12.8, 12.8}, {3.05, 4.05}) == CellIndex{30, 40});
  CHECK(projected_goal(w, {12.8, 12.8}, {12.85, -400.0}).j == 0);
  CHECK(projected_goal(w, {12.8, 12.8}, {1e300, 1e300}) == CellIndex{255, 255});
}
