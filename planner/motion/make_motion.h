#pragma once
// Makes the one Motion that a control loop holds.
#include <memory>

#include "hal/types/operator_input.h"
#include "hal/types/robot_model.h"
#include "planner/mapping/keep_out.h"
#include "planner/motion/motion.h"

namespace jaywalk::motion {

struct MotionSetup {
  RobotModel model;
  bool constant_speed = false;  ///< one speed from start to goal, never stopping
  StickUse steering = StickUse::kNone;
  double comfort_distance_m = 1.0;  ///< a pedestrian's middle nearer than this to the body's discs costs
  double goal_tolerance_m = 0.3;
  double tick_s = 0.02;
  std::shared_ptr<const KeepOutField> keep_out = {};  ///< null: no such zones

  [[nodiscard]] KeepOut keep_out_zones() const noexcept { return keep_out ? keep_out->view() : KeepOut{}; }
};

/// Throws nothing but std::bad_alloc.
[[nodiscard]] std::unique_ptr<Motion> make_motion(const MotionSetup& setup);
/// Makes a motion; another than make_motion(), for comparisons and for mode paper.
using MakeMotion = std::unique_ptr<Motion> (*)(const MotionSetup&);

}  // namespace jaywalk::motion
