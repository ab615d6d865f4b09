#include <vector>

#include "planner/field/executor.h"
#include "planner/field/mark_stages.h"
#include "tests/support/catch.h"

using namespace jaywalk;
using namespace jaywalk::field;

namespace {

struct MarkRig {
  Grid grid{64};
  SerialExecutor executor;
  std::vector<float> warp = std::vector<float>(64 * 64);
  std::vector<std::uint8_t> occupants = std::vector<std::uint8_t>(64 * 64);
  Mark mark{};
  float reach = 1e9F;

  /// The robot stands in cell (10, 32) and looks along x at 6 cells a second.
  void run(bool ellipses, const Mover& mover) {
    const Warping warping{ellipses, 10.5F, 32.5F, 1.0F, 0.0F, 6.0F, 5.0F, 2.0F, 4.0F, 0.0F, reach};
    executor.for_each_cell(64, 64, WarpOfEachCell{grid, warping, warp.data()});
    executor.for_each(1, PredictEachMover{grid, warping, warp.data(), &mover, &mark});
    executor.for_each_cell(4, 64, MarkRow{grid, 16, warping, warp.data(), &mover, &mark, 1, occupants.data()});
  }
  [[nodiscard]] bool marked(std::int32_t i, std::int32_t j) const {
    return (occupants[static_cast<std::size_t>(grid.at(i, j))] & kMover) != 0;
  }
};

/// At (x, y), no uncertainty, 3 cells of radius.
Mover mover_at(float x, float y, float vx, float vy, float speed) {
  return {{x, vx, 0.0F, 0.0F, 0.0F}, {y, vy, 0.0F, 0.0F, 0.0F}, 3.0F, speed};
}

}  // namespace

TEST_CASE("mode paper marks where the warp puts a mover, and not where it is") {
  // 38 cells ahead (centre of cell 48), coming at 5 cells/s: r = 38/1.9 = 20 cells, 4 s, so at x = 28.5.
  MarkRig rig;
  rig.run(true, mover_at(48.5F, 32.5F, -5.0F, 0.0F, 5.0F));
  CHECK(rig.mark.horizon_s == Approx(4.0F));
  CHECK(rig.mark.x == Approx(28.5F));
  CHECK(rig.mark.radius == Approx(5.0F));  // 3 of body, 2 of safety
  CHECK(rig.marked(28, 32));
  CHECK(rig.marked(33, 32));
  CHECK_FALSE(rig.marked(34, 32));
  CHECK_FALSE(rig.marked(48, 32));
}

TEST_CASE("mode full marks the body now, and each cell where the mover will be when the robot comes") {
  // Head-on, robot 6 cells/s, mover 5 cells/s from 33 cells ahead: they meet 18 cells on, at x = 28.5, after 3 s.
  MarkRig rig;
  rig.run(false, mover_at(43.5F, 32.5F, -5.0F, 0.0F, 5.0F));
  CHECK(rig.marked(28, 32));
  CHECK(rig.marked(43, 32));        // its body now, radius 3
  CHECK_FALSE(rig.marked(47, 32));  // the safety distance belongs to the prediction
  // Cell 36, 26 cells on: the robot arrives after 4.33 s, the mover is at 21.8 then: free.
  CHECK_FALSE(rig.marked(36, 32));
}

TEST_CASE("mode full leaves free the way behind one that crosses") {
  // Crossing 12 cells ahead from 12 below at 6 cells/s upwards: it is at (22.5, 32.5) when the robot is, after 2 s;
  // 20 cells below that it never is again.
  MarkRig rig;
  rig.run(false, mover_at(22.5F, 20.5F, 0.0F, 6.0F, 6.0F));
  CHECK(rig.marked(22, 32));
  CHECK(rig.marked(22, 20));        // now
  CHECK_FALSE(rig.marked(22, 26));  // there after 1 s, the robot after 2.2 s
  CHECK_FALSE(rig.marked(22, 12));
}

TEST_CASE("beyond the reach movers occupy nothing") {
  MarkRig rig;
  rig.reach = 20.0F;
  rig.run(false, mover_at(30.5F, 32.5F, 0.0F, 0.0F, 0.0F));  // 20 cells away
  CHECK(rig.marked(29, 32));
  CHECK(rig.marked(30, 32));
  CHECK_FALSE(rig.marked(31, 32));
}

TEST_CASE("movers outside the grid mark what reaches in and nothing else") {
  MarkRig rig;
  rig.run(true, mover_at(-20.0F, -20.0F, 0.0F, 0.0F, 0.0F));
  int count = 0;
  for (const std::uint8_t o : rig.occupants) count += o;
  CHECK(count == 0);
}
