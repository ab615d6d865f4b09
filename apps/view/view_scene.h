#pragma once
// Ticks and plans that the live page shows, as plain values: copied in the loop's or the planner's thread, shown by
// another; and the messages to it, JSON: metres, seconds and radians in the map; numbers that are none are null.
#include <array>
#include <atomic>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "firmware/control_loop.h"
#include "firmware/recording/tick_record.h"
#include "firmware/robot/service_manager.h"
#include "firmware/safety/stop_zone.h"
#include "hal/maps/wall_map.h"
#include "hal/types/fixed_vector.h"
#include "hal/types/robot_model.h"
#include "planner/cost_to_go/planner.h"
#include "planner/mapping/evidence_map.h"
#include "planner/mapping/known_map.h"
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

/// The body's corners in the map, grown by the stop zone's margin.
using Corners = std::array<Vec2, 4>;

/// The supervisor's stop zone as a picture: where the body comes until it stands, from the twist that was permitted,
/// after the reaction time that the supervisor reckons with, along its arc.
class ShownStopZone {
 public:
  ShownStopZone(const RobotModel& model, Duration tick);

  using Outlines = FixedVector<Corners, 4>;  ///< the last one is where the body stands
  [[nodiscard]] Outlines at(const TickRecord& record) const noexcept;

 private:
  RobotModel model_;
  Duration tick_;
  StopZone zone_;
};

/// What does not change in a run.
struct HelloScene {
  std::string title;
  RobotModel model = {};
  std::span<const sim::WallSegment> walls = {};  ///< the world's, where there is one
  const KnownMap* known = nullptr;               ///< the robot's, where it was given one
  double tick_s = 0.02;
  bool takes_goals = true;                   ///< and the Stop button
  bool takes_pauses = true;                  ///< Pause and Step hold the program, not only the page
  bool keeps_ticks = true;                   ///< any tick can be asked for
  std::span<const std::string> faults = {};  ///< faults that the page may begin; empty but for an endless world
};
[[nodiscard]] std::string to_json(const HelloScene& hello);

/// What changes with a scan or a plan: hits, tracks, futures, path. Part of many frames.
[[nodiscard]] std::string to_json(const ViewSnapshot& snapshot, const OfEach<LaserModel>& lasers);

/// One tick.
struct FrameScene {
  std::uint64_t tick = 0;  ///< from 0
  const TickRecord& record;
  ShownStopZone::Outlines zone;
  double speed_mps = 0.0;    ///< as the wheels say, or the scans
  std::string_view ended{};  ///< the run's outcome, with its last frame
};
/// Ends in `"scene":`; the JSON of a snapshot and a closing brace follow.
[[nodiscard]] std::string frame_head(const FrameScene& frame);

/// `number` tells fields apart.
[[nodiscard]] std::string to_json(const FieldPicture& field, std::uint64_t number);

}  // namespace jaywalk::view
