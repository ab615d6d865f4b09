#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/planner/field_rig.h"
#include "tests/support/catch.h"

using namespace jaywalk;
using namespace jaywalk::test;

namespace {

/// Squared distance (cells) to the nearest wall, by looking at every cell.
std::int32_t squared_by_looking(const TestMap& map, std::int32_t c) {
  std::int32_t best = 1 << 28;
  for (std::int32_t w = 0; w < map.side * map.side; ++w) {
    const std::int32_t dx = c % map.side - w % map.side, dy = c / map.side - w / map.side;
    if (map.wall[static_cast<std::size_t>(w)] != 0) best = std::min(best, dx * dx + dy * dy);
  }
  return best;
}

}  // namespace

TEST_CASE("clearance is the exact Euclidean distance less the inflation, on random maps") {
  for (const int per_mille : {0, 1, 10, 200}) {
    Random random(static_cast<std::uint64_t>(per_mille) + 7);
    TestMap map("random", 64);
    for (auto& cell : map.wall) cell = random.below(1000) < per_mille ? 1 : 0;
    FieldRig<> rig(64);
    rig.load(map, 2.5F, 0);
    int wrong = 0;
    for (std::int32_t c = 0; c < 64 * 64; ++c) {
      const std::int32_t i = c % 64, j = c / 64;
      const double d2 = squared_by_looking(map, c);
      const double border = std::min({i, j, 63 - i, 63 - j}) + 1;
      const double expected = d2 <= 6.25 ? 0.0 : std::max(1.0, std::min(border, std::sqrt(d2) - 2.5));
      if (std::fabs(static_cast<double>(rig.arrays().clearance[c]) - expected) > 1e-4) ++wrong;
    }
    CHECK(wrong == 0);
  }
}
