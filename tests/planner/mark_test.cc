#include <vector>

#include "planner/paper/executor.h"
#include "planner/paper/mark_stages.h"
#include "tests/support/catch.h"

using namespace jaywalk;
using namespace jaywalk::paper;

namespace {

struct MarkRig {
  Grid grid{64};
  SerialExecutor executor;
  std::vector<std::uint8_t> occupants = std::vector<std::uint8_t>(64 * 64);
  Mark mark{};

  /// The robot stands in cell (10, 32) and looks along x.
  void run(const Mover& mover) {
    const Warping warping{10.5F, 32.5F, 1.0F, 0.0F, 5.0F, 2.0F, 4.0F, 0.0F};
    executor.for_each_cell(1, 1, PredictEachMover{grid, warping, &mover, &mark});
    executor.for_each_cell(64, 64, MarkEachCell{grid, &mark, 1, occupants.data()});
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

TEST_CASE("a mover is marked where the warp puts it, and not where it is") {
  // 38 cells ahead (centre of cell 48), coming at 5 cells/s: r = 38/1.9 = 20 cells, 4 s, so at x = 28.5.
  MarkRig rig;
  rig.run(mover_at(48.5F, 32.5F, -5.0F, 0.0F, 5.0F));
  CHECK(rig.mark.horizon_s == Approx(4.0F));
  CHECK(rig.mark.x == Approx(28.5F));
  CHECK(rig.mark.radius == Approx(5.0F));  // 3 of body, 2 of safety
  CHECK(rig.marked(28, 32));
  CHECK(rig.marked(33, 32));
  CHECK_FALSE(rig.marked(34, 32));
  CHECK_FALSE(rig.marked(48, 32));
}

TEST_CASE("movers outside the grid mark what reaches in and nothing else") {
  MarkRig rig;
  rig.run(mover_at(-20.0F, -20.0F, 0.0F, 0.0F, 0.0F));
  CHECK(rig.occupants == std::vector<std::uint8_t>(64 * 64));
}
