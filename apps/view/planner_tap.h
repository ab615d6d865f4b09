#pragma once
#include <atomic>

#include "apps/view/field_picture.h"
#include "planner/mapping/evidence_map.h"

namespace jaywalk::view {

/// Hands potential and map from the planner's thread to one that shows them. Neither waits: where the last ones were
/// not yet taken, the newer are left out. Memory in the constructor.
class PlannerTap {
 public:
  /// `map`: of the same size as the planner's.
  explicit PlannerTap(const EvidenceMap& map) : map_(map) {}

  /// Planner's thread, after a plan.
  void offer(const Planner& planner, const EvidenceMap& map, Time stamp) noexcept;

  /// The other thread: is anything wanted?
  void want(bool wanted) noexcept { wanted_ = wanted; }
  /// The other thread: true where there is something new, valid until taken().
  [[nodiscard]] bool has_new() const noexcept { return full_.load(std::memory_order_acquire); }
  void taken() noexcept { full_.store(false, std::memory_order_release); }
  [[nodiscard]] const FieldPicture& field() const noexcept { return field_; }
  [[nodiscard]] const EvidenceMap& map() const noexcept { return map_; }
  [[nodiscard]] Time stamp() const noexcept { return stamp_; }

 private:
  std::atomic<bool> wanted_{false}, full_{false};
  FieldPicture field_;
  EvidenceMap map_;
  Time stamp_ = kNever;
};

}  // namespace jaywalk::view
