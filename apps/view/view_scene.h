#pragma once
// What the live page is told, as JSON: metres, seconds and radians in the map; numbers that are none are null.
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "apps/view/field_picture.h"
#include "apps/view/shown_stop_zone.h"
#include "apps/view/view_snapshot.h"
#include "hal/types/robot_model.h"
#include "planner/mapping/known_map.h"

namespace jaywalk::view {

struct WallPiece {
  Vec2 from, to;
};

/// What does not change in a run.
struct HelloScene {
  std::string title;
  RobotModel model = {};
  std::span<const WallPiece> walls = {};  ///< the world's, where there is one
  const KnownMap* known = nullptr;        ///< the robot's, where it was given one
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
