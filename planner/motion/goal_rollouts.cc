#include "planner/motion/goal_rollouts.h"

#include <algorithm>
#include <cmath>

#include "hal/types/wheels.h"

namespace jaywalk::motion {
namespace {

constexpr float kLeastGain = 0.15F;  ///< s: another trajectory must be better by this
constexpr int kRounds = 3, kPerturbed = 24;
constexpr std::array<int, 2> kSmoothedOver{3, 8};  ///< steps to either side
constexpr double kStopWithin = 2.0 / 3.0;          ///< of the tolerance
constexpr double kStandWithin = 0.9;               ///< the same, where it has come to rest already
constexpr float kArriveWithin = 0.8F;  ///< the same: a roll-out has arrived. With a heading wanted it must come nearer:
constexpr float kTurnWithin = 0.6F;
constexpr float kFacesShare = 1.0F / 3.0F;  ///< of the heading's tolerance: it turns so near
constexpr float kTurnBlocked_s = 5.0F;      ///< without progress, at the goal
/// s, between two decisions. No robot gains or loses so much by driving: the map, or what stands on it, has changed,
/// and its way has not. Counted as a stall, a dead end made the robot impatient all the way out of it: a loop in 5 of
/// 32 runs (16 movers, maps 1 to 4, seeds 9400 to 9431), in none without.
constexpr float kMapChanges_s = 1.0F;
constexpr Duration kGuideHoldsFor = std::chrono::seconds(1);  ///< as the supervisor's longest age of a plan

/// Hands every trajectory that a decision tries to `look`, which keeps the best of them in `best`.
template <class Look>
void try_all(const Situation& situation, bool constant_speed, std::uint32_t number, const Trajectory& best,
             Trajectory& trial, const Look& look) {
  const TrajectoryProposals proposals(situation, constant_speed ? situation.body.bounds.speed : 0.0F);
  proposals.each(trial, look);
  for (int round = 0; round < kRounds; ++round) {
    const Trajectory base = best;
    for (const int half : kSmoothedOver) {
      proposals.smooth(base, half, trial);
      look(trial);
    }
    for (int n = 0; n < kPerturbed; ++n) {
      proposals.perturb(base, number, round, n, trial);
      look(trial);
    }
  }
}

}  // namespace

void GoalRollouts::observe(const World& world, const Intent& intent) noexcept {
  RolloutMotion::observe(world, intent);
  known_behind_.drive(static_cast<float>(world.driven.v_mps), tick_s());
  body_.bounds = known_behind_.limited(body_.bounds);
  const bool lost = setup_.constant_speed && world.plan.status != PlanStatus::kOk;  // it does not slow down by itself
  stands_there_ = intent.kind == Intent::Kind::kGoal && is_there(world);
  const bool near = distance(world.map_from_robot.position(), world.input.goal_in_map) < setup_.goal_tolerance_m;
  status_.turns_at_goal = !setup_.constant_speed && world.input.wants_heading() && near && !stands_there_;
  status_.turn_blocked = status_.turns_at_goal && decision_.stall.for_s > kTurnBlocked_s;
  status_.rests_on = lost ? kNever : std::min(decision_.seen, world.plan.stamp);
}

bool GoalRollouts::is_there(const World& world) const noexcept {
  if (setup_.constant_speed) return false;
  const RobotState now = state_of(world, accel_);
  const auto rests_within = [&](double share) {
    const auto within_m = static_cast<float>(share * setup_.goal_tolerance_m);
    return rests_near(now, static_cast<float>(world.input.goal_in_map.x), static_cast<float>(world.input.goal_in_map.y),
                      within_m, stands_there_ ? within_m : kRestsBefore_m, body_.bounds);
  };
  if (!world.input.wants_heading()) return rests_within(kStopWithin);
  const double off_rad = std::fabs(world.input.heading_error_rad(world.map_from_robot));
  // Once it stands there, a pose that sways within the tolerances moves nothing.
  const double within = stands_there_ ? 1.0 : is_at_rest(world.driven) ? kStandWithin : kStopWithin;
  return rests_within(within) && off_rad < world.input.goal_heading_tolerance_rad * within;
}

bool GoalRollouts::is_to_decide(const World& world, const Intent& intent, const Guide& ground) noexcept {
  return intent.kind == Intent::Kind::kGoal && age(world.plan.stamp, world.now) < kGuideHoldsFor && ground.known();
}

void GoalRollouts::choose(const World& world, const Guide& guide) noexcept {
  const Place goal = {static_cast<float>(world.input.goal_in_map.x), static_cast<float>(world.input.goal_in_map.y)};
  if (!(goal == decision_.goal)) stalled_since_ = kNever;  // that was the time to another goal
  decision_.goal = goal;
  decision_.turned = turned_;
  decision_.known_behind = known_behind_;
  decision_.wants_heading = !setup_.constant_speed && world.input.wants_heading();
  decision_.goal_heading = decision_.wants_heading ? static_cast<float>(world.input.goal_heading_rad) : 0.0F;
  decision_.faces_rad =
      std::min(price::kFacesRad, kFacesShare * static_cast<float>(world.input.goal_heading_tolerance_rad));
  Situation situation = this->situation(guide, world.plan.poses);
  note_progress(situation, world.now);
  situation.stall = decision_.stall;
  Trajectory best, trial;
  Cost least{.time = 1e9F, .hit_share = 1.0F}, to_beat = least;
  decision_.went_on = holds(world.now);
  if (decision_.went_on) {
    decision_.last = best = rest_of_decision(world.now);
    to_beat = least = trajectory_cost(situation, best, 1e9F);
  }
  try_all(situation, setup_.constant_speed, decision_.number, best, trial, [&](const Trajectory& tried) {
    const Cost cost = trajectory_cost(situation, tried, least.is_safe() ? least.total() : 1e9F);
    if (cost.is_better_than(least)) best = tried, least = cost;
  });
  if (decision_.went_on && !least.is_better_than(to_beat, kLeastGain)) best = decision_.last;
  decision_.trajectory = best;
  decision_.cost = trajectory_cost(situation, best, 1e9F, decision_.driven.data());
}

Situation GoalRollouts::situation(const Guide& guide, const PoseGuide& poses) const noexcept {
  const float within = decision_.wants_heading ? kTurnWithin : kArriveWithin;
  return {decision_,       body_,
          guide,           *futures_,
          returns_,        within * static_cast<float>(setup_.goal_tolerance_m),
          nullptr,         setup_.constant_speed ? nullptr : &poses,
          conflict_price()};
}

std::vector<Alternative> GoalRollouts::alternatives(const Plan& plan) const {
  const Situation situation = this->situation(plan.guide, plan.poses);
  std::vector<Alternative> all;
  Trajectory best, trial;
  Cost least{.time = 1e9F, .hit_share = 1.0F};
  const auto look = [&](const Trajectory& trajectory) {
    Alternative a{trajectory, {}, {}};
    a.cost = trajectory_cost(situation, trajectory, 1e9F, a.driven.data());
    if (a.cost.is_better_than(least)) least = a.cost, best = trajectory;
    all.push_back(a);
  };
  if (decision_.went_on) look(decision_.last);
  try_all(situation, setup_.constant_speed, decision_.number, best, trial, look);
  std::stable_sort(all.begin(), all.end(),
                   [](const Alternative& a, const Alternative& b) { return a.cost.is_better_than(b.cost); });
  return all;
}

/// As many seconds as waiting would take to bring about a conflict: the busier the place, the less it gains.
float GoalRollouts::conflict_price() const noexcept {
  float walked_mps = 0.0F;
  for (const MoverBelief& b : memory_.beliefs()) {
    const float dx = b.x - decision_.start.x, dy = b.y - decision_.start.y;
    const bool walks = b.is_pedestrian && !b.has_stood();
    if (walks && dx * dx + dy * dy < price::kAboutM * price::kAboutM) walked_mps += b.usual_mps;
  }
  walked_mps += 0.5F * static_cast<float>(memory_.hidden().size()) * memory_.turning().usual_mps;
  const float met_hz = walked_mps * price::kMetWidthM / (cell::kPiF * price::kAboutM * price::kAboutM);
  return std::clamp(1.0F / std::max(met_hz, 1e-3F), price::kLeastConflict, price::kConflict);
}

void GoalRollouts::note_progress(const Situation& situation, Time now) noexcept {
  StallState& stall = decision_.stall;
  const bool is_new = stalled_since_ == kNever || now < noted_;
  const auto since_s = static_cast<float>(is_new ? 0.0 : std::min(1.0, to_seconds(now - noted_)));
  noted_ = now;
  note_turning(situation.start, since_s);
  const float to_go_s = situation.time_to_go(decision_.start), rise_s = to_go_s - to_go_s_;
  const bool map_changed = std::fabs(rise_s) > kMapChanges_s;
  if (map_changed) stall.least_to_go_s += rise_s;
  to_go_s_ = to_go_s;
  const float lost_s = stall.lost_s + since_s - price::kWonBack * (map_changed ? 0.0F : -rise_s);
  stall.lost_s = is_new ? 0.0F : std::clamp(lost_s, 0.0F, price::kMostLostS);
  if (is_new || stall.gets_on(to_go_s)) {
    stall.least_to_go_s = to_go_s;
    stall.wound_rad = 0.0F;
    stalled_since_ = now;
  }
  const std::span<const MoverBelief> beliefs = memory_.beliefs();
  stall.is_alone = memory_.hidden().empty() &&
                   std::all_of(beliefs.begin(), beliefs.end(), [](const MoverBelief& b) { return b.newcomer; });
  stall.for_s = static_cast<float>(to_seconds(now - stalled_since_));
}

/// A robot at rest forgets how far it has turned: to turn on is then no circle.
void GoalRollouts::note_turning(const RobotState& now, float since_s) noexcept {
  StallState& stall = decision_.stall;
  const float wound = stall.wound_rad + cell::wrapped(now.heading - heading_);
  const bool rests = std::fabs(now.v) < kRestsMps && std::fabs(now.w) < kRestsMps;
  const float forgotten = rests ? price::kUnwindsRadps * since_s : 0.0F;
  stall.wound_rad = std::copysign(std::max(0.0F, std::fabs(wound) - forgotten), wound);
  heading_ = now.heading;
}

RolloutMotion::Next GoalRollouts::next(const World& world, const Intent& intent, const RobotState& now) noexcept {
  const bool has_goal = intent.kind == Intent::Kind::kGoal, rests = !has_goal || stands_there_;
  Command to = rests ? Command{} : within(body_.bounds, command_at(world.now));
  if (setup_.constant_speed && has_goal) to.v = body_.bounds.speed;
  RobotState next = moved(now, to, body_.bounds, tick_s());
  if (!setup_.constant_speed) next.w = body_.blind.turn_at(next.v, next.w);
  if (returns_.is_beside() && to.v != 0.0F) {  // a turn that comes before its speed would swing a corner into it
    const float most = std::fabs(to.w / to.v * next.v);
    next.w = std::clamp(next.w, -most, most);
  }
  turned_ = turned_side(next.w, turned_);
  if (rests) stalled_since_ = kNever;
  return {next, rests};
}

}  // namespace jaywalk::motion
