#include "apps/rivals/baseline.h"

#include <algorithm>
#include <cmath>

#include "planner/motion/rollout_motion.h"
#include "planner/prediction/mover_history.h"

namespace jaywalk::baseline {
namespace {

// As the roll-outs', as the limits below.
constexpr Duration kGuideHoldsFor = std::chrono::seconds(1);
constexpr float kMostTurn = 1.2F, kMostTurnAccel = 2.0F, kSlowing = 0.8F, kMostJerk = 0.75F;
constexpr float kTurnGain = 2.0F;     // rad/s a radian off the heading wanted at the goal
constexpr float kStopWithin = 0.66F;  // of the tolerance

motion::MotionBounds bounds_of(const MotionLimits& limits) {
  const auto at_most = [](double limit, float most) { return std::min(static_cast<float>(limit), most); };
  const auto accel = static_cast<float>(limits.max_accel_mps2);
  return {.speed = static_cast<float>(limits.max_speed_mps * (1.0 - 1e-6)),
          .back = 0.0F,
          .turn = at_most(limits.max_turn_radps, kMostTurn),
          .turn_accel = at_most(limits.max_turn_accel_radps2, kMostTurnAccel),
          .accel = accel,
          .slowing = std::max(accel, at_most(limits.brake_mps2, kSlowing)),
          .jerk = at_most(limits.max_jerk_mps3, kMostJerk)};
}

constexpr float kAhead_m = 0.5F;
constexpr int kDownDirections = 48;
constexpr float kArc_s = 0.5F;  ///< T: an arc's time

float goal_distance(const Scene& scene) noexcept {
  const float dx = scene.goal.x - scene.now.x, dy = scene.goal.y - scene.now.y;
  return std::sqrt(dx * dx + dy * dy);
}

/// Decides with each scan, and drives at each tick, with the comfort limits of motion::RolloutMotion.
class BaselineMotion final : public motion::Motion {
 public:
  using Decide = motion::Command (*)(const Scene&) noexcept;
  BaselineMotion(Decide deciding, const motion::MotionSetup& setup)
      : decide_(deciding),
        bounds_(bounds_of(setup.model.limits)),
        radius_(static_cast<float>(setup.model.footprint.circumscribed_radius_m())),
        tick_s_(static_cast<float>(setup.tick_s)),
        tolerance_m_(static_cast<float>(setup.goal_tolerance_m)),
        speed_mps_(setup.model.limits.max_speed_mps) {}

  void observe(const motion::World& world, const motion::Intent&) noexcept override {
    status_.rests_on = std::min(seen_, world.plan.stamp);
  }
  void decide(const motion::World& world, const motion::Intent& intent) noexcept override {
    if (!world.new_scan || !finite(world.map_from_robot)) return;
    const Guide& guide = world.plan.guide;
    const SeenFrom newest = world.newest();
    memory_.update({world.now,
                    world.map_from_robot,
                    world.perceived.tracks,
                    world.perceived.standing,
                    world.perceived.still,
                    {newest, world.other_scans},
                    guide});
    const bool has_goal = intent.kind == motion::Intent::Kind::kGoal;
    if (!has_goal || age(world.plan.stamp, world.now) >= kGuideHoldsFor || !guide.known()) return;
    const Vec2 goal = world.input.goal_in_map;
    decided_ = decide_({motion::state_of(world),
                        {static_cast<float>(goal.x), static_cast<float>(goal.y)},
                        world.perceived.tracks,
                        guide,
                        bounds_,
                        radius_});
    decided_at_ = world.now;
    seen_ = world.scan.stamp;
  }
  [[nodiscard]] Twist2 command(const motion::World& world, const motion::Intent& intent) noexcept override {
    const motion::Command was{static_cast<float>(world.driven.v_mps), static_cast<float>(world.driven.w_radps)};
    if (std::fabs(was.v - commanded_.v) > 1e-4F) accel_ = 0.0F;  // the supervisor has set the speed
    const double to_goal_m = distance(world.map_from_robot.position(), world.input.goal_in_map);
    const bool there = to_goal_m < static_cast<double>(kStopWithin * tolerance_m_);
    const bool rests = intent.kind != motion::Intent::Kind::kGoal || there || decided_at_ == kNever ||
                       world.now - decided_at_ > motion::kHoldsFor;
    const bool turns = there && world.input.wants_heading() && std::fabs(was.v) < motion::kRestsMps;
    const double error = turns ? world.input.heading_error_rad(world.map_from_robot) : 0.0;
    const motion::Command at_rest{0.0F, std::clamp(kTurnGain * static_cast<float>(error), -bounds_.turn, bounds_.turn)};
    const motion::RobotState next =
        motion::moved({0.0F, 0.0F, 0.0F, was.v, was.w, accel_}, rests ? at_rest : decided_, bounds_, tick_s_);
    accel_ = next.accel;
    commanded_ = {next.v, next.w};
    return {static_cast<double>(next.v), static_cast<double>(next.w)};
  }
  [[nodiscard]] motion::MotionStatus status() const noexcept override { return status_; }
  [[nodiscard]] PlanRequest request(const motion::World& world) const noexcept override {
    return {.stamp = world.scan.stamp,
            .map_from_robot = world.map_from_robot,
            .goal_in_map = world.input.goal_in_map,
            .speed_mps = speed_mps_,
            .still = &world.perceived.still,
            .masked = memory_.masked()};
  }
  [[nodiscard]] Duration plan_every() const noexcept override { return std::chrono::milliseconds(90); }

