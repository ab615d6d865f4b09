#pragma once
// The project's planner and fields on an emulated device of each kind that they know.
#include <memory>
#include <string>

#include "cuda/cuda_planner.h"
#include "cuda/emulated/device.h"
#include "tests/support/catch.h"

namespace jaywalk::test {

/// Of 9.0 with clusters of 16 or of 8 blocks; without clusters, so that grids meet, of one block or of three; of the
/// last one that shares the host's memory, too.
enum class Kind { kLargeClusters, kSmallClusters, kGrid, kOneBlock, kOneMemory };
inline constexpr Kind kKinds[] = {Kind::kLargeClusters, Kind::kSmallClusters, Kind::kGrid, Kind::kOneBlock,
                                  Kind::kOneMemory};

inline emulated::Properties properties_of(Kind kind, std::uint64_t seed) {
  emulated::Properties properties{.not_ready = static_cast<int>(seed % 3), .seed = seed};
  if (kind == Kind::kSmallClusters) properties.cluster_blocks = 8;
  if (kind == Kind::kGrid || kind == Kind::kOneMemory)
    properties.compute_capability = 87, properties.cluster_blocks = 0;
  properties.integrated = kind == Kind::kOneMemory;
  if (kind == Kind::kOneBlock) properties.cluster_blocks = 0, properties.processors = 1;
  return properties;
}

inline std::unique_ptr<field::MapField> cuda_field(const field::CellMap& map) {
  std::string why_not;
  auto field = make_cuda_map_field(map, 0, why_not);
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

}  // namespace jaywalk::test
