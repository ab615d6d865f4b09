#include "planner/motion/leaving_motion.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "hal/types/rest.h"
#include "planner/mapping/surfaces_near.h"

namespace jaywalk::motion {
namespace {

constexpr double kNearby_m = 2.5;                   // of the axle: in the robot's way, or company of its rider
constexpr double kBeside_m = 0.07, kLeft_m = 0.10;  // takes over within the first, lets go beyond the second;
constexpr double kStuckBeside_m = 0.13, kStuckLeft_m = 0.15;  // where to_goal has not moved it for a while
constexpr double kSwing_m = 0.01, kFloor_m = 0.02;            // StopZone's may_creep()
constexpr double kLook_m = 1.0, kStep_m = 0.05;               // an arc's length, and from pose to pose
constexpr double kShortest_m = 0.15;                          // less is no way
constexpr double kCreep_mps = 0.09;                           // of the rim: the supervisor permits 0.1
constexpr double kBack_m = 0.03, kUnseenBack_m = 1.0;         // what going back must be better by; over unseen ground
constexpr double kGoesOn_m = 3.0;                             // the gear changes only where there is no way on
constexpr double kKept_m = 0.005;                             // what another arc must be better by
constexpr double kForgiven_m = 0.05;                          // refused here, an arc may do so far away
constexpr Duration kRefused = std::chrono::milliseconds(700), kStuck = std::chrono::seconds(3);

Pose2 along(const Pose2& from, double curvature_per_m, double length_m) {
  const double turned = curvature_per_m * length_m;
  const Vec2 ahead = direction(from.heading + 0.5 * turned) * length_m;  // the chord: off by less than 1 cm in a metre
  return {from.x + ahead.x, from.y + ahead.y, wrap_angle(from.heading + turned)};
}

}  // namespace

LeavingMotion::LeavingMotion(const MotionSetup& setup, std::unique_ptr<Motion> to_goal)
    : setup_(setup),
      to_goal_(std::move(to_goal)),
      ramp_(setup.model.limits.max_accel_mps2, setup.model.limits.max_jerk_mps3) {}

LeavingMotion::Arc LeavingMotion::arc(int number) noexcept {
  constexpr std::array<double, kBends> kCurvatures{0.0, 0.1, -0.1, 0.2, -0.2, 0.35, -0.35, 0.6, -0.6, 1.0, -1.0};
  return {number < kBends ? 1.0 : -1.0, kCurvatures[static_cast<std::size_t>(number % kBends)]};
}

void LeavingMotion::observe(const World& world, const Intent& intent) noexcept { to_goal_->observe(world, intent); }

Twist2 LeavingMotion::command(const World& world, const Intent& intent) noexcept {
  const Twist2 wanted = to_goal_->command(world, intent);
  if (chosen_ < 0 || intent.kind != Intent::Kind::kGoal) return wanted;
  const Arc arc = LeavingMotion::arc(chosen_);
  const double rim_m = setup_.model.footprint.circumscribed_radius_m();
  if (std::fabs(world.driven.v_mps - ramp_.velocity()) > 1e-6) ramp_.restart_at(world.driven.v_mps);
  const double v = ramp_.toward(arc.sign * kCreep_mps / (1.0 + std::fabs(arc.curvature_per_m) * rim_m), setup_.tick_s);
  return {v, arc.curvature_per_m * v};
}

void LeavingMotion::decide(const World& world, const Intent& intent) noexcept {
  if (world.new_scan) {
    seen_ = world.scan.stamp;
    if (is_called_for(world, intent)) {
      look_round(world);
      choose(world);
    } else {
      chosen_ = -1;
    }
  }
  to_goal_->decide(world, intent);
}

MotionStatus LeavingMotion::status() const noexcept {
  MotionStatus status = to_goal_->status();
  if (chosen_ >= 0) status.rests_on = seen_;
  return status;
}

bool LeavingMotion::is_called_for(const World& world, const Intent& intent) const noexcept {
  const Vec2 here = world.map_from_robot.position();
  const auto near = [&](const Track& track) { return distance(track.position_in_map, here) < kNearby_m; };
  return intent.kind == Intent::Kind::kGoal && world.plan.status != PlanStatus::kNone &&
         (chosen_ >= 0 || is_at_rest(world.driven)) && !to_goal_->status().turns_at_goal &&
         distance(here, world.input.goal_in_map) > setup_.goal_tolerance_m &&
         std::none_of(world.perceived.moving.begin(), world.perceived.moving.end(), near);
}

void LeavingMotion::look_round(const World& world) noexcept {
  const EvidenceMap& still = world.perceived.still;
  surfaces_.clear();
  for_each_surface_near(
      still, world.map_from_robot.position(), setup_.model.footprint.circumscribed_radius_m() + kLook_m + kStuckLeft_m,
      [&](CellIndex cell) { return still.occupied(cell); }, [&](Vec2 p) { (void)surfaces_.push_back(p); });
  for (const Vec2 wall : world.unseen_walls) (void)surfaces_.push_back(world.map_from_robot * wall);
  at_start_m_ = clearance(world.map_from_robot, 0.0);
}

/// Up to 15 cm; anything below `least_m`, if that is where it lies, ends the looking.
double LeavingMotion::clearance(const Pose2& map_from_robot, double least_m) const noexcept {
  const Transform2 robot_from_map(inverse(map_from_robot));
  double nearest = kStuckLeft_m;
  for (const Vec2 surface : surfaces_) {
    nearest = std::min(nearest, setup_.model.footprint.distance_to(robot_from_map * surface));
    if (nearest < least_m) break;
  }
  return nearest;
}

/// Clearance (m) at the end of an arc, less what it is to be better by; below zero where it is no way.
double LeavingMotion::worth(int number, const World& world) const noexcept {
  const Arc arc = LeavingMotion::arc(number);
  const Footprint& body = setup_.model.footprint;
  const EvidenceMap& still = world.perceived.still;
  const KeepOut zones = setup_.keep_out_zones();
  const double least = std::max(at_start_m_ - kSwing_m, std::min(at_start_m_, kFloor_m));
  double reached = 0.0, room = at_start_m_, paid = arc.sign < 0.0 ? kBack_m : 0.0;
  for (double gone = kStep_m; gone <= kLook_m; gone += kStep_m) {
    const Pose2 pose = along(world.map_from_robot, arc.curvature_per_m, arc.sign * gone);
    const double here = clearance(pose, least);
    if (here < least || zones.distance(static_cast<float>(pose.x), static_cast<float>(pose.y)) < 0.0F) break;
    for (const double side : {-body.half_width_m, 0.0, body.half_width_m}) {
      const CellIndex cell = still.cell_at(pose * Vec2{-body.rear_m, side});
      if (arc.sign < 0.0 && !still.seen_free(cell) && !still.occupied(cell)) paid = kUnseenBack_m;
    }
    room = here, reached = gone;
    if (room >= left_m_) break;
  }
  if (reached < kShortest_m && room < left_m_) return -10.0;
  const bool goes_on = chosen_ >= 0 && arc.sign == LeavingMotion::arc(chosen_).sign;
  return room - paid + (goes_on ? kGoesOn_m : 0.0) + (number == chosen_ ? kKept_m : 0.0);
}

void LeavingMotion::choose(const World& world) noexcept {
  const Vec2 here = world.map_from_robot.position();
  stands_.update(chosen_ < 0 && is_at_rest(world.driven), world.now);
  const bool is_stuck = stands_.total() > kStuck;
  if (chosen_ < 0) left_m_ = is_stuck ? kStuckLeft_m : kLeft_m;
  const double beside_m = is_stuck ? kStuckBeside_m : kBeside_m;
  if (at_start_m_ >= (chosen_ < 0 ? beside_m : left_m_)) {
    chosen_ = -1;
    return;
  }
  held_up_.update(chosen_ >= 0 && is_at_rest(world.driven), world.now);
  if (held_up_.total() > kRefused) {
    refused_ |= 1U << chosen_, refused_at_ = here;
    held_up_.forget();
  }
  if (distance(here, refused_at_) > kForgiven_m) refused_ = 0;
  double best = -5.0;
  int found = -1;
  for (int number = 0; number < kArcs; ++number) {
    if ((refused_ >> number & 1U) != 0) continue;
    const double worth = this->worth(number, world);
    if (worth > best + 1e-6) best = worth, found = number;
  }
  chosen_ = found;
}

}  // namespace jaywalk::motion