 private:
  Decide decide_;
  motion::MotionBounds bounds_;
  float radius_, tick_s_, tolerance_m_;
  double speed_mps_;
  motion::MoverHistory memory_;  ///< tells walls from pedestrians in the plans that it asks for
  motion::Command decided_, commanded_;
  Time decided_at_ = kNever, seen_ = kNever;
  float accel_ = 0.0F;  ///< of the ramp
  motion::MotionStatus status_;
};

template <BaselineMotion::Decide deciding>
std::unique_ptr<motion::Motion> make(const motion::MotionSetup& setup) {
  return std::make_unique<BaselineMotion>(deciding, setup);
}

}  // namespace

motion::Command none(const Scene& scene) noexcept { return driven_along(scene, way_down(scene), speed_to_goal(scene)); }

motion::MakeMotion maker_of(const std::string& name) noexcept {
  if (name == "none") return make<none>;
  if (name == "replan") return make<replan>;
  if (name == "dwa") return make<dwa>;
  if (name == "orca") return make<orca>;
  return motion::make_motion;
}

cell::Heading way_down(const Scene& scene) noexcept {
  const float left_m = goal_distance(scene);
  cell::Heading best{};
  if (left_m > 1e-3F) best = {(scene.goal.x - scene.now.x) / left_m, (scene.goal.y - scene.now.y) / left_m};
  if (left_m < kAhead_m || !scene.guide.known()) return best;
  float least = Guide::kNoWay_s;
  for (int k = 0; k < kDownDirections; ++k) {
    const cell::Heading d = cell::heading_at(2.0F * cell::kPiF * static_cast<float>(k) / kDownDirections);
    const float x = scene.now.x + kAhead_m * d.x, y = scene.now.y + kAhead_m * d.y;
    const float middle = scene.guide.distance(scene.now.x + 0.5F * kAhead_m * d.x, scene.now.y + 0.5F * kAhead_m * d.y);
    const float to_go = scene.guide.time_to_go(x, y);
    if (middle > 0.8F * scene.radius && to_go < least) least = to_go, best = d;
  }
  return best;
}

float speed_to_goal(const Scene& scene) noexcept {
  return std::min(scene.bounds.speed, std::sqrt(scene.bounds.slowing * goal_distance(scene)));
}

motion::Command driven_along(const Scene& scene, cell::Heading direction, float speed) noexcept {
  const float off = cell::wrapped(cell::angle_of(direction.x, direction.y) - scene.now.heading);
  const float w = std::clamp(off / kArc_s, -scene.bounds.turn, scene.bounds.turn);
  if (std::fabs(off) > 0.5F * cell::kPiF) return {0.0F, w};
  if (std::fabs(off) < 0.05F) return {speed, w};
  const cell::Heading at = cell::heading_at(off);
  return {std::min(speed * off * at.y / (2.0F * (1.0F - at.x)), scene.bounds.speed), w};
}

}  // namespace jaywalk::baseline
