#pragma once
// Motion's door: from what the robot knows to the twist that it wants. The supervisor decides what becomes of that.
#include <limits>
#include <memory>
#include <span>

#include "hal/types/laser_scan.h"
#include "hal/types/operator_input.h"
#include "hal/types/robot_model.h"
#include "planner/cost_to_go/planner.h"
#include "planner/mapping/known_map.h"
#include "planner/scan/line_of_sight.h"

namespace jaywalk::motion {

/// What the tracker knows, valid within the tick.
struct Perceived {
  std::span<const Track> tracks{}, moving{};  ///< all of them; those that move
  std::span<const StandingPedestrian> standing{};
  const EvidenceMap& still;  ///< what stands
};

/// The input of motion in a tick, in the map: one field for each stage before it, so more than a struct has elsewhere.
/// Valid within the tick.
struct World {
  Time now = kNever;
  bool new_scan = false, new_plan = false;  ///< since the tick before; a plan counts while there is a goal
  Pose2 map_from_robot{};
  Twist2 driven{};  ///< asked for last, as far as the supervisor permitted
  const OperatorInput& input;
  const LaserScan& scan;   ///< the newest
  Pose2 map_from_laser{};  ///< at that scan
  Perceived perceived;
  const Plan& plan;  ///< the newest
  std::span<const Vec2>
      unseen_walls{};                ///< what the supervisor reckons with where no laser looks; in the robot's frame
  OfOthers<SeenFrom> other_scans{};  ///< the newest of each other scanner

  [[nodiscard]] SeenFrom newest() const { return {&scan, map_from_laser}; }
};

/// What is to be done in this tick.
struct Intent {
  enum class Kind { kRest, kGoal, kStick };
  Kind kind = Kind::kRest;
  Stick stick{};                                              ///< of kStick
  double most_mps = std::numeric_limits<double>::infinity();  ///< beside the robot's own limit
};

/// What supervisor, record and pages are told.
struct MotionStatus {
  Time rests_on = kNever;      ///< stamp of the scan that the commands rest on
  bool turns_at_goal = false;  ///< only the heading is left to be reached
  bool turn_blocked = false;   ///< there is no room for that
  Twist2 stick_asks{};         ///< of a stick that steers, before anything is avoided
};

class GoalRollouts;

/// Decides how the robot moves. One object drives from start to end; make_motion() makes it. A new kind of motion
/// implements this, and has one line in make_motion().
///
/// Memory in the constructor: no call allocates, throws or waits. Thread: the loop's.
class Motion {
 public:
  virtual ~Motion() = default;
  /// Each tick, before command(): keeps account of how the robot moves, also while another motion drives it.
  virtual void observe(const World& world, const Intent& intent) noexcept = 0;
  /// Each tick in which this motion drives: the twist that it wants.
  [[nodiscard]] virtual Twist2 command(const World& world, const Intent& intent) noexcept = 0;
  /// With a new scan or plan, after the wheels have their command: how to move from the next tick on.
  virtual void decide(const World& world, const Intent& intent) noexcept = 0;
  [[nodiscard]] virtual MotionStatus status() const noexcept = 0;
  /// What to ask of the planner. Valid within the tick.
  [[nodiscard]] virtual PlanRequest request(const World& world) const noexcept = 0;
  /// At most one request in this time.
  [[nodiscard]] virtual Duration plan_every() const noexcept { return Duration{0}; }
  /// For pictures: the decisions over sampled futures on the way to a goal; null where nothing is rolled out.
  [[nodiscard]] virtual const GoalRollouts* rollouts() const noexcept { return nullptr; }
};

struct MotionSetup {
  RobotModel model;
  bool constant_speed = false;  ///< one speed from start to goal, never stopping
  StickUse steering = StickUse::kNone;
  double comfort_distance_m = 1.0;  ///< a pedestrian's middle nearer than this to the body's discs costs
  double goal_tolerance_m = 0.3;
  double tick_s = 0.02;
  std::shared_ptr<const KeepOutField> keep_out = {};  ///< null: no such zones
};

/// Throws nothing but std::bad_alloc.
[[nodiscard]] std::unique_ptr<Motion> make_motion(const MotionSetup& setup);
/// Makes a motion; another than make_motion(), for comparisons and for mode paper.
using MakeMotion = std::unique_ptr<Motion> (*)(const MotionSetup&);

}  // namespace jaywalk::motion
