#include "planner/motion/stick_proposals.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "planner/cell/draws.h"

namespace jaywalk::motion {
namespace {

constexpr std::uint32_t kStickPurpose = 4;  ///< of the draws
constexpr float kWeight = 2.0F;             ///< of a second off

constexpr float kStops[] = {0.0F, 3.0F, 6.0F, 10.0F, 15.0F};  ///< steps as asked before it slows down
constexpr float kShares[] = {1.0F, 0.667F, 0.333F};
constexpr float kStickAside[] = {0.12F,  -0.12F, 0.25F, -0.25F, 0.45F,
                                 -0.45F, 0.7F,   -0.7F, 1.0F,   -1.0F};  ///< of the fastest turn
constexpr float kAsideSteps[] = {4.0F, 8.0F, 14.0F, 22.0F};
constexpr float kStickBack[] = {0.0F, 1.0F}, kTurnShares[] = {1.0F, 0.0F};
constexpr int kStopCount = std::ssize(kStops), kShareCount = std::ssize(kShares);
constexpr int kStepCount = std::ssize(kAsideSteps), kBackCount = std::ssize(kStickBack);
constexpr int kTurnShareCount = std::ssize(kTurnShares);
constexpr int kBent = std::ssize(kStickAside) * kStepCount * kBackCount * kTurnShareCount;

Command command_of(const StickShape& shape, const Command& asked, float step, const MotionBounds& bounds) {
  const float back_until = shape.aside_steps * (1.0F + shape.back);
  const float aside = step < shape.aside_steps ? shape.aside : step < back_until ? -shape.aside : 0.0F;
  return {shape.share * asked.v, std::clamp(shape.turn_share * asked.w + aside, -bounds.turn, bounds.turn)};
}

}  // namespace

Command stick_command(const Stick& stick, const MotionBounds& bounds) noexcept {
  if (!std::isfinite(stick.forward) || !std::isfinite(stick.left)) return {};
  const auto forward = static_cast<float>(std::clamp(stick.forward, -1.0, 1.0));
  const auto left = static_cast<float>(std::clamp(stick.left, -1.0, 1.0));
  return {forward * (forward > 0.0F ? bounds.speed : bounds.back), left * bounds.turn};
}

RobotState slowed(const RobotState& from, const MotionBounds& bounds, float dt) noexcept {
  constexpr float kRests_mps = 1e-3F;
  RobotState s = moved(from, {}, bounds, dt);
  const float on_arc = std::fabs(from.v) > kRests_mps ? from.w * s.v / from.v : 0.0F;
  if (std::fabs(on_arc) > std::fabs(s.w)) s.w = on_arc;
  return s;
}

StickRollout roll_out_stick(const RobotState& start, const Command& command, const MotionBounds& bounds) noexcept {
  StickRollout way{command, {}};
  RobotState robot = start;
  for (RobotState& state : way.states) state = robot = moved(robot, command, bounds, kStepS);
  return way;
}

float seconds_off(const StickRollout& asked, const RobotState* states, const MotionBounds& bounds) noexcept {
  float sum_m = 0.0F;
  for (int k = 0; k < kFollowedSteps; ++k) {
    const RobotState& to = asked.states[static_cast<std::size_t>(k)];
    const float dx = states[k].x - to.x, dy = states[k].y - to.y;
    sum_m += std::sqrt(dx * dx + dy * dy) + kTurnArm_m * std::fabs(states[k].heading - to.heading);
  }
  return kWeight * sum_m / (bounds.speed * static_cast<float>(kFollowedSteps));
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

int shape_count() noexcept { return 1 + kStopCount + (kShareCount - 1) + kShareCount * kBent; }

StickShape shape_at(int n, const MotionBounds& bounds) noexcept {
  if (n == 0) return {};
  if (--n < kStopCount) return {.steps = kStops[n]};
  n -= kStopCount;
  if (n < kShareCount - 1) return {.share = kShares[n + 1]};
  n -= kShareCount - 1;
  const float share = kShares[n / kBent];
  n %= kBent;
  const float turn_share = kTurnShares[n % kTurnShareCount];
  n /= kTurnShareCount;
  return {.share = share,
          .turn_share = turn_share,
          .aside = kStickAside[n / (kBackCount * kStepCount)] * bounds.turn,
          .aside_steps = kAsideSteps[n / kBackCount % kStepCount],
          .back = kStickBack[n % kBackCount]};
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

}  // namespace jaywalk::motion
