// The GPU gives the CPU's bytes. Runs where a device is.
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "planner/cost_to_go/planner.h"
#include "tests/planner/same_bytes.h"
#include "tests/planner/shaped_maps.h"
#include "tests/support/catch.h"

#if JAYWALK_HAS_CUDA
#include "cuda/paper/cuda_paper.h"
#endif

using namespace jaywalk;

namespace {

#if JAYWALK_HAS_CUDA
using paper::make_cuda_map_field;
using paper::make_cuda_paper_planner;
#else
std::unique_ptr<Planner> make_cuda_paper_planner(const paper::PaperConfig&, int, std::string& why_not) {
  return why_not = "cuda: not in this build", nullptr;
}
std::unique_ptr<paper::MapField> make_cuda_map_field(const paper::CellMap&, int, std::string& why_not) {
  return why_not = "cuda: not in this build", nullptr;
}
#endif

void say_skipped(const std::string& why_not) {
  std::printf("skipped: no CUDA device (%s)\n", why_not.c_str());
  CHECK(why_not.substr(0, 6) == "cuda: ");
}

}  // namespace

TEST_CASE("the paper's planner gives the CPU's bytes on a CUDA device, plan by plan") {
  paper::PaperConfig config;
  config.max_side_cells = 256;
  std::string why_not;
  const auto gpu = make_cuda_paper_planner(config, 0, why_not);
  if (!gpu) return say_skipped(why_not);
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
    std::string why_not;
    const auto gpu = make_cuda_map_field(map, 0, why_not);
    if (!gpu) return say_skipped(why_not);
    test::check_field(map, *gpu);
  }
}
