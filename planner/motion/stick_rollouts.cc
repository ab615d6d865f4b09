#include "planner/motion/stick_rollouts.h"

#include <algorithm>
#include <cmath>

#include "planner/cell/draws.h"

namespace jaywalk::motion {
namespace {

constexpr float kLeastStickGain = 0.05F;  ///< s: what bends aside does so until another is better by this
constexpr int kStickRounds = 2, kStickPerturbed = 24;
constexpr std::uint32_t kStickPurpose = 4;  ///< of the draws

bool rests(const Command& command) { return command.v == 0.0F && command.w == 0.0F; }

/// No faster than asked, and not the other way.
float at_most(float speed, float asked) { return std::clamp(speed, std::min(asked, 0.0F), std::max(asked, 0.0F)); }

Command command_of(const StickShape& shape, const Command& asked, float step, const MotionBounds& bounds) {
  const float back_until = shape.aside_steps * (1.0F + shape.back);
  const float aside = step < shape.aside_steps ? shape.aside : step < back_until ? -shape.aside : 0.0F;
  return {shape.share * asked.v, std::clamp(shape.turn_share * asked.w + aside, -bounds.turn, bounds.turn)};
}

/// A tick of slowing down to rest, on the arc that the robot is on.
RobotState slowed(const RobotState& from, const MotionBounds& bounds, float dt) {
  constexpr float kRests_mps = 1e-3F;
  RobotState s = moved(from, {}, bounds, dt);
  const float on_arc = std::fabs(from.v) > kRests_mps ? from.w * s.v / from.v : 0.0F;
  if (std::fabs(on_arc) > std::fabs(s.w)) s.w = on_arc;
  return s;
}

}  // namespace

Command stick_command(const Stick& stick, const MotionBounds& bounds) noexcept {
  if (!std::isfinite(stick.forward) || !std::isfinite(stick.left)) return {};
  const auto forward = static_cast<float>(std::clamp(stick.forward, -1.0, 1.0));
  const auto left = static_cast<float>(std::clamp(stick.left, -1.0, 1.0));
  return {forward * (forward > 0.0F ? bounds.speed : bounds.back), left * bounds.turn};
}

StickRollout roll_out_stick(const RobotState& start, const Command& command, const MotionBounds& bounds) noexcept {
  StickRollout way{};
  RobotState robot = start;
  for (RobotState& state : way) state = robot = moved(robot, command, bounds, kStepS);
  return way;
}

void make(const StickShape& shape, const Command& asked, const RobotState& start, const MotionBounds& bounds,
          Trajectory& out) noexcept {
  out.proposal = Proposal::kStick;
  out.perturbed = false;
  RobotState robot = start;
  for (int step = 0; step < kStickSteps; ++step) {
    const auto at = static_cast<float>(step);
    Command& command = out.commands[static_cast<std::size_t>(step)];
    if (at < shape.steps) {
      command = command_of(shape, asked, at, bounds);
      robot = moved(robot, command, bounds, kStepS);
    } else {
      robot = slowed(robot, bounds, kStepS);
      command = {0.0F, robot.w};
    }
  }
  std::fill(out.commands.begin() + kStickSteps, out.commands.end(), Command{});
}

StickShape perturbed(const StickShape& shape, std::uint32_t decision, int round, int number,
                     const MotionBounds& bounds) noexcept {
  constexpr auto kMost = static_cast<float>(kFollowedSteps);
  cell::Draws draws({decision, kStickPurpose, static_cast<std::uint32_t>(round), static_cast<std::uint32_t>(number)});
  return {.share = std::clamp(shape.share + 0.25F * draws.normal(), 0.0F, 1.0F),
          .turn_share = std::clamp(shape.turn_share + 0.25F * draws.normal(), 0.0F, 1.0F),
          .aside = std::clamp(shape.aside + 0.15F * bounds.turn * draws.normal(), -bounds.turn, bounds.turn),
          .aside_steps = std::clamp(shape.aside_steps + 4.0F * draws.normal(), 0.0F, kMost),
          .back = std::clamp(shape.back + 0.4F * draws.normal(), 0.0F, 1.0F),
          .steps = std::clamp(shape.steps + 5.0F * draws.normal(), 0.0F, kMost)};
}

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
  const Situation situation{decision_, body_, ground, *futures_, returns_, 0.0F, &way};
  Trajectory trial, best;
  StickShape shape;  // of the best
  float least = 1e9F;
  const auto look = [&](const StickShape& tried) {
    make(tried, asked_, decision_.start, body_.bounds, trial);
    const float cost = trajectory_cost(situation, trial, least).total();
    if (cost < least) best = trial, shape = tried, least = cost;
  };
  each_shape(body_.bounds, look);
  for (int round = 0; round < kStickRounds; ++round) {
    const StickShape base = shape;
    for (int n = 0; n < kStickPerturbed; ++n) look(perturbed(base, decision_.number, round, n, body_.bounds));
  }
  const bool is_wish = shape.aside == 0.0F && shape.share == 1.0F && shape.turn_share == 1.0F;
  if (holds(world.now) && !is_wish) {
    trial = rest_of_decision(world.now);
    if (trajectory_cost(situation, trial, least + kLeastStickGain).total() < least + kLeastStickGain) best = trial;
  }
  decision_.trajectory = best;
}

RolloutMotion::Next StickRollouts::next(const World& world, const Intent& intent, const RobotState& now) noexcept {
  const Command asked = stick_command(intent.stick, body_.bounds);
  const Command decided = command_at(world.now);
  const Command to = is_assisted() ? within(body_.bounds, {at_most(decided.v, asked.v), decided.w}) : asked;
  const bool stops = rests(asked) || rests(to);
  return {stops ? slowed(now, body_.bounds, tick_s()) : moved(now, to, body_.bounds, tick_s()), stops};
}

}  // namespace jaywalk::motion
