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
#include "firmware/recording/recorder.h"
#include "firmware/recording/tick_record.h"
#include "hal/maps/wall_map.h"
#include "hal/types/fixed_vector.h"
#include "hal/types/robot_model.h"
#include "planner/cost_to_go/planner.h"
#include "planner/mapping/evidence_map.h"
#include "planner/mapping/known_map.h"
#include "planner/motion/trajectory.h"
#include "planner/prediction/futures.h"

namespace jaywalk::view {

inline constexpr std::size_t kShownFutures = 8;  ///< as many of the sampled ones as the eye can tell apart
inline constexpr std::array<int, 5> kShownSteps{0, 5, 10, 15, 20};  ///< now and in 1, 2, 3 and 4 s
inline constexpr std::size_t kChosenStep = 5;  ///< of the chosen trajectory, from one shown point to the next

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

/// Hands snapshots from the loop's thread, 25 a second, and potential and map from the planner's to one that shows
/// them. None waits: where ring or offer are full, the newer are left out. Memory in the constructor.
class RunTap {
 public:
  struct Offer {
    FieldPicture field;
    EvidenceMap map;
    Time stamp = kNever;
  };

  /// `map`: of the same size as the planner's.
  explicit RunTap(const EvidenceMap& map) : offer_{{}, map} {}

  /// Loop's thread, after a tick.
  void after_tick(const TickRecord& record, const ControlLoop& loop) noexcept;
  /// Planner's thread, after a plan.
  void after_plan(const Planner& planner, const EvidenceMap& map, Time stamp) noexcept;

  /// The other thread: is anything wanted?
  void want(bool wanted) noexcept { wanted_ = wanted; }
  [[nodiscard]] Ring<ViewSnapshot, 4>& snapshots() noexcept { return snapshots_; }
  /// The other thread: null where there is nothing new; valid until taken().
  [[nodiscard]] const Offer* offered() const noexcept {
    return full_.load(std::memory_order_acquire) ? &offer_ : nullptr;
  }
  void taken() noexcept { full_.store(false, std::memory_order_release); }

 private:
  Ring<ViewSnapshot, 4> snapshots_;
  std::atomic<bool> wanted_{false}, full_{false};
  Time taken_ = kNever;  ///< last snapshot; the loop's thread's
  Offer offer_;
};

/// What does not change in a run.
struct HelloScene {
  std::string title;
  std::span<const sim::WallSegment> walls = {};  ///< the world's, where there is one
  const KnownMap* known = nullptr;               ///< the robot's, where it was given one
  bool takes_goals = true;                       ///< and the Stop button
  bool takes_pauses = true;                      ///< Pause and Step hold the program, not only the page
  std::span<const std::string> faults = {};      ///< faults that the page may begin; empty but for an endless world
};
/// `keeps_ticks`: any tick can be asked for.
[[nodiscard]] std::string to_json(const HelloScene& hello, const ControlSetup& setup, bool keeps_ticks);

/// What changes with a scan or a plan: hits, tracks, futures, path. Part of many frames.
[[nodiscard]] std::string to_json(const ViewSnapshot& snapshot, const OfEach<LaserModel>& lasers);

/// One tick, numbered from 0; `ended`: the run's outcome, with its last frame. Ends in `"scene":`; the JSON of a
/// snapshot and a closing brace follow.
[[nodiscard]] std::string frame_head(const ViewSnapshot& snapshot, std::uint64_t number, const ControlSetup& setup,
                                     std::string_view ended);

/// `number` tells fields apart.
[[nodiscard]] std::string to_json(const FieldPicture& field, std::uint64_t number);

}  // namespace jaywalk::view
