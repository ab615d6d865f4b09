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

/// What `make` makes on device 0.
template <class Make>
auto on_device(const Make& make) {
  std::string why_not;
  auto made = make(0, why_not);
  INFO(why_not);
  REQUIRE(made != nullptr);
  return made;
}

inline std::unique_ptr<paper::MapField> cuda_field(const paper::CellMap& map) {
  return on_device(
      [&map](int device, std::string& why_not) { return paper::make_cuda_map_field(map, device, why_not); });
}
inline std::unique_ptr<Planner> cuda_planner(const PlannerConfig& config) {
  return on_device([&](int device, std::string& why_not) { return make_cuda_planner(config, device, why_not); });
}
/// The paper's.
inline std::unique_ptr<Planner> cuda_paper_planner(const paper::PaperConfig& config) {
  return on_device(
      [&](int device, std::string& why_not) { return paper::make_cuda_paper_planner(config, device, why_not); });
}

}  // namespace jaywalk::test
