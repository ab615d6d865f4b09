#pragma once
// Executors that this build has, and the one that a run gets; mode paper's: apps/rivals/paper_mode.h.
#include <atomic>
#include <memory>
#include <string>
#include <thread>

#include "firmware/control_setup.h"
#include "firmware/run_sample.h"
#include "hal/mailbox.h"
#include "planner/cost_to_go/planner.h"

namespace jaywalk {

struct ChosenPlanner {
  std::unique_ptr<Planner> planner;
  std::string why_not_cuda;  ///< for the summary, where this build could but this machine cannot; else empty
};

/// kAuto takes the GPU where build and machine have one, the CPU elsewhere. A GPU is tried first: plans of a small room
/// that have not the CPU's bits are a reason not to take it. One that fails while it plans gives way to the CPU
/// (FallbackPlanner). `device`: CUDA's number. Throws StartupError where kCuda cannot be had.
[[nodiscard]] ChosenPlanner make_planner(const PlannerConfig& config, Backend backend, int device = 0);
/// The setup's planner: of its own make_planner where it has one. Throws StartupError for mode paper without.
[[nodiscard]] ChosenPlanner make_planner(const ControlSetup& setup);
/// A device's planner backed by the CPU's, or that one alone. Throws StartupError where kCuda cannot be had.
[[nodiscard]] ChosenPlanner backed(Backend backend, std::unique_ptr<Planner> device, std::unique_ptr<Planner> cpu,
                                   const std::string& why_not_cuda);
/// Throws StartupError: a device was asked for and cannot be had.
[[noreturn]] void refuse_cuda(const std::string& why_not);

/// Tries what make_planner() would take, and says in a few words what that is. Throws StartupError like it.
[[nodiscard]] std::string tried_backend(Backend backend, int device = 0);

/// Whether this process has given up work of a device that may still run: it then ends by std::_Exit.
[[nodiscard]] bool has_device_left_behind();

/// "cpu" or "cpu, cuda": what this build has, for --version.
[[nodiscard]] const char* built_backends();

/// An empty map, as large as the loop's.
[[nodiscard]] EvidenceMap map_for(const ControlSetup& setup);

/// Any planner in a thread of its own: a long plan holds up no tick. While it answers one request it is_busy().
class PlannerThread final : public Planner {
 public:
  /// Takes the memory for a copy of the map as large as the loop's. `observer`, told of each plan, outlives it.
  PlannerThread(std::unique_ptr<Planner> planner, const EvidenceMap& map, TickObserver& observer);
  ~PlannerThread() override;

  /// Copies the request, of the map (always the same object) what has changed. Not to be called while busy.
  void submit(const PlanRequest& request) noexcept override;
  [[nodiscard]] bool is_busy() const noexcept override { return busy_.load(std::memory_order_acquire); }
  [[nodiscard]] const Plan& collect() noexcept override { return plans_.latest(); }
  /// Waits while busy.
  [[nodiscard]] FieldView view_field() const override;
  [[nodiscard]] const char* backend() const noexcept override { return planner_->backend(); }

 private:
  void run() noexcept;

  std::unique_ptr<Planner> planner_;
  TickObserver& observer_;
  PlanRequest request_;
  EvidenceMap still_;
  FixedVector<Track, kMaxTracks> moving_;
  FixedVector<StandingPedestrian, kMaxTracks> standing_;
  FixedVector<MoverDisc, kMaxTracks> masked_;
  FixedVector<Vec2, kMaxUnseenWalls> unseen_walls_;
  Mailbox<Plan> plans_;
  std::atomic<bool> busy_{false}, ending_{false};
  std::atomic<std::uint32_t> asked_{0};
  std::thread thread_;
};

}  // namespace jaywalk
