// How often blocks meet in a solve, counted on the emulated device: what docs/explanation/results.md#time has.
#include <cstdio>

#include "tests/cuda/cuda_rig.h"
#include "tests/planner/test_maps.h"

using namespace jaywalk;
using namespace jaywalk::test;
using emulated::Counts;
using emulated::device;

namespace {

/// Of the launches since `before`; prints them.
std::int64_t crew_barriers_since(const Counts& before, const char* what) {
  const Counts now = device().counts();
  const auto since = [](std::int64_t a, std::int64_t b) { return static_cast<long long>(b - a); };
  const long long crew = since(before.grid + before.cluster, now.grid + now.cluster);
  std::printf("  %s: %lld launches, %lld barriers of all blocks, %lld of a block\n", what,
              since(before.launches, now.launches), crew, since(before.block, now.block));
  return crew;
}

}  // namespace

TEST_CASE("emulated at length: barriers of a cold and a warm solve of 256 cells a side", "[.large]") {
  for (const Kind kind : {Kind::kLargeClusters, Kind::kGrid}) {
    for (const TestMap& map : {open_room(), office(), serpentine(15), serpentine(10), clutter(31)}) {
      std::printf("%s, %s\n", map.name.c_str(), kind == Kind::kGrid ? "grid" : "cluster");
      device().power_on(properties_of(kind, 3));
      const auto field = cuda_field({map.side, map.side, map.wall});
      field->inflate(3.0F);
      CellIndex goal{243, 243};
      REQUIRE(field->nearest_free(goal, 10));
      Counts before = device().counts();
      CHECK(field->solve_cold(goal).certified);
      CHECK(crew_barriers_since(before, "cold") <= 60);
      before = device().counts();
      CHECK(field->solve_warm(goal).certified);
      CHECK(crew_barriers_since(before, "warm") <= 16);
    }
  }
}
