#pragma once
// Messages to the live page, JSON: metres, seconds and radians in the map; numbers that are none are null.
#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "apps/view/view_snapshot.h"
#include "firmware/recording/tick_record.h"
#include "firmware/safety/stop_zone.h"
#include "hal/maps/wall_map.h"
#include "hal/types/fixed_vector.h"
#include "hal/types/robot_model.h"
#include "planner/mapping/known_map.h"

namespace jaywalk::view {
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
  bool takes_goals = true;   ///< and the Stop button
  bool takes_pauses = true;  ///< Pause and Step hold the program, not only the page
  bool keeps_ticks = true;   ///< any tick can be asked for
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
