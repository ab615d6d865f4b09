// The same bits in any visiting order: serial against random, stage by stage and as whole plans.
#include <memory>

#include "planner/paper/paper_planner.h"
#include "tests/planner/field_rig.h"
#include "tests/planner/same_bytes.h"
#include "tests/planner/shuffled_executor.h"
#include "tests/support/catch.h"

using namespace jaywalk;
using namespace jaywalk::test;

namespace {

/// FNV-1a.
struct Digest {
  std::uint64_t value = 14695981039346656037ULL;
  void add(const void* bytes, std::size_t n) {
    const auto* byte = static_cast<const unsigned char*>(bytes);
    for (std::size_t k = 0; k < n; ++k) value = (value ^ byte[k]) * 1099511628211ULL;
  }
};

TestMap small_map(std::uint64_t seed) {
  TestMap map("small", 64);
  Random random(seed);
  for (int k = 0; k < 12; ++k) {
    const std::int32_t i = random.below(60), j = random.below(60);
    const std::int32_t w = 2 + random.below(8), h = 2 + random.below(8);
    map.box(i, j, i + w, j + h);
  }
  map.box(4, 4, 12, 12, 0), map.box(50, 50, 60, 60, 0);
  return map;
}

}  // namespace

TEST_CASE("clearance, start field, potential and index matrix do not depend on the visiting order") {
  FieldRig<> serial(64);
  FieldRig<ShuffledExecutor> shuffled(64);
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const std::int32_t n = serial.grid.cells();
    serial.load(small_map(seed), 1.0F, serial.grid.at(55, 55));
    shuffled.load(small_map(seed), 1.0F, serial.grid.at(55, 55));
    CHECK(same(serial.arrays().clearance, shuffled.arrays().clearance, n));
    CHECK(same(serial.arrays().start_psi, shuffled.arrays().start_psi, n));
    for (int tick = 0; tick < 2; ++tick) {
      const paper::From from = tick > 0 ? paper::From::kLast : paper::From::kNothing;
      const paper::FieldQuality quality = serial.solve(from);
      CHECK(shuffled.solve(from).pits == quality.pits);
      CHECK(quality.joined > 500);
      CHECK(same(serial.psi(), shuffled.psi(), n));
      CHECK(same(serial.arrays().index, shuffled.arrays().index, n));
    }
  }
}

TEST_CASE("whole plans and marks do not depend on the visiting order") {
  paper::PaperPlanner<paper::SerialExecutor> serial(small_window(), std::make_unique<paper::SerialExecutor>());
  paper::PaperPlanner<ShuffledExecutor> shuffled(small_window(), std::make_unique<ShuffledExecutor>());
  check_crowd(serial, shuffled, small_map(3), 8, [&] {
    CHECK(same(serial.arrays().marks, shuffled.arrays().marks, 6));
    CHECK(same(serial.arrays().occupants, shuffled.arrays().occupants, 64 * 64));
  });
}

TEST_CASE("a plan has the same bytes with every compiler, optimisation level and processor") {
  // The digest is what g++ 12, g++ 11 (-O3 for x86-64-v3 without fused instructions), clang 14 and aarch64 give; it
  // changes with the algorithm.
  const EvidenceMap map = evidence_of(small_map(3));
  const std::vector<Track> tracks = crowd();
  PlanRequest request = across(map);
  request.moving = tracks;
  const auto planner = paper::make_cpu_paper_planner(small_window());
  Digest digest;
  for (int tick = 0; tick < 4; ++tick) {
    planner->submit(request);
    const Plan& plan = planner->collect();
    REQUIRE(plan.status == PlanStatus::kOk);
    digest.add(plan.path.data(), plan.path.size() * sizeof(Vec2));
    digest.add(planner->view_field().psi.data(), planner->view_field().psi.size_bytes());
  }
  CHECK(digest.value == 0x59909ef49a4f6885ULL);
}

TEST_CASE("the comparison can fail: sweeping in place depends on the order") {
  struct InPlace {
    std::int32_t side;
    float* x;
    void operator()(std::int32_t c) const {
      if (c > 0 && c < side - 1) x[c] = 0.5F * (x[c - 1] + x[c + 1]);
    }
  };
  paper::SerialExecutor serial;
  ShuffledExecutor shuffled;
  float* a = serial.take<float>(64);
  float* b = shuffled.take<float>(64);
  a[0] = b[0] = 1.0F;
  serial.for_each_cell(64, 1, InPlace{64, a});
  shuffled.for_each_cell(64, 1, InPlace{64, b});
  CHECK_FALSE(same(a, b, 64));
}
