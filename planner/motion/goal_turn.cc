#include "planner/motion/goal_turn.h"

#include <algorithm>
#include <cmath>

#include "hal/types/rest.h"
#include "planner/motion/least_clearance.h"
#include "planner/motion/straight_piece.h"
#include "planner/motion/turned_piece.h"
#include "planner/motion/twist_ramp.h"

namespace jaywalk {
namespace {

/// Kept between outline and surfaces; where that is not to be had, what the stop zone wants of a body that creeps.
constexpr std::array kMargins_m{0.10, 0.075};
/// A way or a manoeuvre under way is kept while it has this: surfaces move by a centimetre as scans come in.
constexpr double kLeastMargin_m = 0.045;
constexpr double kLeft_m = 0.12;         // a manoeuvre left by more is given up
constexpr double kOff_m = 0.45;          // straight away from where the supervisor refuses
constexpr double kLook_rad = 0.06;       // between two looks at the outline: 5 cm of a wheelchair's foremost corner
constexpr double kTurnGain_per_s = 2.0;  // as Steering::turn_radps()
constexpr double kSettled = 1.0 / 3.0;   // of the heading's tolerance: close enough to stand still
constexpr Duration kRefused = std::chrono::seconds(1), kLeftAlone = std::chrono::seconds(10);
constexpr Duration kGiveUp = std::chrono::seconds(1);
constexpr Duration kPatience = std::chrono::seconds(5), kLookRound = std::chrono::seconds(10);  // as the guide's
constexpr Duration kSearchEvery = std::chrono::milliseconds(500);                               // while it is blocked
constexpr double kClosest_rad = 0.07;  // what a search's steps of headings can promise

/// To the same heading the other way round.
double long_way(double turn_rad) { return turn_rad > 0.0 ? turn_rad - 2.0 * kPi : turn_rad + 2.0 * kPi; }

}  // namespace

GoalTurn::GoalTurn(const Footprint& footprint, const MotionLimits& limits, bool is_nearly_round)
    : limits_(limits), is_nearly_round_(is_nearly_round), map_(footprint), search_(footprint), drive_(limits) {}

void GoalTurn::aim(const OperatorInput& input, const Pose2& here, const Twist2& driven) noexcept {
  const bool same_goal = input.goal_in_map == input_.goal_in_map && input.goal_heading_rad == input_.goal_heading_rad;
  if (!input.wants_heading() || !same_goal) active_ = false;
  input_ = input;
  driven_ = driven;
  if (!input.wants_heading()) return;
  to_go_rad_ -= wrap_angle(here.heading - heading_before_);
  heading_before_ = here.heading;
  const bool near = distance(here.position(), input.goal_in_map) <= input.goal_tolerance_m;
  if (near && !drive_.active()) away_ = false;
  if (active_) {
    active_ = near || away_;
  } else if (arrives(here)) {
    begin();
  }
}

bool GoalTurn::arrives(const Pose2& here) const noexcept {
  const double near_m = input_.goal_tolerance_m * (is_at_rest(driven_) ? 1.0 : kStopWithin);
  return distance(here.position(), input_.goal_in_map) <= near_m;
}

void GoalTurn::begin() noexcept {
  active_ = true;
  settled_ = blocked_ = chosen_ = away_ = false;
  drive_.stop();
  refused_until_ = {kNever, kNever};
  refused_.forget();
  note_found();
  off_m_ = kOff_m;
}

Twist2 GoalTurn::command(const Pose2& here) noexcept {
  if (away_) return {};
  const double error = std::fabs(input_.heading_error_rad(here));
  settled_ = error <= input_.goal_heading_tolerance_rad * (settled_ ? 1.0 : kSettled);
  if (settled_ || blocked_ || !chosen_ || std::fabs(driven_.v_mps) > kAtRest_mps) return {};
  const double angle = std::fabs(to_go_rad_);
  const double most = std::min(limits_.max_turn_radps, slowing_speed(0.0, angle, limits_.max_turn_accel_radps2));
  return {0.0, std::copysign(std::min(kTurnGain_per_s * angle, most), to_go_rad_)};
}

void GoalTurn::update(const GuideInput& input) noexcept {
  pedestrian_hidden_ = input.pedestrian_hidden;
  now_ = input.now;
  const bool refused = is_refused(input);
  if (settled_) return waited_.pause();
  map_.draw(input.still, input.map_from_robot, input.standing, input.moving, input.keep_out, input.unseen_walls);
  if (goes_on(input, refused)) return waited_.pause();
  if (refused && !drive_.active()) refused_until(to_go_rad_) = now_ + kLeftAlone;
  if (refused) searches_ = 0;
  drive_.stop();
  if (away_) {
    seek_back(input.map_from_robot, refused);
  } else {
    seek(input.map_from_robot);
  }
}

/// At the goal: a way to turn, else a manoeuvre.
void GoalTurn::seek(const Pose2& here) noexcept {
  chosen_ = choose_way(here);
  waited_.update(!chosen_, now_);
  if (chosen_) note_found();
  const bool searches =
      !chosen_ && age(searched_at_, now_) >= kSearchEvery && (!pedestrian_hidden_ || waited_.total() > kPatience);
  if (searches) searched_at_ = now_;
  blocked_ = !chosen_ && !(searches && !has_room(here) && search(here)) && !look_round(here);
}

void GoalTurn::note_found() noexcept {
  waited_.forget();
  rounds_ = 0;
  searched_at_ = kNever;
}

/// After ten seconds to the left, after twenty to the right, as far as it can: what is in the way where it does not
/// look may have gone.
bool GoalTurn::look_round(const Pose2& here) noexcept {
  if (rounds_ == 2 || waited_.total() < (rounds_ + 1) * kLookRound) return false;
  draw_turn(map_, here, rounds_++ == 0 ? kLookRound_rad : -kLookRound_rad, kMargins_m[1], straight_);
  if (straight_.size() < 2) return false;
  drive_.begin(straight_, ManoeuvreDrive::Steering::kFree, ManoeuvreDrive::End::kAtRest);
  return true;
}

/// Out of a manoeuvre that could not be driven to its end: another from here, or else the path. Where the supervisor
/// has refused, surfaces are nearer than the map has them: first straight off, back or ahead in turns.
void GoalTurn::seek_back(const Pose2& here, bool refused) noexcept {
  if (refused) {
    off_m_ = -off_m_;
    draw_off(here, off_m_);
    if (straight_.size() < 2) draw_off(here, -off_m_);
    if (straight_.size() > 1) {
      drive_.begin(straight_, ManoeuvreDrive::Steering::kHeld, ManoeuvreDrive::End::kAtRest);
      return;
    }
  }
  const bool found = search(here);
  waited_.update(!found, now_);
  if (found) note_found();
  away_ = waited_.total() < kGiveUp;
}

/// Not back into what it has not seen, nor where a pedestrian may be.
void GoalTurn::draw_off(const Pose2& here, double off_m) noexcept {
  straight_.clear();
  const bool backs = off_m < 0.0;
  if (backs && (pedestrian_hidden_ || map_.goes_unseen(here * Vec2{off_m, 0.0}, direction(here.heading)))) return;
  draw_straight(map_, here, off_m, kMargins_m[1], straight_);
}

/// Whether what is under way is kept.
bool GoalTurn::goes_on(const GuideInput& input, bool refused) const noexcept {
  if (refused) return false;
  const Pose2& here = input.map_from_robot;
  if (!drive_.active()) return chosen_ && fits(here, to_go_rad_, kLeastMargin_m);
  return drive_.off_by(here) < kLeft_m && drive_.clearance_left(map_) >= drive_.least_kept_m(kLeastMargin_m);
}

/// Whether the supervisor has refused for a while, or as good as.
bool GoalTurn::is_refused(const GuideInput& input) noexcept {
  const bool refused = input.wanted != Twist2{} && is_at_rest(input.driven);
  refused_.update(refused, now_);
  if (refused_.total() < kRefused) return false;
  refused_.forget();
  return true;
}

/// The short way before the long one, and each with room before either with little.
bool GoalTurn::choose_way(const Pose2& here) noexcept {
  const double error = input_.heading_error_rad(here);
  for (const double margin : kMargins_m) {
    for (const double turn : std::array{error, long_way(error)}) {
      if (now_ < refused_until(turn) || !fits(here, turn, margin)) continue;
      to_go_rad_ = turn;
      return true;
    }
  }
  return false;
}

/// Whether there is room for the short way or the long one, and only a pedestrian stands there.
bool GoalTurn::has_room(const Pose2& here) const noexcept {
  const double error = input_.heading_error_rad(here);
  return fits(here, error, kMargins_m[0]) || fits(here, long_way(error), kMargins_m[0]);
}

/// Whether the outline keeps `margin_m` all the way round, or from what is nearer at the start comes no nearer.
bool GoalTurn::fits(const Pose2& here, double turn_rad, double margin_m) const noexcept {
  const int looks = static_cast<int>(std::fabs(turn_rad) / kLook_rad) + 1;
  const double at_start = map_.clearance(here);
  double room = at_start;
  for (int k = 1; k <= looks; ++k) {
    const Vec2 ahead = direction(here.heading + turn_rad * k / looks);
    const double least = least_clearance_m(margin_m, at_start, room);
    room = map_.clearance(here.position(), ahead, least);
    if (room < least || (!is_nearly_round_ && map_.goes_unseen(here.position(), ahead))) return false;
  }
  return true;
}

/// From here to the goal with its heading. The margins take turns: where there is no way with room, there may be one
/// with less; and from where the supervisor has refused to go on, which is closer than it wants, with room is away.
bool GoalTurn::search(const Pose2& here) noexcept {
  const ManoeuvreGoal goal{.position_in_map = input_.goal_in_map,
                           .heading = input_.goal_heading_rad,
                           .within_m = std::min(ManoeuvreGoal{}.within_m, kStopWithin * input_.goal_tolerance_m),
                           .within_rad = std::max(kClosest_rad, input_.goal_heading_tolerance_rad * kSettled)};
  const Manoeuvre& found = search_.find(map_, here, goal, kMargins_m[searches_++ % kMargins_m.size()]);
  if (found.size() < 2) return false;
  drive_.begin(found, ManoeuvreDrive::Steering::kFree, ManoeuvreDrive::End::kAtRest);
  away_ = true;
  return true;
}

}  // namespace jaywalk
