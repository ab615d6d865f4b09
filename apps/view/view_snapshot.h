#pragma once
// Ticks and plans that the live page shows, as plain values: copied in the loop's or the planner's thread, shown by
// another.
#include <array>
#include <atomic>
#include <cstdint>

#include "firmware/control_loop.h"
#include "firmware/recording/tick_record.h"
#include "firmware/robot/service_manager.h"
#include "hal/types/fixed_vector.h"
#include "planner/cost_to_go/planner.h"
#include "planner/mapping/evidence_map.h"
#include "planner/motion/trajectory.h"
#include "planner/prediction/futures.h"

namespace jaywalk::view {
/// Of the planner's sampled futures as many are shown as the eye can tell apart.
inline constexpr std::size_t kShownFutures = 8;
/// Now and in 1, 2, 3 and 4 s.
inline constexpr std::array<int, 5> kShownSteps{0, 5, 10, 15, 20};

/// Steps of the chosen trajectory from one shown point to the next.
inline constexpr std::size_t kChosenStep = 5;

/// Where one mover is in the sampled futures, m in the map.
struct ShownMover {
  float radius_m = 0.0F;
  std::array<std::array<Place, kShownSteps.size()>, kShownFutures> at{};
};

/// Memory of a fixed size. `plan.guide` points into the planner: not to be followed.
struct ViewSnapshot {
  TickRecord record;
  /// Where the record's scans were taken from; by record.pose the robot has driven on.
  std::array<Pose2, kMostScanners> map_from_robot_at_scan;
  Twist2 twist;  ///< as the wheels say, or the scans
  FixedVector<Track, kMaxTracks> tracks;
  FixedVector<StandingPedestrian, kMaxTracks> standing;
  FixedVector<ShownMover, motion::kMostMovers> movers;       ///< that walk or may; none without motion over futures
  std::array<Place, motion::kSteps / kChosenStep> chosen{};  ///< trajectory decided on, m in the map
  bool has_chosen = false;
  Plan plan;
};

/// Copies; allocates nothing, waits for nothing. Thread: the loop's.
void take(ViewSnapshot& into, const TickRecord& record, const ControlLoop& loop) noexcept;

/// Hands snapshots from the loop's thread to one that shows them, 25 a second. Neither waits: where the ring is full, a
/// snapshot is left out. Memory in the constructor.
class SnapshotTap {
 public:
  /// Loop's thread, after a tick.
  void offer(const TickRecord& record, const ControlLoop& loop) noexcept;
  /// The other thread: is anything wanted?
  void want(bool wanted) noexcept { wanted_ = wanted; }
  [[nodiscard]] Ring<ViewSnapshot, 4>& snapshots() noexcept { return snapshots_; }

 private:
  Ring<ViewSnapshot, 4> snapshots_;
  std::atomic<bool> wanted_{false};
  Time taken_ = kNever;  ///< the loop's thread's
};

inline constexpr std::int32_t kMostFieldSide = 128;

/// The potential, thinned to at most kMostFieldSide cells a side, a byte a cell, row by row from the lowest y: 0 at the
/// goal to 126 farthest, 127 more where nothing was ever seen, 254 without a way to the goal, 255 not free. Memory of a
/// fixed size.
struct FieldPicture {
  double low_x_m = 0.0, low_y_m = 0.0, cell_m = 0.0;  ///< in the map
  std::int32_t width = 0;
  FixedVector<std::uint8_t, static_cast<std::size_t>(kMostFieldSide) * kMostFieldSide> cells;
};

/// Allocates nothing. Thread: any that may look at the field.
void draw(FieldPicture& into, const FieldView& field, const EvidenceMap& seen) noexcept;

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
