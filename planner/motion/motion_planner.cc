#include "planner/motion/motion_planner.h"

#include <algorithm>
#include <cmath>

namespace jaywalk::motion {
namespace {

constexpr float kLeastGain = 0.15F;  ///< s: another trajectory must be better by this
constexpr int kRounds = 3, kPerturbed = 24;
constexpr std::array<int, 2> kSmoothedOver{3, 8};             ///< steps to either side
constexpr float kKnownBehindM = 0.5F, kBlindBackMps = 0.12F;  ///< docs/decisions/0081, 0083
constexpr double kStopWithin = 2.0 / 3.0;                     ///< of the tolerance
constexpr float kArriveWithin = 0.8F;                         ///< the same, for roll-outs

/// Hands every trajectory that a decision tries to `look`, which keeps the best of them in `best`.
template <class Look>
void search(const Situation& situation, bool constant_speed, std::uint32_t number, const Trajectory& best,
            Trajectory& trial, const Look& look) {
  const Attempts attempts(situation, constant_speed ? situation.body.bounds.speed : 0.0F);
  for (int n = 0; n < attempts.count(); ++n) {
    attempts.make(n, trial);
    look(trial);
  }
  for (int round = 0; round < kRounds; ++round) {
    const Trajectory base = best;
    for (const int half : kSmoothedOver) {
      attempts.smooth(base, half, trial);
      look(trial);
    }
    for (int n = 0; n < kPerturbed; ++n) {
      attempts.perturb(base, number, round, n, trial);
      look(trial);
    }
  }
}

}  // namespace

MotionPlanner::MotionPlanner(const MotionConfig& config)
    : config_(config),
      body_(robot_body(config.footprint, config.limits, config.laser, config.berth_m)),
      futures_(std::make_unique<Futures>()) {}

void MotionPlanner::limit_speed(double most_mps, double driven_mps) noexcept {
  limit_speed_of(body_.bounds, config_.limits, most_mps);
  // At rest it shrinks by its greatest length a second: a pedestrian may step behind the robot.
  const double gained_mps = std::abs(driven_mps) < kRestsMps ? -kKnownBehindM : driven_mps;
  known_behind_m_ = std::clamp(known_behind_m_ + static_cast<float>(gained_mps * config_.tick_s), 0.0F, kKnownBehindM);
  if (known_behind_m_ <= 0.0F && body_.blind.is_behind())
    body_.bounds.back = std::min(body_.bounds.back, kBlindBackMps);
}

bool MotionPlanner::is_there(const Pose2& here, Vec2 goal) const noexcept {
  return !config_.constant_speed && distance(here.position(), goal) < config_.goal_tolerance_m * kStopWithin;
}

void MotionPlanner::decide(const MotionInput& input, const Twist2& driven) noexcept {
  const Seen& seen = input.seen;
  memory_.update(seen);
  if (!input.has_goal || !seen.guide.known() || !finite(seen.map_from_robot)) return;
  ++decision_.number;
  futures_->draw(memory_.beliefs(), memory_.hidden(), memory_.turning(), seen.guide, decision_.number);
  RobotState now{static_cast<float>(seen.map_from_robot.x),
                 static_cast<float>(seen.map_from_robot.y),
                 static_cast<float>(seen.map_from_robot.heading),
                 static_cast<float>(driven.v_mps),
                 static_cast<float>(driven.w_radps),
                 0.0F};
  now = moved(now, {now.v, now.w}, body_.bounds, kLagS);
  now.accel = accel_;
  decision_.start = now;
  const Place goal = {static_cast<float>(input.goal_in_map.x), static_cast<float>(input.goal_in_map.y)};
  if (!(goal == decision_.goal)) stay_.least_to_go_s = 0.0F;  // that was the time to another goal
  decision_.goal = goal;
  decision_.turned = turned_;
  returns_.look(seen.scan, seen.map_from_laser, now, body_, memory_.masked());
  decision_.stay = stay(now, seen.guide, seen.now);
  const Situation situation = this->situation(seen.guide);
  best_cost_ = {.time = 1e9F};
  float to_beat = 1e9F;
  decision_.went_on = decision_.at != kNever && seen.now - decision_.at < kHoldsFor;
  if (decision_.went_on) {
    decision_.last = best_ = shifted(decision_.trajectory, static_cast<float>(to_seconds(seen.now - decision_.at)));
    best_cost_ = judge(situation, best_, 1e9F);
    to_beat = best_cost_.total();
  }
  const Cost last_cost = best_cost_;
  choose(situation);
  if (best_cost_.total() > to_beat - kLeastGain) best_ = decision_.last, best_cost_ = last_cost;
  decision_.at = seen.now;
  decision_.seen = seen.stamp;
  decision_.trajectory = best_;
  decision_.cost = judge(situation, best_, 1e9F, decision_.driven.data());
}

Situation MotionPlanner::situation(const Guide& guide) const noexcept {
  return {body_,
          guide,
          *futures_,
          returns_,
          decision_.start,
          decision_.goal,
          decision_.turned,
          decision_.stay,
          kArriveWithin * static_cast<float>(config_.goal_tolerance_m)};
}

void MotionPlanner::choose(const Situation& situation) noexcept {
  search(situation, config_.constant_speed, decision_.number, best_, trial_, [&](const Trajectory& trial) {
    const Cost cost = judge(situation, trial, best_cost_.total());
    if (cost.total() < best_cost_.total()) best_ = trial, best_cost_ = cost;
  });
}

std::vector<Alternative> MotionPlanner::alternatives(const Guide& guide) const {
  const Situation situation = this->situation(guide);
  std::vector<Alternative> all;
  Trajectory best, trial;
  float least = 1e9F;
  const auto look = [&](const Trajectory& trajectory) {
    Alternative a{trajectory, {}, {}};
    a.cost = judge(situation, trajectory, 1e9F, a.driven.data());
    if (a.cost.total() < least) least = a.cost.total(), best = trajectory;
    all.push_back(a);
  };
  if (decision_.went_on) look(decision_.last);
  search(situation, config_.constant_speed, decision_.number, best, trial, look);
  std::stable_sort(all.begin(), all.end(),
                   [](const Alternative& a, const Alternative& b) { return a.cost.total() < b.cost.total(); });
  return all;
}

Stay MotionPlanner::stay(const RobotState& here, const Guide& guide, Time now) noexcept {
  const std::span<const MoverBelief> beliefs = memory_.beliefs();
  const bool alone = memory_.hidden().empty() &&
                     std::all_of(beliefs.begin(), beliefs.end(), [](const MoverBelief& b) { return b.newcomer; });
  const float to_go = alone ? guide.time_to_go(here.x, here.y) : 0.0F;
  const bool was_alone = stay_.least_to_go_s > 0.0F;
  const bool gets_on = alone && was_alone ? to_go < stay_.least_to_go_s - kGetsOnS : !stay_.holds(here);
  if (stays_since_ == kNever || now < stays_since_ || gets_on) {
    stay_ = {here.x, here.y, here.heading, 0.0F, to_go};
    stays_since_ = now;
  }
  if (alone != was_alone) stay_.least_to_go_s = to_go;
  stay_.for_s = static_cast<float>(to_seconds(now - stays_since_));
  return stay_;
}

Command MotionPlanner::command_at(Time now) const noexcept {
  if (decision_.at == kNever || now - decision_.at > kHoldsFor) return {};
  const auto step = static_cast<int>(to_seconds(now - decision_.at) / static_cast<double>(kStepS));
  return decision_.trajectory.commands[static_cast<std::size_t>(std::clamp(step, 0, kSteps - 1))];
}

Twist2 MotionPlanner::twist(Time now, bool has_goal, const Pose2& map_from_robot, Vec2 goal,
                            const Twist2& permitted) noexcept {
  const Command was{static_cast<float>(permitted.v_mps), static_cast<float>(permitted.w_radps)};
  if (std::fabs(was.v - wished_.v) > 1e-4F) accel_ = 0.0F;  // somebody else has set the speed
  const bool rests = !has_goal || is_there(map_from_robot, goal);
  Command to = rests ? Command{} : within(body_.bounds, command_at(now));
  if (config_.constant_speed && has_goal) to.v = body_.bounds.speed;
  RobotState next =
      moved({0.0F, 0.0F, 0.0F, was.v, was.w, accel_}, to, body_.bounds, static_cast<float>(config_.tick_s));
  if (!config_.constant_speed) next.w = body_.blind.turn_at(next.v, next.w);
  accel_ = next.accel;
  turned_ = turned_side(next.w, turned_);
  if (rests) stays_since_ = kNever;
  wished_ = {next.v, next.w};
  if (rests && std::fabs(next.v) < 1e-6F && std::fabs(next.w) < 1e-6F) return wished_ = {}, Twist2{};
  return {static_cast<double>(next.v), static_cast<double>(next.w)};
}

}  // namespace jaywalk::motion
