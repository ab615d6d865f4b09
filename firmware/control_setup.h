#pragma once
// All that decides on the controller's commands beside the devices' readings. A recording carries it as text.
#include <memory>
#include <string>
#include <vector>

#include "hal/types/geometry.h"
#include "hal/types/map_zones.h"
#include "hal/types/operator_input.h"
#include "hal/types/robot_model.h"
#include "hal/types/time.h"
#include "planner/cost_to_go/planner.h"
#include "planner/mapping/known_map.h"
#include "planner/motion/motion.h"

namespace jaywalk {

enum class Backend { kAuto, kCpu, kCuda };

enum class PlanMode {
  kFull,   ///< what drives
  kPaper,  ///< the paper's planner and follower (planner/paper), of the desktop program alone
};

struct ChosenPlanner;

/// One flat object, as it stands in a recording's head: more fields than a struct has elsewhere.
struct ControlSetup {
  RobotModel model;
  PlanMode mode = PlanMode::kFull;
  bool constant_speed = false;  ///< the paper's constraint; mode paper implies it
  std::string rival{};          ///< name of another planner that decides on motion, for comparisons; empty: none
  motion::MakeMotion make_motion = motion::make_motion;          ///< a rival's, or mode paper's; not in a recording
  ChosenPlanner (*make_planner)(const ControlSetup&) = nullptr;  ///< mode paper's; null: firmware/backends.h's
  StickUse steering = StickUse::kNone;
  Backend backend = Backend::kAuto;
  bool given_movers = false;  ///< they come with the fix from outside; mode paper implies it
  int device = 0;  ///< of backend cuda, and of auto: CUDA's number; not in a recording, the bits are the same
  Pose2 start;     ///< where the robot believes to be when the loop starts
  Vec2 goal;       ///< for sizing the grid; the goal itself comes from the operator panel
  double goal_tolerance_m = 0.3;
  bool wheels = true;  ///< false: a recording without odometry
  bool wired = false;  ///< devices on wires: every fault waits for a reset
  /// Commanded, felt and seen motion are compared; false for a log whose wheels obeyed another controller.
  bool judges_motion = true;
  double rate_hz = 50.0;
  std::shared_ptr<const KnownMap> known_map{};  ///< what is known before the first scan; null: nothing
  std::vector<MapZone> zones{};                 ///< where not to drive, and where slowly
  double comfort_distance_m = 1.0;              ///< people nearer than this cost; hal/robot_model_file.h
  Duration unix_from_loop{0};  ///< the wall clock less the loop's at the start; 0: there is none beside it
  int part = 1;  ///< number of the recording's part, from 1; a later part does not hold what the run did before it

  /// Whether the body is more than a circle to other planners; never at constant speed: it cannot stop or back out.
  [[nodiscard]] bool has_long_body() const;
  /// The robot's radius where movers are concerned, and walls for a nearly round one.
  [[nodiscard]] double mover_radius_m() const;
  [[nodiscard]] PlannerConfig planner() const;
  [[nodiscard]] motion::MotionSetup motion() const;
  /// Null where there are no such zones. Computed anew with each call.
  [[nodiscard]] std::shared_ptr<const KeepOutField> keep_out() const;
  [[nodiscard]] bool keeps_speed() const { return constant_speed || mode == PlanMode::kPaper; }
  [[nodiscard]] bool sees_given_movers() const { return given_movers || mode == PlanMode::kPaper; }
  /// In mode paper verdicts are recorded and not applied: the paper never stops.
  [[nodiscard]] bool applies_verdict() const { return mode != PlanMode::kPaper; }
  [[nodiscard]] Duration tick() const { return duration_from_seconds(1.0 / rate_hz); }
};

/// JSON; numbers round-trip exactly.
[[nodiscard]] std::string to_text(const ControlSetup& setup);
/// Throws StartupError, naming `place`, for text that is not a setup.
[[nodiscard]] ControlSetup setup_from_text(const std::string& text, const std::string& place);

[[nodiscard]] const char* name_of(PlanMode mode);

}  // namespace jaywalk
