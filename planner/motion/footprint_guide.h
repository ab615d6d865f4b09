#pragma once
#include <limits>
#include <span>

#include "hal/types/robot_model.h"
#include "planner/motion/body_map.h"
#include "planner/motion/held_time.h"
#include "planner/motion/manoeuvre_drive.h"
#include "planner/motion/manoeuvre_search.h"
#include "planner/motion/motion.h"
#include "planner/planner.h"

namespace jaywalk {

/// What the guide looks at when a new path has come.
struct GuideInput {
  const Path& path;
  Pose2 map_from_robot{};
  Twist2 wanted{}, driven{};  ///< what the follower asked for this tick, and what the supervisor made of it
  const EvidenceMap& still;
  std::span<const StandingPedestrian> standing = {};  ///< PlanRequest's
  std::span<const Track> moving = {};                 ///< the same
  Vec2 goal_in_map{};
  KeepOut keep_out{};                    ///< where the body must not be though nothing stands there
  bool pedestrian_hidden = false;        ///< Perceived::pedestrian_hidden
  Time now{};                            ///< the tick's: waits are counted by it
  std::span<const Vec2> unseen_walls{};  ///< World's
};

[[nodiscard]] GuideInput guide_input(const motion::World& world, const KeepOut& keep_out) noexcept;

/// For a body that is longer than wide: the path is one for the circle inside it, and says nothing about which way
/// the body points. On each new path the guide rolls it out with the follower's own steering, and looks
/// whether the outline keeps clear of what stands: at full speed, at half, at a quarter (slower means closer to the
/// path). Where none of them fits it searches a manoeuvre: turning elsewhere, swinging wide, backing out.
///
/// A body that is nearly round needs none of that and gets none: it plans with the circle that holds it.
/// Memory in the constructor; thread: the loop's, after the wheels have their command.
class FootprintGuide {
 public:
  FootprintGuide(const Footprint& footprint, const MotionLimits& limits);

  void update(const GuideInput& input) noexcept;
  /// Fastest along the path (m/s); infinity where nothing is in the way of the body.
  [[nodiscard]] double most_speed_mps() const noexcept { return most_speed_mps_; }
  /// Something has come so near that slowing down comfortably would touch it.
  [[nodiscard]] bool brakes_hard() const noexcept { return brakes_hard_; }
  /// To be driven in place of the path while it is active.
  [[nodiscard]] ManoeuvreDrive& manoeuvre() noexcept { return drive_; }

 private:
  [[nodiscard]] double speed_that_fits(const GuideInput& input) const noexcept;
  [[nodiscard]] ManoeuvreGoal goal_along(const GuideInput& input) noexcept;
  void note_goal(Vec2 goal_in_map) noexcept;
  [[nodiscard]] bool may_back_off(const GuideInput& input) const noexcept;
  [[nodiscard]] bool unseen_behind(const Pose2& here, double back_m) const noexcept;
  void back_out(const Pose2& here) noexcept;
  void back_off(const Pose2& here) noexcept;
  void look_round(const Pose2& here) noexcept;
  [[nodiscard]] bool keeps_manoeuvre(const GuideInput& input) const noexcept;
  [[nodiscard]] bool is_refused(const GuideInput& input) noexcept;
  [[nodiscard]] bool sets_out_straight(const Pose2& here) noexcept;
  void search(const GuideInput& input) noexcept;

  MotionLimits limits_;
  BodyMap map_;
  WayCost reach_;
  ManoeuvreSearch search_;
  ManoeuvreDrive drive_;
  Manoeuvre back_;
  Vec2 goal_in_map_;
  bool has_set_out_ = false;  ///< has searched before
  double most_speed_mps_ = std::numeric_limits<double>::infinity();
  bool brakes_hard_ = false;
  int rounds_ = 0;    ///< how often it has looked round since the path fitted last
  int searches_ = 0;  ///< the same
  HeldTime unfit_;    ///< the path has fitted at no speed; manoeuvres do not count
  HeldTime refused_;  ///< the supervisor has refused to move
};

}  // namespace jaywalk
