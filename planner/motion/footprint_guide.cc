#include "planner/motion/footprint_guide.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "planner/motion/pursuit.h"
#include "planner/motion/room.h"
#include "planner/motion/straight_piece.h"

namespace jaywalk {
namespace {

/// Kept between outline and surfaces: the stop zone's 8 cm, and what a scan's noise makes of them.
constexpr double kMargin_m = 0.10;
/// Where nothing better is found; what the stop zone wants of a robot that creeps.
constexpr double kTightMargin_m = 0.075;
/// A manoeuvre under way is kept while it has this: surfaces move by a centimetre as scans come in.
constexpr double kLeastMargin_m = 0.05;
constexpr int kRefusedLooks = 15;  // a second
constexpr int kPatientLooks = 75;  // five: whoever is before it may go on, and whoever is behind it steps aside
constexpr double kNear_m = 2.5;    // of the axle: who is in the way, or of the rider's company
constexpr double kOtherGoal_m = 0.2;
constexpr double kOff_m = 0.12;   // a manoeuvre left by more is given up
constexpr double kAhead_m = 1.6;  // looked at along the path, whatever the speed
constexpr double kAhead_s = 8.0, kStep_s = 0.1;
constexpr double kTouch_m = 0.03;          // to what is known to a centimetre or two
constexpr double kBeforeSlowing_s = 0.25;  // the drives' lag, a tick, and the half of it that jerk takes
constexpr double kStopStep_s = 0.05, kRest_mps = 1e-3;
constexpr int kUnfitLooks = 8;          // before it stops following the path for anything but a way forward
constexpr double kAheadOnPath_m = 3.0;  // how far on a manoeuvre is to lead
constexpr double kBackOut_m = 0.6, kBackOff_m = 0.45;

double toward(double from, double to, double most) { return from + std::clamp(to - from, -most, most); }

/// Half a step before, for the middle of an arc.
Pose2 moved(const Pose2& pose, const Twist2& twist, double dt_s) {
  const Vec2 ahead = direction(pose.heading + 0.5 * twist.w_radps * dt_s);
  return {pose.x + ahead.x * twist.v_mps * dt_s, pose.y + ahead.y * twist.v_mps * dt_s,
          wrap_angle(pose.heading + twist.w_radps * dt_s)};
}

bool somebody_near(const GuideInput& input) {
  const auto near = [&](const auto& one) {
    return distance(one.position_in_map, input.map_from_robot.position()) < kNear_m;
  };
  return std::any_of(input.standing.begin(), input.standing.end(), near) ||
         std::any_of(input.moving.begin(), input.moving.end(), near);
}

}  // namespace

FootprintGuide::FootprintGuide(const Footprint& footprint, const MotionLimits& limits)
    : limits_(limits), map_(footprint), reach_(footprint.inscribed_radius_m()), search_(footprint), drive_(limits) {}

void FootprintGuide::look(const GuideInput& input) noexcept {
  note_goal(input.goal_in_map);
  const bool refused = is_refused(input);
  const bool braked_hard = std::exchange(brakes_hard_, false);
  if (input.path.empty()) {
    drive_.stop();
    return;
  }
  map_.draw(input.still, input.map_from_robot, input.standing, input.moving);
  if (refused && may_back_off(input.map_from_robot)) {
    refused_looks_ = 0;
    back_off(input.map_from_robot);
    return;
  }
  if (keeps_manoeuvre(input)) return;
  drive_.stop();
  most_speed_mps_ = speed_that_fits(input);
  unfit_looks_ = most_speed_mps_ == 0.0 ? unfit_looks_ + 1 : 0;
  if (most_speed_mps_ == 0.0) {
    const bool drives = std::fabs(input.driven.v_mps) > kRest_mps;  // to rest, once it has begun
    brakes_hard_ = drives && (braked_hard || !stops_in_time(input.map_from_robot, input.driven));
    search(input);
  }
}

/// Whether the supervisor has refused for a while: the surfaces are nearer than the map has them.
bool FootprintGuide::is_refused(const GuideInput& input) noexcept {
  const bool refused =
      input.wanted != Twist2{} && std::fabs(input.driven.v_mps) < 1e-3 && std::fabs(input.driven.w_radps) < 1e-3;
  refused_looks_ = refused ? refused_looks_ + 1 : 0;
  return refused_looks_ >= kRefusedLooks;
}

/// What was driven for another goal is not driven on.
void FootprintGuide::note_goal(Vec2 goal_in_map) noexcept {
  if (distance(goal_in_map, goal_in_map_) < kOtherGoal_m) return;
  goal_in_map_ = goal_in_map;
  drive_.stop();
  unfit_looks_ = refused_looks_ = 0;
}

bool FootprintGuide::keeps_manoeuvre(const GuideInput& input) const noexcept {
  return drive_.active() && drive_.off_by(input.map_from_robot) < kOff_m &&
         drive_.clearance_left(map_) >= drive_.least_kept_m(kLeastMargin_m);
}

double FootprintGuide::speed_that_fits(const GuideInput& input) const noexcept {
  for (const double share : std::array{1.0, 0.5, 0.25}) {
    const double speed = share * limits_.max_speed_mps;
    if (fits_following(input, speed)) return share == 1.0 ? std::numeric_limits<double>::infinity() : speed;
  }
  return 0.0;
}

bool FootprintGuide::fits_following(const GuideInput& input, double most_mps) const noexcept {
  Pose2 pose = input.map_from_robot;
  Twist2 twist{std::max(input.driven.v_mps, 0.0), input.driven.w_radps};
  const double at_start = map_.clearance(pose);
  double room = at_start;
  double gone = 0.0;
  for (double t = 0.0; t < kAhead_s && gone < kAhead_m; t += kStep_s) {
    const Steering steering = pursue(input.path, pose, twist.v_mps);
    Twist2 wish{0.0, steering.turn_radps(limits_.max_turn_radps)};
    if (!steering.turns_first()) {
      wish.v_mps = std::min(most_mps, curve_speed(steering.curvature_per_m, limits_.max_turn_radps));
      wish.w_radps = steering.circle_radps(std::max(wish.v_mps, twist.v_mps), limits_.max_turn_radps);
    }
    twist.v_mps = toward(twist.v_mps, wish.v_mps, limits_.max_accel_mps2 * kStep_s);
    twist.w_radps = toward(twist.w_radps, wish.w_radps, limits_.max_turn_accel_radps2 * kStep_s);
    pose = moved(pose, twist, kStep_s);
    gone += twist.v_mps * kStep_s;
    const double least = least_room_m(kMargin_m, at_start, room);
    room = map_.clearance(pose);
    if (room < least) return false;
    if (steering.turns_first() && map_.goes_unseen(pose.position(), direction(pose.heading))) return false;
    if (distance(pose.position(), input.path.back()) < kMargin_m) return true;
  }
  return true;
}

/// Whether the outline of a robot that drives keeps clear on its arc, slowing down within comfort.
bool FootprintGuide::stops_in_time(const Pose2& here, const Twist2& driven) const noexcept {
  const double at_start = map_.clearance(here);
  const double curvature = driven.w_radps / driven.v_mps;
  Pose2 pose = here;
  double v = driven.v_mps, room = at_start;
  for (double t = 0.0; std::fabs(v) > kRest_mps; t += kStopStep_s) {
    if (t >= kBeforeSlowing_s) v = toward(v, 0.0, limits_.max_accel_mps2 * kStopStep_s);
    pose = moved(pose, {v, curvature * v}, kStopStep_s);
    const double least = least_room_m(kTouch_m, at_start, room);
    room = map_.clearance(pose);
    if (room < least) return false;
  }
  return true;
}

/// The point of the path farthest along, within kAheadOnPath_m, that the circle inside the body can get to.
ManoeuvreGoal FootprintGuide::goal_along(const GuideInput& input) noexcept {
  const Path& path = input.path;
  const Vec2 robot = input.map_from_robot.position();
  reach_.settle(map_, robot);
  const std::size_t nearest = nearest_point(path, robot);
  double gone = 0.0;
  std::size_t end = nearest;
  for (std::size_t k = nearest + 1; k < path.size() && gone < kAheadOnPath_m; ++k) {
    gone += distance(path[k - 1], path[k]);
    if (reach_.from(path[k]) < std::numeric_limits<float>::infinity()) end = k;
  }
  const Vec2 along = path[end] - path[end > nearest ? end - 1 : nearest];
  return {path[end], atan2(along.y, along.x), end + 1 == path.size()};
}

/// Where nothing else is left: straight back into what it has not seen, from the place and heading beside its own that
/// leave the most room; then it sees more.
void FootprintGuide::back_out(const Pose2& here) noexcept {
  Pose2 best = here;
  double most = 0.0;
  for (const double turn : std::array{0.0, 0.04, -0.04, 0.08, -0.08}) {
    for (const double aside : std::array{0.0, 0.03, -0.03, 0.06, -0.06, 0.09, -0.09}) {
      const Vec2 place = here * Vec2{0.0, aside};
      const Pose2 pose{place.x, place.y, wrap_angle(here.heading + turn)};
      const double room = map_.clearance(pose);
      if (room > most + 0.005) most = room, best = pose;
    }
  }
  draw_straight(map_, best, -kBackOut_m, kTightMargin_m, back_);
  if (back_.size() > 1) drive_.begin(back_);
}

/// Straight back without steering: whatever is beside the body stays as far as it is.
void FootprintGuide::back_off(const Pose2& here) noexcept {
  draw_straight(map_, here, -kBackOff_m, kTightMargin_m, back_);
  if (back_.size() > 1) drive_.begin(back_, ManoeuvreDrive::Steering::kHeld);
}

/// At once where it has seen what is behind it; else not before whoever is there had time.
bool FootprintGuide::may_back_off(const Pose2& here) const noexcept {
  return refused_looks_ >= kPatientLooks || !unseen_behind(here, kBackOff_m);
}

bool FootprintGuide::unseen_behind(const Pose2& here, double back_m) const noexcept {
  return map_.goes_unseen(here * Vec2{-back_m, 0.0}, direction(here.heading));
}

void FootprintGuide::search(const GuideInput& input) noexcept {
  const bool stands = std::fabs(input.driven.v_mps) < 0.02 && std::fabs(input.driven.w_radps) < 0.1;
  const ManoeuvreGoal goal = goal_along(input);
  // One search a look: where there is none with room, every fourth time one with less.
  const double margin = unfit_looks_ % 4 != 0 ? kMargin_m : kTightMargin_m;
  const Manoeuvre& found = search_.find(map_, input.map_from_robot, goal, margin);
  if (found.size() < 2) {
    const int looks = somebody_near(input) ? kPatientLooks : kUnfitLooks;
    if (unfit_looks_ >= looks && stands && unseen_behind(input.map_from_robot, kBackOut_m))
      back_out(input.map_from_robot);
    return;
  }
  // A robot under way takes up only what goes on forward; for anything else it stops first, and looks again.
  if (!(stands && unfit_looks_ >= kUnfitLooks) && found[1].gear != Gear::kForward) return;
  drive_.begin(found);
}

}  // namespace jaywalk
