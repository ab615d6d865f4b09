#pragma once
#include <atomic>
#include <memory>
#include <thread>

#include "firmware/control_setup.h"
#include "firmware/run_sample.h"
#include "hal/mailbox.h"
#include "planner/cost_to_go/planner.h"

namespace jaywalk {

/// An empty map, as large as the loop's.
[[nodiscard]] EvidenceMap map_for(const ControlSetup& setup);

/// Any planner in a thread of its own, so that a plan that takes long holds up no tick. One request at a time: while
/// it is being answered is_busy() says so, and the loop asks again with its next scan.
class PlannerThread final : public Planner {
 public:
  /// Takes the memory for a copy of the map as large as the loop's. `observer`, told of each plan, outlives it.
  PlannerThread(std::unique_ptr<Planner> planner, const EvidenceMap& map, TickObserver& observer);
  ~PlannerThread() override;

  /// Copies the request, of the map what has changed since the last one, and returns. Not to be called while busy. The
  /// map is always the same object.
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
