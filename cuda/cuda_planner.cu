#include <algorithm>
#include <cstring>

#include "cuda/cuda_executor.h"
#include "cuda/cuda_planner.h"
#include "planner/field/grid_planner.h"
#include "planner/field/map_field_on.h"

namespace jaywalk {
namespace {

constexpr std::chrono::seconds kLongestField{30};  ///< of a map of 4096 cells a side, on the slowest device
constexpr std::chrono::seconds kLongestTrial{2};

/// What `make` returns for a new executor; null with the reason where there is no device or it does not serve.
template <class Make>
auto on_device(std::string& why_not, std::chrono::milliseconds limit, const Make& make)
    -> decltype(make(std::unique_ptr<CudaExecutor>())) {
  int devices = 0;
  const cudaError_t found = cudaGetDeviceCount(&devices);
  if (found != cudaSuccess || devices == 0) {
    why_not = std::string("cuda: no device (") + cudaGetErrorString(found) + ")";
    return nullptr;
  }
  try {
    return make(std::make_unique<CudaExecutor>(limit));
  } catch (const std::exception& error) {
    why_not = std::string("cuda: the device does not serve (") + error.what() + ")";
    return nullptr;
  }
}

std::unique_ptr<field::MapField> make_field(field::CellMap map, std::string& why_not, std::chrono::milliseconds limit) {
  return on_device(why_not, limit, [&](std::unique_ptr<CudaExecutor> executor) {
    return std::make_unique<field::MapFieldOn<CudaExecutor>>(std::move(map), std::move(executor));
  });
}

/// Whether two fields of a map have the same bytes.
bool are_same(const field::CellMap& map, const field::MapField& a, const field::MapField& b) {
  for (std::int32_t j = 0; j < map.height; ++j) {
    for (std::int32_t i = 0; i < map.width; ++i) {
      const float x = a.psi(i, j), y = b.psi(i, j);
      if (std::memcmp(&x, &y, sizeof x) != 0) return false;
    }
  }
  return true;
}

/// Solves a room with a wall and a way round it, large enough for steps of all blocks, and compares with the CPU's.
bool passes_trial(std::string& why_not) {
  constexpr std::int32_t kSide = 128;
  constexpr CellIndex kGoal{20, 20};
  field::CellMap map{kSide, kSide, std::vector<std::uint8_t>(kSide * kSide, 0)};
  std::fill_n(map.wall.begin() + 60 * kSide, kSide - 20, std::uint8_t{1});
  const auto tried = make_field(map, why_not, kLongestTrial);
  if (!tried) return false;
  const auto expected = field::make_cpu_map_field(map);
  const bool solved = tried->solve_cold(kGoal).certified && tried->solve_warm(kGoal).certified;
  (void)expected->solve_cold(kGoal), (void)expected->solve_warm(kGoal);
  if (solved && are_same(map, *expected, *tried)) return true;
  why_not = solved ? "cuda: a trial field has other bits than the CPU's" : "cuda: a trial field could not be solved";
  return false;
}

}  // namespace

std::unique_ptr<Planner> make_cuda_planner(const PlannerConfig& config, std::string& why_not) {
  field::check(config);
  if (!passes_trial(why_not)) return nullptr;
  return on_device(why_not, kLongestKernel, [&](std::unique_ptr<CudaExecutor> executor) {
    return std::make_unique<field::GridPlanner<CudaExecutor>>(config, std::move(executor));
  });
}

std::unique_ptr<field::MapField> make_cuda_map_field(field::CellMap map, std::string& why_not) {
  return make_field(std::move(map), why_not, kLongestField);
}

bool has_cuda_left_behind() { return CudaExecutor::has_left_behind(); }

}  // namespace jaywalk
