#include "planner/motion/rollout_motion.h"

#include <algorithm>
#include <cmath>

namespace jaywalk::motion {
namespace {

constexpr float kRoomToTurn = 2.5F;  // times (circumscribed less inscribed radius), beyond the circumscribed circle

}  // namespace

RolloutMotion::RolloutMotion(const MotionSetup& setup)
    : setup_(setup),
      body_(robot_body(setup.model.footprint, setup.model.limits, setup.model.lasers(), setup.comfort_distance_m)),
      futures_(std::make_unique<Futures>()) {}

void RolloutMotion::observe(const World&, const Intent& intent) noexcept {
  limit_speed_of(body_.bounds, setup_.model.limits, intent.most_mps);
}

void RolloutMotion::decide(const World& world, const Intent& intent) noexcept {
  if (!world.new_scan || !finite(world.map_from_robot)) return;
  const SeenFrom newest = world.newest();
  const OfEach<SeenFrom> scans(newest, world.other_scans);
  const Perceived& seen = world.perceived;
  memory_.update(
      {world.now, world.map_from_robot, seen.tracks, seen.standing, seen.still, scans, ground_before(world)});
  const Guide& ground = this->ground(world);
  if (!is_to_decide(world, intent, ground)) return;
  ++decision_.number;
  futures_->draw(memory_.beliefs(), memory_.hidden(), memory_.turning(), ground, decision_.number);
  const RobotState now = state_of(world);
  decision_.start = moved(now, {now.v, now.w}, body_.bounds, kLagS);  // as the wheels follow what is decided now
  decision_.start.accel = accel_;
  decision_.start.braked = braked_;
  place_unseen_walls(world);
  returns_.update(scans, decision_.start, body_, memory_.masked(), {unseen_walls_.begin(), unseen_walls_.size()});
  choose(world, ground);
  decision_.at = world.now;
  decision_.seen = world.scan.stamp;
}

RobotState state_of(const World& world, float accel) noexcept {
  const Pose2& here = world.map_from_robot;
  return {static_cast<float>(here.x),
          static_cast<float>(here.y),
          static_cast<float>(here.heading),
          static_cast<float>(world.driven.v_mps),
          static_cast<float>(world.driven.w_radps),
          accel};
}

/// The supervisor supposes them where no laser looks; the robot may back or turn into them.
void RolloutMotion::place_unseen_walls(const World& world) noexcept {
  unseen_walls_.clear();
  const Transform2 map_from_robot(world.map_from_robot);
  for (const Vec2 wall : world.unseen_walls) {
    if (!unseen_walls_.push_back(map_from_robot * wall)) return;
  }
}

Command RolloutMotion::command_at(Time now) const noexcept {
  if (decision_.at == kNever || now - decision_.at > kHoldsFor) return {};
  const auto step = static_cast<int>(to_seconds(now - decision_.at) / static_cast<double>(kStepS));
  return decision_.trajectory.commands[static_cast<std::size_t>(std::clamp(step, 0, kSteps - 1))];
}

Twist2 RolloutMotion::command(const World& world, const Intent& intent) noexcept {
  const Command was{static_cast<float>(world.driven.v_mps), static_cast<float>(world.driven.w_radps)};
  if (std::fabs(was.v - commanded_.v) > 1e-4F) accel_ = braked_ = 0.0F;  // the supervisor or another motion has set it
  const Next next = this->next(world, intent, {0.0F, 0.0F, 0.0F, was.v, was.w, accel_});
  accel_ = next.robot.accel;
  braked_ = next.robot.braked;
  commanded_ = {next.robot.v, next.robot.w};
  if (next.rests && std::fabs(commanded_.v) < 1e-6F && std::fabs(commanded_.w) < 1e-6F) commanded_ = {};
  return {static_cast<double>(commanded_.v), static_cast<double>(commanded_.w)};
}

PlanRequest RolloutMotion::request(const World& world) const noexcept {
  return {.stamp = world.scan.stamp,
          .map_from_robot = world.map_from_robot,
          .goal_in_map = world.input.goal_in_map,
          .speed_mps = setup_.model.limits.max_speed_mps,
          .still = &world.perceived.still,
          .standing = memory_.standing(),
          .masked = memory_.masked(),
          .poses = poses_asked(world)};
}

/// Whether a turn could bring a corner near a surface: for a long body nearly everywhere. Elsewhere the time to go from
/// places is enough, since the robot turns on the spot.
bool RolloutMotion::heading_counts(const World& world) const noexcept {
  const Guide& guide = world.plan.guide;
  const Vec2 here = world.map_from_robot.position();
  const float corners_m = body_.rim_m - static_cast<float>(setup_.model.footprint.inscribed_radius_m());
  const float turns_in_m = body_.rim_m + kRoomToTurn * corners_m;
  return !guide.known() || guide.room(static_cast<float>(here.x), static_cast<float>(here.y)) < turns_in_m;
}

PoseRequest RolloutMotion::poses_asked(const World& world) const noexcept {
  const MotionBounds& b = body_.bounds;
  const float spot = std::fabs(body_.blind.slowed({0.0F, std::min(b.turn, price::kTurnAtGoalRadps)}).w);
  return {.is_asked = !setup_.constant_speed && heading_counts(world),
          .speeds = {.forward = b.speed, .back = b.back, .turn = b.turn, .spot = spot},
          .arrives_m = 0.5F * static_cast<float>(setup_.goal_tolerance_m),
          .wants_heading = world.input.wants_heading(),
          .heading = world.input.wants_heading() ? static_cast<float>(world.input.goal_heading_rad) : 0.0F,
          .unseen_walls = {unseen_walls_.begin(), unseen_walls_.size()}};
}

}  // namespace jaywalk::motion
