#include <cstring>

#include "cuda/cuda_cost_to_go.h"
#include "cuda/cuda_device.h"
#include "cuda/cuda_planner.h"
#include "planner/cost_to_go/planner.h"
#include "planner/cost_to_go/time_to_go_planner.h"

namespace jaywalk {
namespace {

constexpr std::chrono::seconds kLongestTrial{2};
/// 12.8 m with a wall that leaves a way round: large enough for several tiles.
constexpr std::int32_t kTrialSide = 128;

EvidenceMap trial_room() {
  EvidenceMap room(kTrialSide, 0.1, {6.4, 6.4});
  for (std::int32_t i = 0; i < kTrialSide - 30; ++i) room.add({i, 60}, EvidenceMap::kMax);
  return room;
}

template <class Value>
bool are_same(const Value* a, const Value* b, std::size_t count) {
  return std::memcmp(a, b, count * sizeof(Value)) == 0;
}

bool are_same(const Plan& a, const Plan& b) {
  constexpr auto kCells = static_cast<std::size_t>(kTrialSide) * kTrialSide;
  constexpr auto kPoses = static_cast<std::size_t>(PoseLattice::kPoses);
  return a.guide.side == kTrialSide && b.guide.side == kTrialSide && a.poses.known && b.poses.known &&
         are_same(a.guide.to_go_s, b.guide.to_go_s, kCells) && are_same(a.poses.cost, b.poses.cost, kPoses) &&
         are_same(a.poses.rate, b.poses.rate, kPoses) && are_same(a.poses.room, b.poses.room, kPoses) &&
         are_same(a.poses.shift, b.poses.shift, kPoses);
}

/// Two plans, with times from cells and from poses, past a body that stands nearer in the second.
bool plans_the_same(Planner& tried, Planner& expected, std::string& why_not) {
  const EvidenceMap room = trial_room();
  MoverDisc body{{6.0, 3.5}, 0.27};
  StandingPedestrian pedestrian{body.centre_in_map, body.radius_m};
  PlanRequest request{.map_from_robot = {2.0, 2.0, 0.0},
                      .goal_in_map = {2.0, 10.5},
                      .speed_mps = 0.6,
                      .still = &room,
                      .standing = {&pedestrian, 1},
                      .masked = {&body, 1}};
  request.poses.is_asked = true;
  for (int k = 0; k < 2; ++k, body.centre_in_map.x -= 2.0, pedestrian.position_in_map = body.centre_in_map) {
    tried.submit(request), expected.submit(request);
    const Plan &a = expected.collect(), &b = tried.collect();
    if (b.status != PlanStatus::kOk) why_not = std::string("cuda: a trial plan failed (") + tried.failure() + ")";
    if (b.status != PlanStatus::kOk) return false;
    if (!are_same(a, b)) return why_not = "cuda: a trial plan has other bits than the CPU's", false;
  }
  return true;
}

}  // namespace

std::unique_ptr<Planner> make_cuda_planner(const PlannerConfig& config, int device, std::string& why_not,
                                           std::chrono::milliseconds limit) {
  field::check(config);
  return on_device(device, why_not, [&] {
    return std::make_unique<field::TimeToGoPlanner>(
        config, std::make_unique<CudaCostToGo>(device, limit, config.max_side_cells));
  });
}

bool passes_cuda_trial(int device, std::string& why_not) {
  auto settler =
      on_device(device, why_not, [&] { return std::make_unique<CudaCostToGo>(device, kLongestTrial, kTrialSide); });
  return settler && passes_trial(std::move(settler), why_not);
}

bool passes_trial(std::unique_ptr<field::CostSettler> settler, std::string& why_not) {
  PlannerConfig config;
  config.side_cells = config.max_side_cells = kTrialSide;
  field::TimeToGoPlanner tried(config, std::move(settler));
  return plans_the_same(tried, *make_cpu_planner(config), why_not);
}

bool has_cuda_left_behind() { return CudaDevice::has_left_behind(); }

}  // namespace jaywalk
