#include "planner/baseline/baseline.h"

#include <algorithm>
#include <cmath>

#include "planner/baseline/way_down.h"

namespace jaywalk::baseline {
namespace {

constexpr Duration kHoldsFor = std::chrono::milliseconds(500);  // as motion::MotionPlanner's, as the limits below
constexpr float kMostTurn = 1.2F, kMostTurnAccel = 2.0F, kSlowing = 0.8F, kMostJerk = 0.75F;
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

motion::Command decided_by(Baseline which, const Scene& scene) noexcept {
  switch (which) {
    case Baseline::kOurs:
    case Baseline::kNone:
      return none(scene);
    case Baseline::kReplan:
      return replan(scene);
    case Baseline::kDwa:
      return dwa(scene);
    case Baseline::kOrca:
      return orca(scene);
  }
  return {};
}

}  // namespace

motion::Command none(const Scene& scene) noexcept { return driven_along(scene, way_down(scene), speed_to_goal(scene)); }

BaselinePlanner::BaselinePlanner(Baseline which, const motion::MotionConfig& config)
    : which_(which),
      bounds_(bounds_of(config.limits)),
      radius_(static_cast<float>(config.footprint.circumscribed_radius_m())),
      tick_s_(static_cast<float>(config.tick_s)),
      tolerance_m_(static_cast<float>(config.goal_tolerance_m)) {}

void BaselinePlanner::decide(const motion::MotionInput& input, const Twist2& driven) noexcept {
  const motion::Seen& seen = input.seen;
  if (!input.has_goal || !seen.guide.known() || !finite(seen.map_from_robot)) return;
  const Scene scene{{static_cast<float>(seen.map_from_robot.x), static_cast<float>(seen.map_from_robot.y),
                     static_cast<float>(seen.map_from_robot.heading), static_cast<float>(driven.v_mps),
                     static_cast<float>(driven.w_radps), 0.0F},
                    {static_cast<float>(input.goal_in_map.x), static_cast<float>(input.goal_in_map.y)},
                    seen.tracks,
                    seen.guide,
                    bounds_,
                    radius_};
  decided_ = decided_by(which_, scene);
  decided_at_ = seen.now;
}

Twist2 BaselinePlanner::twist(Time now, bool has_goal, const Pose2& map_from_robot, Vec2 goal,
                              const Twist2& permitted) noexcept {
  const motion::Command was{static_cast<float>(permitted.v_mps), static_cast<float>(permitted.w_radps)};
  if (std::fabs(was.v - wished_.v) > 1e-4F) accel_ = 0.0F;  // the supervisor has set the speed
  const bool there = distance(map_from_robot.position(), goal) < static_cast<double>(kStopWithin * tolerance_m_);
  const bool rests = !has_goal || there || decided_at_ == kNever || now - decided_at_ > kHoldsFor;
  const motion::RobotState next =
      motion::moved({0.0F, 0.0F, 0.0F, was.v, was.w, accel_}, rests ? motion::Command{} : decided_, bounds_, tick_s_);
  accel_ = next.accel;
  wished_ = {next.v, next.w};
  return {static_cast<double>(next.v), static_cast<double>(next.w)};
}

}  // namespace jaywalk::baseline
