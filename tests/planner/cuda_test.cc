// The GPU gives the CPU's bytes. Runs where a device is.
#include <cstdio>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "planner/cost_to_go/planner.h"
#include "tests/planner/cuda_parity.h"
#include "tests/planner/shaped_maps.h"
#include "tests/support/catch.h"

#if JAYWALK_HAS_CUDA
#include "cuda/paper/cuda_paper.h"
#endif

using namespace jaywalk;

namespace {

#if JAYWALK_HAS_CUDA
/// What was made, or the line that says why not.
template <class Made>
Made or_skipped(Made made, const std::string& why_not) {
  if (!made) {
    std::printf("skipped: no CUDA device (%s)\n", why_not.c_str());
    CHECK(why_not.substr(0, 6) == "cuda: ");
  }
  return made;
}

std::unique_ptr<Planner> cuda_planner(const paper::PaperConfig& config) {
  std::string why_not;
  auto planner = paper::make_cuda_paper_planner(config, 0, why_not);
  return or_skipped(std::move(planner), why_not);
}
std::unique_ptr<paper::MapField> cuda_map_field(const paper::CellMap& map) {
  std::string why_not;
  auto field = paper::make_cuda_map_field(map, 0, why_not);
  return or_skipped(std::move(field), why_not);
}
#else
std::unique_ptr<Planner> cuda_planner(const paper::PaperConfig&) {
  std::printf("skipped: no CUDA device (not in this build)\n");
  return nullptr;
}
std::unique_ptr<paper::MapField> cuda_map_field(const paper::CellMap&) {
  std::printf("skipped: no CUDA device (not in this build)\n");
  return nullptr;
}
#endif

}  // namespace

TEST_CASE("the paper's planner gives the CPU's bytes on a CUDA device, plan by plan") {
  paper::PaperConfig config;
  config.max_side_cells = 256;
  const auto gpu = cuda_planner(config);
  if (!gpu) return;
  const auto cpu = paper::make_cpu_paper_planner(config);
  for (const test::TestMap& map : {test::open_room(), test::office(), test::serpentine(10), test::clutter(31)}) {
    test::check_run(*cpu, *gpu, map, 3);
  }
}

TEST_CASE("the CUDA field of a map of any shape, and of the largest, has the bytes of the CPU's") {
  std::vector<paper::CellMap> maps = test::shaped_maps();
  maps.push_back(test::large_map());
  maps.push_back(test::filled_map(paper::kMostMapCells, paper::kMostMapCells));
  for (const paper::CellMap& map : maps) {
    const auto gpu = cuda_map_field(map);
    if (!gpu) return;
    test::check_field(map, *gpu);
  }
}
