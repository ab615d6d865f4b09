#include "apps/view/planner_tap.h"

namespace jaywalk::view {
namespace {

constexpr Duration kOfferEvery = std::chrono::milliseconds(500);

}  // namespace

void PlannerTap::offer(const Planner& planner, const EvidenceMap& map, Time stamp) noexcept {
  if (!wanted_ || full_.load(std::memory_order_acquire)) return;
  if (stamp_ != kNever && age(stamp_, stamp) < kOfferEvery) return;
  draw(field_, planner.view_field(), map);
  map_ = map;  // of the same size: no memory is taken
  stamp_ = stamp;
  full_.store(true, std::memory_order_release);
}

}  // namespace jaywalk::view
