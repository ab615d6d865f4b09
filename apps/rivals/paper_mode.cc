#include "apps/rivals/paper_mode.h"

#include <utility>

#include "apps/rivals/baseline.h"

#ifndef JAYWALK_HAS_CUDA
#define JAYWALK_HAS_CUDA 0
#endif
#if JAYWALK_HAS_CUDA
#include "cuda/paper/cuda_paper.h"
#endif

namespace jaywalk {

#if !JAYWALK_HAS_CUDA
namespace paper {
namespace {
std::unique_ptr<Planner> make_cuda_paper_planner(const PaperConfig&, int, std::string& why_not) {
  why_not = "cuda: not in this build";
  return nullptr;
}
std::unique_ptr<MapField> make_cuda_map_field(const CellMap&, int, std::string& why_not) {
  why_not = "cuda: not in this build";
  return nullptr;
}
}  // namespace
}  // namespace paper
#endif

namespace {

ChosenPlanner make_planner_of_paper(const ControlSetup& setup) {
  return make_paper_planner({setup.planner(), setup.mover_radius_m()}, setup.backend, setup.device);
}

}  // namespace

void equip(ControlSetup& setup) noexcept {
  setup.make_motion = baseline::maker_of(setup.rival);
  if (setup.mode != PlanMode::kPaper) return;
  setup.make_motion = paper::make_motion;
  setup.make_planner = make_planner_of_paper;
}

ChosenPlanner make_paper_planner(const paper::PaperConfig& config, Backend backend, int device) {
  auto cpu = paper::make_cpu_paper_planner(config);
  if (backend == Backend::kCpu) return {std::move(cpu), ""};
  std::string why_not;
  auto planner = paper::make_cuda_paper_planner(config, device, why_not);
  return backed(backend, std::move(planner), std::move(cpu), why_not);
}

std::unique_ptr<paper::MapField> make_map_field(const paper::CellMap& map, Backend backend, int device) {
  if (backend == Backend::kCpu) return paper::make_cpu_map_field(map);
  std::string why_not;
  if (auto solver = paper::make_cuda_map_field(map, device, why_not)) return solver;
  if (backend == Backend::kCuda) refuse_cuda(why_not);
  return paper::make_cpu_map_field(map);
}

}  // namespace jaywalk
