#include "planner/motion/footprint_guide.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "planner/motion/body_ahead.h"
#include "planner/motion/pursuit.h"
#include "planner/motion/straight_piece.h"
#include "planner/motion/turned_piece.h"

namespace jaywalk {
namespace {

/// Kept between outline and surfaces: the stop zone's 8 cm, and what a scan's noise makes of them.
constexpr double kMargin_m = 0.10;
/// Where nothing better is found; what the stop zone wants of a robot that creeps.
constexpr double kTightMargin_m = 0.075;
/// A manoeuvre under way is kept while it has this: surfaces move by a centimetre as scans come in.
constexpr double kLeastMargin_m = 0.05;
constexpr Duration kRefused = std::chrono::seconds(1);
constexpr Duration kPatience = std::chrono::seconds(5);  // time that a pedestrian is given to walk on or step aside
constexpr Duration kLookRound = std::chrono::seconds(10);
constexpr Duration kUnfit = std::chrono::milliseconds(450);  // before it takes up more than a way forward
constexpr double kOtherGoal_m = 0.2;
constexpr double kOff_m = 0.12;          // a manoeuvre left by more is given up
constexpr double kAheadOnPath_m = 3.0;   // how far on a manoeuvre is to lead
constexpr double kSetOut_m = 0.6;        // then a scanner at the front has seen what is beside the rear
constexpr std::size_t kSetOutPoses = 4;  // of 0.1 m: less is no way on
constexpr double kBackOut_m = 0.6, kBackOff_m = 0.45;

bool pedestrian_near(const GuideInput& input) {
  const auto near = [&](const auto& one) {
    return distance(one.position_in_map, input.map_from_robot.position()) < motion::kNearby_m;
  };
  return std::any_of(input.standing.begin(), input.standing.end(), near) ||
         std::any_of(input.moving.begin(), input.moving.end(), near);
}

}  // namespace

GuideInput guide_input(const motion::World& world, const KeepOut& keep_out) noexcept {
  return {.path = world.plan.path,
          .map_from_robot = world.map_from_robot,
          .wanted = world.wanted,
          .driven = world.driven,
          .still = world.perceived.still,
          .standing = world.perceived.standing,
          .moving = world.perceived.moving,
          .goal_in_map = world.input.goal_in_map,
          .keep_out = keep_out,
          .pedestrian_hidden = world.perceived.pedestrian_hidden,
          .now = world.now,
          .unseen_walls = world.unseen_walls};
}

FootprintGuide::FootprintGuide(const Footprint& footprint, const MotionLimits& limits)
    : limits_(limits), map_(footprint), reach_(footprint.inscribed_radius_m()), search_(footprint), drive_(limits) {}

void FootprintGuide::update(const GuideInput& input) noexcept {
  note_goal(input.goal_in_map);
  const bool refused = is_refused(input);
  const bool braked_hard = std::exchange(brakes_hard_, false);
  if (input.path.empty()) {
    drive_.stop();
    unfit_.pause();
    return;
  }
  map_.draw(input.still, input.map_from_robot, input.standing, input.moving, input.keep_out, input.unseen_walls);
  if (refused && may_back_off(input)) {
    refused_.forget();
    unfit_.pause();
    back_off(input.map_from_robot);
    return;
  }
  if (keeps_manoeuvre(input)) {
    unfit_.pause();
    return;
  }
  drive_.stop();
  most_speed_mps_ = speed_that_fits(input);
  unfit_.update(most_speed_mps_ == 0.0, input.now);
  if (most_speed_mps_ > 0.0) rounds_ = searches_ = 0;
  if (most_speed_mps_ == 0.0) {
    const BodyAhead ahead{map_, limits_, input.map_from_robot, input.driven};
    brakes_hard_ = !at_rest(input.driven) && (braked_hard || !ahead.stops_in_time());  // to rest, once it has begun
    search(input);
  }
}

/// Whether the supervisor has refused for a while: the surfaces are nearer than the map has them.
bool FootprintGuide::is_refused(const GuideInput& input) noexcept {
  const bool refused =
      input.wanted != Twist2{} && std::fabs(input.driven.v_mps) < 1e-3 && std::fabs(input.driven.w_radps) < 1e-3;
  refused_.update(refused, input.now);
  return refused_.total() >= kRefused;
}

/// What was driven for another goal is not driven on.
void FootprintGuide::note_goal(Vec2 goal_in_map) noexcept {
  if (distance(goal_in_map, goal_in_map_) < kOtherGoal_m) return;
  goal_in_map_ = goal_in_map;
  drive_.stop();
  unfit_.forget();
  refused_.forget();
  rounds_ = searches_ = 0;
}

bool FootprintGuide::keeps_manoeuvre(const GuideInput& input) const noexcept {
  return drive_.active() && drive_.off_by(input.map_from_robot) < kOff_m &&
         drive_.clearance_left(map_) >= drive_.least_kept_m(kLeastMargin_m);
}

double FootprintGuide::speed_that_fits(const GuideInput& input) const noexcept {
  const BodyAhead ahead{map_, limits_, input.map_from_robot, input.driven};
  for (const double share : std::array{1.0, 0.5, 0.25}) {
    const double speed = share * limits_.max_speed_mps;
    if (ahead.follows(input.path, speed, kMargin_m))
      return share == 1.0 ? std::numeric_limits<double>::infinity() : speed;
  }
  return 0.0;
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

/// To the left, and the next time to the right: what is in the way where it does not look may have gone.
void FootprintGuide::look_round(const Pose2& here) noexcept {
  draw_turn(map_, here, rounds_ == 0 ? kLookRound_rad : -kLookRound_rad, kTightMargin_m, back_);
  if (back_.size() > 1) drive_.begin(back_, ManoeuvreDrive::Steering::kFree, ManoeuvreDrive::End::kAtRest);
  ++rounds_;
}

/// Straight back without steering: what is beside the body stays as far as it is.
void FootprintGuide::back_off(const Pose2& here) noexcept {
  draw_straight(map_, here, -kBackOff_m, kTightMargin_m, back_);
  if (back_.size() > 1) drive_.begin(back_, ManoeuvreDrive::Steering::kHeld);
}

/// At once where it has seen what is behind it; else not before a pedestrian there had time to leave.
bool FootprintGuide::may_back_off(const GuideInput& input) const noexcept {
  return refused_.total() >= kPatience || !(input.pedestrian_hidden || unseen_behind(input.map_from_robot, kBackOff_m));
}

bool FootprintGuide::unseen_behind(const Pose2& here, double back_m) const noexcept {
  return map_.goes_unseen(here * Vec2{-back_m, 0.0}, direction(here.heading));
}

/// From where it began nothing beside its rear was ever seen: first straight on, where it sees, and then it turns.
bool FootprintGuide::sets_out_straight(const Pose2& here) noexcept {
  if (std::exchange(has_set_out_, true)) return false;
  draw_straight(map_, here, kSetOut_m, kTightMargin_m, back_);
  if (back_.size() < kSetOutPoses) return false;
  drive_.begin(back_, ManoeuvreDrive::Steering::kHeld);
  return true;
}

void FootprintGuide::search(const GuideInput& input) noexcept {
  if (sets_out_straight(input.map_from_robot)) return;
  const bool stands = std::fabs(input.driven.v_mps) < 0.02 && std::fabs(input.driven.w_radps) < 0.1;
  const ManoeuvreGoal goal = goal_along(input);
  // One search an update: where there is none with room, every fourth is one with less.
  const double margin = ++searches_ % 4 != 0 ? kMargin_m : kTightMargin_m;
  const Manoeuvre& found = search_.find(map_, input.map_from_robot, goal, margin);
  if (found.size() < 2) {
    const Duration patience = pedestrian_near(input) ? kPatience : kUnfit;
    if (unfit_.total() >= patience && stands && unseen_behind(input.map_from_robot, kBackOut_m))
      back_out(input.map_from_robot);
    else if (rounds_ < 2 && unfit_.total() >= (rounds_ + 1) * kLookRound && stands)
      look_round(input.map_from_robot);
    return;
  }
  const bool backs =
      std::any_of(found.begin(), found.end(), [](const auto& step) { return step.gear == Gear::kBackward; });
  if (backs && input.pedestrian_hidden && unfit_.total() < kPatience) return;
  // A robot under way takes up only what goes on forward; for anything else it stops first, and looks again.
  if (!(stands && unfit_.total() >= kUnfit) && found[1].gear != Gear::kForward) return;
  drive_.begin(found);
}

}  // namespace jaywalk
