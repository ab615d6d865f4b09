#include "planner/motion/stick_rollouts.h"

#include <algorithm>

namespace jaywalk::motion {
namespace {

constexpr float kLeastStickGain = 0.05F;  ///< s: what bends aside does so until another is better by this
constexpr int kStickRounds = 2, kStickPerturbed = 24;
constexpr float kNever_s = 1e9F;

bool rests(const Command& command) { return command.v == 0.0F && command.w == 0.0F; }

/// No faster than asked, and not the other way.
float at_most(float speed, float asked) { return std::clamp(speed, std::min(asked, 0.0F), std::max(asked, 0.0F)); }

}  // namespace

StickRollouts::StickRollouts(const MotionSetup& setup)
    : RolloutMotion(setup), ground_(setup_.keep_out ? setup_.keep_out->view() : KeepOut{}) {}

void StickRollouts::observe(const World& world, const Intent& intent) noexcept {
  RolloutMotion::observe(world, intent);
  const Command asked = stick_command(world.input.stick, body_.bounds);
  status_.rests_on = seen_;
  status_.stick_asks = {static_cast<double>(asked.v), static_cast<double>(asked.w)};
}

const Guide& StickRollouts::ground(const World& world) noexcept {
  return ground_.update(world.perceived.still, world.map_from_robot.position(), memory_.masked());
}

bool StickRollouts::is_to_decide(const World& world, const Intent& intent, const Guide&) noexcept {
  seen_ = world.scan.stamp;
  asked_ = body_.blind.slowed(stick_command(intent.stick, body_.bounds));
  if (is_assisted() && !rests(asked_)) return true;
  decision_.at = kNever;
  return false;
}

void StickRollouts::choose(const World& world, const Guide& ground) noexcept {
  const StickRollout way = roll_out_stick(decision_.start, asked_, body_.bounds);
  const Situation situation{body_, ground, *futures_, returns_, decision_.start, {}, 0.0F, {}, 0.0F, &way};
  best_cost_ = kNever_s;
  best_shape_ = {};
  for (int n = 0; n < shape_count(); ++n) try_shape(situation, shape_at(n, body_.bounds));
  for (int round = 0; round < kStickRounds; ++round) {
    const StickShape base = best_shape_;
    for (int n = 0; n < kStickPerturbed; ++n)
      try_shape(situation, perturbed(base, decision_.number, round, n, body_.bounds));
  }
  const bool is_wish = best_shape_.aside == 0.0F && best_shape_.share == 1.0F && best_shape_.turn_share == 1.0F;
  if (holds(world.now) && !is_wish) {
    trial_ = rest_of_decision(world.now);
    if (trajectory_cost(situation, trial_, best_cost_ + kLeastStickGain).total() < best_cost_ + kLeastStickGain)
      best_ = trial_;
  }
  decision_.trajectory = best_;
}

void StickRollouts::try_shape(const Situation& situation, const StickShape& shape) noexcept {
  make(shape, situation.stick->command, situation.start, body_.bounds, trial_);
  const float cost = trajectory_cost(situation, trial_, best_cost_).total();
  if (cost < best_cost_) best_ = trial_, best_shape_ = shape, best_cost_ = cost;
}

RolloutMotion::Next StickRollouts::next(const World& world, const Intent& intent, const RobotState& now) noexcept {
  const Command asked = stick_command(intent.stick, body_.bounds);
  const Command decided = command_at(world.now);
  const Command to = is_assisted() ? within(body_.bounds, {at_most(decided.v, asked.v), decided.w}) : asked;
  const bool stops = rests(asked) || rests(to);
  return {stops ? slowed(now, body_.bounds, tick_s()) : moved(now, to, body_.bounds, tick_s()), stops};
}

}  // namespace jaywalk::motion
