// How often a field's solution launches, counted on the emulated device: what docs/explanation/results.md#time has.
#include <cstdio>

#include "tests/cuda/cuda_rig.h"
#include "tests/planner/test_maps.h"

using namespace jaywalk;
using namespace jaywalk::test;
using emulated::Counts;
using emulated::device;

namespace {

/// Since `before`; prints them.
std::int64_t launches_since(const Counts& before, const char* what) {
  const Counts now = device().counts;
  std::printf("  %s: %lld launches, %lld barriers of blocks\n", what,
              static_cast<long long>(now.launches - before.launches), static_cast<long long>(now.block - before.block));
  return now.launches - before.launches;
}

}  // namespace

TEST_CASE("emulated at length: launches of a cold and a warm solution of 256 cells a side", "[.large]") {
  for (const TestMap& map : {open_room(), office(), serpentine(15), serpentine(10), clutter(31)}) {
    std::printf("%s\n", map.name.c_str());
    device().power_on(properties_of(4));
    const auto field = cuda_field({map.side, map.side, map.wall});
    field->inflate(3.0F);
    CellIndex goal{243, 243};
    REQUIRE(field->nearest_free(goal, 10));
    Counts before = device().counts;
    CHECK(field->solve_cold(goal).certified);
    CHECK(launches_since(before, "cold") <= 500);
    before = device().counts;
    CHECK(field->solve_warm(goal).certified);
    CHECK(launches_since(before, "warm") <= 150);
  }
}
