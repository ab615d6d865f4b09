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
auto on_device(int device, std::string& why_not, std::chrono::milliseconds limit, const Make& make)
    -> decltype(make(std::unique_ptr<CudaExecutor>())) {
  int devices = 0;
  const cudaError_t found = cudaGetDeviceCount(&devices);
  if (found != cudaSuccess || devices == 0) {
    why_not = std::string("cuda: no device (") + cudaGetErrorString(found) + ")";
    return nullptr;
  }
  if (device >= devices) {
    why_not = "cuda: no device " + std::to_string(device) + " (" + std::to_string(devices) + " there, numbered from 0)";
    return nullptr;
  }
  try {
    return make(std::make_unique<CudaExecutor>(device, limit));
  } catch (const std::exception& error) {
    why_not = std::string("cuda: the device does not serve (") + error.what() + ")";
    return nullptr;
  }
}

/// 12.8 m with a wall that leaves a way round: large enough for steps of all blocks, and for several tiles.
constexpr std::int32_t kTrialSide = 128;

EvidenceMap trial_room() {
  EvidenceMap room(kTrialSide, 0.1, {6.4, 6.4});
  for (std::int32_t i = 0; i < kTrialSide - 30; ++i) room.add({i, 60}, EvidenceMap::kMax);
  return room;
}

bool are_same(const Planner& one, const Plan& a, const Planner& other, const Plan& b) {
  const auto psi_a = one.view_field().psi, psi_b = other.view_field().psi;
  return a.path.size() == b.path.size() && psi_a.size() == psi_b.size() &&
         std::memcmp(a.path.data(), b.path.data(), a.path.size() * sizeof(Vec2)) == 0 &&
         std::memcmp(psi_a.data(), psi_b.data(), psi_a.size_bytes()) == 0;
}

/// Two plans, cold and warm, past a mover that walks between them.
bool plans_the_same(Planner& tried, Planner& expected, std::string& why_not) {
  const EvidenceMap room = trial_room();
  Track walker;
  walker.id = 1;
  walker.position_in_map = {6.0, 3.5}, walker.velocity_in_map = {0.0, 0.5};
  walker.radius_m = 0.27;
  PlanRequest request{.map_from_robot = {2.0, 2.0, 0.0},
                      .goal_in_map = {2.0, 10.5},
                      .speed_mps = 0.6,
                      .still = &room,
                      .moving = {&walker, 1}};
  for (int k = 0; k < 2; ++k, walker.position_in_map.y += 0.4) {
    tried.submit(request), expected.submit(request);
    const Plan &a = expected.collect(), &b = tried.collect();
    if (b.status != PlanStatus::kOk) why_not = std::string("cuda: a trial plan failed (") + tried.failure() + ")";
    if (b.status != PlanStatus::kOk) return false;
    if (!are_same(expected, a, tried, b)) return why_not = "cuda: a trial plan has other bits than the CPU's", false;
  }
  return true;
}

std::unique_ptr<Planner> make_planner_on(const PlannerConfig& config, int device, std::chrono::milliseconds limit,
                                         std::string& why_not) {
  field::check(config);
  return on_device(device, why_not, limit, [&](std::unique_ptr<CudaExecutor> executor) {
    executor->take_cost_to_go(config.max_side_cells);
    return std::make_unique<field::GridPlanner<CudaExecutor>>(config, std::move(executor));
  });
}

}  // namespace

bool passes_cuda_trial(int device, std::string& why_not) {
  PlannerConfig config;
  config.side_cells = config.max_side_cells = kTrialSide;
  const auto tried = make_planner_on(config, device, kLongestTrial, why_not);
  return tried && plans_the_same(*tried, *make_cpu_planner(config), why_not);
}

std::unique_ptr<Planner> make_cuda_planner(const PlannerConfig& config, int device, std::string& why_not,
                                           std::chrono::milliseconds limit) {
  return make_planner_on(config, device, limit, why_not);
}

std::unique_ptr<field::MapField> make_cuda_map_field(field::CellMap map, int device, std::string& why_not) {
  return on_device(device, why_not, kLongestField, [&](std::unique_ptr<CudaExecutor> executor) {
    return std::make_unique<field::MapFieldOn<CudaExecutor>>(std::move(map), std::move(executor));
  });
}

bool has_cuda_left_behind() { return CudaDevice::has_left_behind(); }

}  // namespace jaywalk
