#pragma once
// What the live page is told, as JSON: metres, seconds and radians in the map; numbers that are none are null.
#include <span>
#include <string>

#include "firmware/recording/tick_record.h"
#include "hal/types/robot_model.h"
#include "planner/perception/stander.h"
#include "planner/perception/track.h"
#include "planner/planner.h"

namespace jaywalk::view {

struct WallPiece {
  Vec2 from, to;
};

/// What does not change in a run.
struct HelloScene {
  std::string title;
  RobotModel model;
  std::span<const WallPiece> walls = {};  ///< the world's, where there is one
  bool takes_goals = true;                ///< goal and stop; pause and step are for everything simulated
};
[[nodiscard]] std::string to_json(const HelloScene& hello);

/// One tick.
struct FrameScene {
  const TickRecord& record;
  std::span<const Track> tracks;
  std::span<const Stander> standing;
  const Plan& plan;
  std::string ended = {};  ///< the run's outcome, with its last frame
};
[[nodiscard]] std::string to_json(const FrameScene& frame, const Pose2& robot_from_laser);

/// The potential, thinned to at most 128 cells a side, a byte a cell: 0 at the goal to 253 farthest, 254 without a way
/// to the goal, 255 not free; base64, row by row from the lowest y.
[[nodiscard]] std::string to_json(const FieldView& field);

}  // namespace jaywalk::view
