// The CUDA sources, unmodified, on the emulated device: every field and plan has the CPU's bytes, in whatever order
// threads run. What of it takes minutes is part of tools/long_tests.
#include <cstdio>

#include "tests/cuda/cuda_rig.h"
#include "tests/planner/same_bytes.h"
#include "tests/planner/shaped_maps.h"

using namespace jaywalk;
using namespace jaywalk::test;
using emulated::device;

namespace {

/// Boxes in a room; both corners are free.
TestMap boxes(std::int32_t side, std::uint64_t seed) {
  TestMap map("boxes", side);
  Random random(seed);
  for (std::int32_t k = 0; k < side / 5; ++k) {
    const std::int32_t i = random.below(side - 4), j = random.below(side - 4);
    map.box(i, j, i + 2 + random.below(8), j + 2 + random.below(8));
  }
  map.box(4, 4, 16, 16, 0), map.box(side - 18, side - 18, side - 4, side - 4, 0);
  return map;
}

paper::CellMap cells_of(const TestMap& map) { return {map.side, map.side, map.wall}; }

/// Plans in a window of 6.4 m among six movers.
void check_movers(const emulated::Properties& properties, int ticks) {
  device().power_on(properties);
  const auto cpu = paper::make_cpu_paper_planner(small_window()), gpu = cuda_paper_planner(small_window());
  check_crowd(*cpu, *gpu, boxes(64, 3), ticks);
}

void check_shape(const paper::CellMap& map, std::uint64_t seed) {
  device().power_on(properties_of(seed));
  check_field(map, *cuda_field(map));
  CHECK_FALSE(device().is_stuck);
}

/// A field of 100 cells a side, or of 128.
void check_seed(std::uint64_t seed) { check_shape(cells_of(boxes(seed % 5 == 0 ? 128 : 100, seed)), seed); }

}  // namespace

TEST_CASE("emulated: fields of maps of every shape have the CPU's bytes") {
  std::uint64_t seed = 6;
  for (const paper::CellMap& map : shaped_maps()) check_shape(map, ++seed);
}

TEST_CASE("emulated: fields have the CPU's bytes in random orders") {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) check_seed(seed);
}

TEST_CASE("emulated: the paper's plans among movers have the CPU's bytes") {
  for (std::uint64_t seed = 1; seed <= 2; ++seed) check_movers(properties_of(seed), 2);
}

TEST_CASE("emulated: plans across 12.8 m have the CPU's bytes, in one memory and two that the host keeps out of") {
  for (std::uint64_t seed = 5; seed <= 6; ++seed) {
    emulated::Properties properties = properties_of(seed);
    properties.guarded = true;
    device().power_on(properties);
    const auto cpu = paper::make_cpu_paper_planner(window(128)), gpu = cuda_paper_planner(window(128));
    check_run(*cpu, *gpu, boxes(128, 2), 2);
  }
}

TEST_CASE("emulated: plans round a keep-out zone, and out of one, have the CPU's bytes") {
  device().power_on(properties_of(8));
  const MapZone zone{ZoneKind::kKeepOut, {{2.0, 1.0}, {4.0, 1.0}, {4.0, 4.5}, {2.0, 4.5}}, 0.0};
  paper::PaperConfig config = small_window();
  config.keep_out = std::make_shared<const KeepOutField>(std::span(&zone, 1));
  const auto cpu = paper::make_cpu_paper_planner(config), gpu = cuda_paper_planner(config);
  const EvidenceMap map = evidence_of({"room", 64});
  PlanRequest request = across(map);
  CHECK(check_plan(*cpu, *gpu, request));
  for (const Vec2 p : gpu->collect().path) CHECK(signed_distance(zone, p) > 0.0);
  request.map_from_robot = {3.0, 2.5, 0.6};
  CHECK(check_plan(*cpu, *gpu, request));
}

TEST_CASE("emulated: a goal that a mover stands on is approached as on the CPU: the host sees the mover's mark") {
  const EvidenceMap map = evidence_of({"room", 64});
  PlanRequest request = across(map);
  request.goal_in_map = {3.2, 3.2};
  Track track = crowd()[0];
  track.position_in_map = request.goal_in_map;
  track.velocity_in_map = {0.0, 0.0};
  track.radius_m = 0.8;  // farther from the goal than the 0.5 m that it may be moved where no mover is
  request.moving = {&track, 1};
  for (const std::uint64_t seed : {5U, 6U}) {  // two memories, one
    device().power_on(properties_of(seed));
    const auto cpu = paper::make_cpu_paper_planner(small_window()), gpu = cuda_paper_planner(small_window());
    CHECK(check_plan(*cpu, *gpu, request));
  }
}

TEST_CASE("emulated at length: fields in random orders from 20 seeds", "[.large]") {
  for (std::uint64_t seed = 6; seed <= 20; ++seed) check_seed(seed);
}

TEST_CASE("emulated at length: plans among movers in random orders from 20 seeds", "[.large]") {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) check_movers(properties_of(seed), 6);
}

TEST_CASE("emulated at length: fields and plans of 256 and 512 cells a side", "[.large]") {
  for (std::uint64_t seed = 11; seed <= 12; ++seed) {
    device().power_on(properties_of(seed));
    const auto cpu = paper::make_cpu_paper_planner(window(256)), gpu = cuda_paper_planner(window(256));
    for (const TestMap& map : {open_room(), office(), serpentine(10), clutter(31)}) check_run(*cpu, *gpu, map, 3);
    check_field(cells_of(boxes(512, 9)), *cuda_field(cells_of(boxes(512, 9))));
  }
  device().power_on(properties_of(13));
  const auto cpu = paper::make_cpu_paper_planner(window(512)), gpu = cuda_paper_planner(window(512));
  check_run(*cpu, *gpu, boxes(512, 4), 2);
}

TEST_CASE("emulated at length: the field of 1100 cells a side, whose blocks go down twice in a cycle", "[.large]") {
  check_shape(large_map(), 14);
}
