#include "apps/view/view_snapshot.h"

#include "planner/motion/goal_rollouts.h"

namespace jaywalk::view {
namespace {

constexpr Duration kTakeEvery = std::chrono::milliseconds(40);

template <class T, std::size_t N>
void copy(FixedVector<T, N>& to, std::span<const T> from) noexcept {
  to.clear();
  for (const T& item : from) {
    if (!to.push_back(item)) break;
  }
}

ShownMover shown(const motion::Futures& futures, std::size_t mover) noexcept {
  ShownMover out{.radius_m = futures.radius(mover)};
  for (std::size_t step = 0; step < kShownSteps.size(); ++step) {
    const motion::MoverAt& at = futures.at(kShownSteps[step], mover);
    for (std::size_t f = 0; f < kShownFutures; ++f) out.at[f][step] = {at.x[f], at.y[f]};
  }
  return out;
}

}  // namespace

void take(ViewSnapshot& into, const TickRecord& record, const ControlLoop& loop) noexcept {
  into.record = record;
  for (std::size_t k = 0; k < record.scans().size(); ++k)
    into.map_from_robot_at_scan[k] = loop.estimator().map_from_robot_at_scan(k);
  into.twist = loop.estimator().twist();
  copy(into.tracks, std::span<const Track>(loop.tracker().tracks()));
  copy(into.standing, std::span<const StandingPedestrian>(loop.tracker().standing()));
  into.plan = loop.plan();
  into.movers.clear();
  const motion::GoalRollouts* rollouts = loop.motion().rollouts();
  into.has_chosen = rollouts != nullptr && rollouts->decision().at != kNever;
  if (rollouts == nullptr) return;
  for (std::size_t k = 0; k < into.chosen.size(); ++k) {
    const motion::RobotState& s = rollouts->decision().driven[k * kChosenStep];
    into.chosen[k] = {s.x, s.y};
  }
  const motion::Futures& futures = rollouts->futures();
  for (std::size_t mover = 0; mover < futures.movers(); ++mover) {
    if (futures.is_surface(mover)) continue;
    if (!into.movers.push_back(shown(futures, mover))) break;
  }
}

void SnapshotTap::offer(const TickRecord& record, const ControlLoop& loop) noexcept {
  if (!wanted_ || (taken_ != kNever && age(taken_, record.now) < kTakeEvery)) return;
  ViewSnapshot* const slot = snapshots_.draft();
  if (slot == nullptr) return;
  take(*slot, record, loop);
  taken_ = record.now;
  snapshots_.publish();
}

}  // namespace jaywalk::view
