#pragma once
// The project's planner and fields on an emulated device of each kind that they know.
#include <memory>
#include <string>

#include "cuda/emulated/device.h"
#include "cuda/paper/cuda_paper.h"
#include "tests/support/catch.h"

namespace jaywalk::test {

/// A device of its own memory or, every third seed, one that shares the host's.
inline emulated::Properties properties_of(std::uint64_t seed) {
  return {.not_ready = static_cast<int>(seed % 3), .seed = seed};
}

inline std::unique_ptr<paper::MapField> cuda_field(const paper::CellMap& map) {
  std::string why_not;
  auto field = paper::make_cuda_map_field(map, 0, why_not);
  INFO(why_not);
  REQUIRE(field != nullptr);
  return field;
}

inline std::unique_ptr<Planner> cuda_planner(const PlannerConfig& config) {
  std::string why_not;
  auto planner = make_cuda_planner(config, 0, why_not);
  INFO(why_not);
  REQUIRE(planner != nullptr);
  return planner;
}

/// The paper's.
inline std::unique_ptr<Planner> cuda_paper_planner(const paper::PaperConfig& config) {
  std::string why_not;
  auto planner = paper::make_cuda_paper_planner(config, 0, why_not);
  INFO(why_not);
  REQUIRE(planner != nullptr);
  return planner;
}

}  // namespace jaywalk::test
