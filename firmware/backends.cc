#include "firmware/backends.h"

#include <cassert>
#include <utility>

#include "drivers/wire/thread_without_signals.h"
#include "planner/cost_to_go/fallback_planner.h"
#include "planner/tracking/tracker.h"

#ifndef JAYWALK_HAS_CUDA
#define JAYWALK_HAS_CUDA 0
#endif
#if JAYWALK_HAS_CUDA
#include "cuda/cuda_planner.h"
#include "hal/types/errors.h"
#endif

namespace jaywalk {

#if !JAYWALK_HAS_CUDA
namespace {
std::unique_ptr<Planner> make_cuda_planner(const PlannerConfig&, int, std::string& why_not) {
  why_not = "cuda: not in this build";
  return nullptr;
}
bool passes_cuda_trial(int, std::string& why_not) { return why_not = "cuda: not in this build", false; }
bool has_cuda_left_behind() { return false; }
}  // namespace
#endif

const char* built_backends() { return JAYWALK_HAS_CUDA ? "cpu, cuda" : "cpu"; }

void refuse_cuda(const std::string& why_not) {
  throw StartupError("--backend " + why_not, "plan on the CPU: --backend cpu, or auto");
}

ChosenPlanner backed(Backend backend, std::unique_ptr<Planner> device, std::unique_ptr<Planner> cpu,
                     const std::string& why_not_cuda) {
  if (device) return {std::make_unique<FallbackPlanner>(std::move(device), std::move(cpu)), ""};
  if (backend == Backend::kCuda) refuse_cuda(why_not_cuda);
  return {std::move(cpu), JAYWALK_HAS_CUDA ? why_not_cuda : ""};
}

ChosenPlanner make_planner(const PlannerConfig& config, Backend backend, int device) {
  if (backend == Backend::kCpu) return {make_cpu_planner(config), ""};
  std::string why_not;
  auto planner = passes_cuda_trial(device, why_not) ? make_cuda_planner(config, device, why_not) : nullptr;
  return backed(backend, std::move(planner), make_cpu_planner(config), why_not);
}

ChosenPlanner make_planner(const ControlSetup& setup) {
  if (setup.make_planner != nullptr) return setup.make_planner(setup);
  if (setup.mode == PlanMode::kPaper)
    throw StartupError("mode paper: not in this program", "use the desktop program, jaywalk");
  return make_planner(setup.planner(), setup.backend, setup.device);
}

std::string tried_backend(Backend backend, int device) {
  std::string why_not;
  if (backend == Backend::kCpu) return "plans on the CPU";
  if (passes_cuda_trial(device, why_not))
    return "plans on CUDA device " + std::to_string(device) + ": trial plans have the CPU's bits";
  if (backend == Backend::kCuda) refuse_cuda(why_not);
  return "plans on the CPU (" + why_not + ")";
}

bool has_device_left_behind() { return has_cuda_left_behind(); }

EvidenceMap map_for(const ControlSetup& setup) {
  return {PerceptionConfig{}.map_side_cells, setup.planner().cell_m, {}};
}

namespace {
/// A copy of as many as fit.
template <class T, std::size_t N>
std::span<const T> kept(FixedVector<T, N>& mine, std::span<const T> theirs) noexcept {
  mine.clear();
  for (const T& each : theirs)
    if (!mine.push_back(each)) break;
  return {mine.data(), mine.size()};
}
}  // namespace

PlannerThread::PlannerThread(std::unique_ptr<Planner> planner, const EvidenceMap& map, TickObserver& observer)
    : planner_(std::move(planner)), observer_(observer), still_(map) {
  thread_ = thread_without_signals("plan", [this] { run(); });
}

PlannerThread::~PlannerThread() {
  ending_ = true;
  asked_.fetch_add(1);
  asked_.notify_one();
  thread_.join();
}

void PlannerThread::submit(const PlanRequest& request) noexcept {
  request_ = request;
  assert(request.still->side() == still_.side());
  still_.follow(*request.still);  // of the same size: no memory is taken
  request_.still = &still_;
  request_.moving = kept(moving_, request.moving);
  request_.standing = kept(standing_, request.standing);
  request_.masked = kept(masked_, request.masked);
  request_.poses.unseen_walls = kept(unseen_walls_, request.poses.unseen_walls);
  busy_.store(true, std::memory_order_release);
  asked_.fetch_add(1, std::memory_order_release);
  asked_.notify_one();
}

void PlannerThread::run() noexcept {
  for (std::uint32_t answered = 0;; ++answered) {
    asked_.wait(answered, std::memory_order_acquire);
    if (ending_) return;
    planner_->submit(request_);
    plans_.publish(planner_->collect());
    observer_.after_plan(*planner_, still_, request_.stamp);
    busy_.store(false, std::memory_order_release);
  }
}

FieldView PlannerThread::view_field() const {
  while (is_busy()) std::this_thread::yield();
  return planner_->view_field();
}
}  // namespace jaywalk
