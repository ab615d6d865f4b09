#include "apps/view/view_snapshot.h"

#include <algorithm>
#include <cmath>

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

constexpr std::uint8_t kNoWay = 254, kNotFree = 255;
constexpr std::uint8_t kNeverSeen = 127;  // added
constexpr double kFarthest = 126.0;

std::uint8_t byte_of(float psi, double most) noexcept {
  if (std::isnan(psi)) return kNotFree;
  if (std::isinf(psi)) return kNoWay;
  return static_cast<std::uint8_t>(std::clamp(kFarthest * static_cast<double>(psi) / most, 0.0, kFarthest));
}

constexpr Duration kOfferEvery = std::chrono::milliseconds(500);

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

void draw(FieldPicture& into, const FieldView& field, const EvidenceMap& seen) noexcept {
  double most = 1e-6;
  for (const float psi : field.psi)
    if (std::isfinite(psi)) most = std::max(most, static_cast<double>(psi));
  std::int32_t step = 1;
  while (std::max(field.width, field.height) > step * kMostFieldSide) step *= 2;
  into.low_x_m = field.low.i * field.cell_m;
  into.low_y_m = field.low.j * field.cell_m;
  into.cell_m = field.cell_m * step;
  into.width = (field.width + step - 1) / step;
  into.cells.clear();
  for (std::int32_t y = 0; y < field.height; y += step) {
    const std::size_t row = static_cast<std::size_t>(y) * static_cast<std::size_t>(field.width);
    for (std::int32_t x = 0; x < field.width; x += step) {
      std::uint8_t byte = byte_of(field.psi[row + static_cast<std::size_t>(x)], most);
      if (byte < kNoWay && seen.evidence({field.low.i + x, field.low.j + y}) == 0) byte += kNeverSeen;
      static_cast<void>(into.cells.push_back(byte));
    }
  }
}

void PlannerTap::offer(const Planner& planner, const EvidenceMap& map, Time stamp) noexcept {
  if (!wanted_ || full_.load(std::memory_order_acquire)) return;
  if (stamp_ != kNever && age(stamp_, stamp) < kOfferEvery) return;
  draw(field_, planner.view_field(), map);
  map_ = map;  // of the same size: no memory is taken
  stamp_ = stamp;
  full_.store(true, std::memory_order_release);
}

}  // namespace jaywalk::view
