#include "planner/motion/proposals.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "planner/cell/draws.h"
#include "planner/cell/exp_log.h"
#include "planner/motion/way_pursuit.h"

namespace jaywalk::motion {
namespace {

constexpr std::uint32_t kProposalPurpose = 3;  ///< of the draws

constexpr float kFollowShares[] = {1.0F, 0.833F, 0.667F, 0.5F, 0.333F, 0.167F, 0.0F};  ///< of full speed
constexpr int kPauses = 4;  ///< waits of 0.8 to 3.2 s before it goes, and as many stops
constexpr float kTurns[] = {0.0F, -0.15F, 0.15F, -0.3F, 0.3F, -0.5F, 0.5F, -0.75F, 0.75F, -1.0F, 1.0F};
constexpr float kForward[] = {1.0F, 0.667F, 0.333F, 0.0F};  ///< of full speed
constexpr float kBack[] = {0.5F, 1.0F};                     ///< of the speed backward
constexpr int kBends[] = {7, 14};                           ///< steps of an arc before it follows
constexpr int kTurnCount = std::ssize(kTurns);

constexpr int kFollows = std::ssize(kFollowShares);
constexpr int kArcs = (std::ssize(kForward) + std::ssize(kBack)) * kTurnCount;
constexpr int kBentForward = std::ssize(kForward) * std::ssize(kBends) * kTurnCount;
constexpr int kBentBack = std::ssize(kBack) * kTurnCount;
constexpr int kStraights = 12;                             ///< directions, all round
constexpr int kBrakesFor[] = {kSteps, 8, 16, 24, 32, 40};  ///< steps from now, before it follows
constexpr int kBrakesAfter[] = {3, 6, 10};                 ///< steps of following before it brakes for good
constexpr int kBrakes = std::ssize(kBrakesFor) + std::ssize(kBrakesAfter);

constexpr int kSteerEvery = 3;     ///< steps
constexpr int kSteerWayEvery = 2;  ///< the same, along a way of poses
constexpr float kLookM = 0.5F;     ///< the guide is asked this far off
constexpr std::size_t kDirections = 16;
constexpr float kSharpness = 8.0F;  ///< of the choice between directions side by side, 1/s
constexpr float kGain = 1.8F;       ///< rad/s a radian off
constexpr float kTurnsFirstRad = 0.9F;
constexpr float kWhileTurningMps = 0.1F;

constexpr float kBetweenRad = 2.0F * cell::kPiF / static_cast<float>(kDirections);
constexpr int kAside = 2;  ///< looks to either side of a direction, half a direction apart

constexpr float off_rad(int aside) { return static_cast<float>(aside) * 0.5F * kBetweenRad; }

/// Places about the robot at which the guide is asked, as vectors from it.
template <std::size_t N>
struct Looks {
  float x[N], y[N];
  void set(std::size_t n, float rad) {
    const cell::Heading to = cell::heading_at(rad);
    x[n] = kLookM * to.x, y[n] = kLookM * to.y;
  }
  /// Seconds to go from there.
  void ask(const Guide& guide, float from_x, float from_y, float (&seconds)[N]) const {
    float at_x[N], at_y[N];
    for (std::size_t n = 0; n < N; ++n) at_x[n] = from_x + x[n], at_y[n] = from_y + y[n];
    guide.times_to_go(at_x, at_y, seconds);
  }
};

constexpr std::size_t kClose = 2 * kAside + 1;
constexpr std::size_t close_at(int aside) { return static_cast<std::size_t>(aside + kAside); }

struct Compass {
  Looks<kDirections> round;
  Looks<kClose> close[kDirections];  ///< about each
};

constexpr float direction_rad(std::size_t n) { return static_cast<float>(n) * kBetweenRad; }

const Compass kCompass = [] {
  Compass c;
  for (std::size_t n = 0; n < kDirections; ++n) {
    c.round.set(n, direction_rad(n));
    for (int k = -kAside; k <= kAside; ++k) c.close[n].set(close_at(k), direction_rad(n) + off_rad(k));
  }
  return c;
}();

}  // namespace

int TrajectoryProposals::count() const {
  return constant_ > 0.0F ? (1 + static_cast<int>(std::size(kBends))) * kTurnCount + 1
                          : kFollows + 2 * kPauses + kArcs + kBentForward + kBentBack + kStraights + kBrakes;
}

void TrajectoryProposals::make(int n, Trajectory& out) const noexcept {
  out.perturbed = false;
  if (constant_ > 0.0F) {
    if (n == 0) return out.proposal = Proposal::kFollow, follow_from(s_.start, 0, constant_, out);
    return n <= kTurnCount ? arc(n - 1, out) : arc_then_follow(n - 1 - kTurnCount, out);
  }
  const float full = s_.body.bounds.speed;
  RobotState robot = s_.start;
  if (n < kFollows) {
    out.proposal = Proposal::kFollow;
    return follow_from(robot, 0, kFollowShares[n] * full, out);
  }
  n -= kFollows;
  if (n < kPauses) {
    out.proposal = Proposal::kWaitThenGo;
    const int wait = 8 * (n + 1);
    drive_out(robot, 0, wait, {}, out);
    return follow_from(robot, wait, full, out);
  }
  n -= kPauses;
  if (n < kPauses) {
    out.proposal = Proposal::kGoThenStop;
    follow_from(robot, 0, full, out);
    return std::fill(out.commands.begin() + 6 + 8 * n, out.commands.end(), Command{});
  }
  n -= kPauses;
  if (n < kArcs) return arc(n, out);
  n -= kArcs;
  if (n < kBentForward + kBentBack) return arc_then_follow(n, out);
  n -= kBentForward + kBentBack;
  n < kStraights ? go_straight(n, out) : brake(n - kStraights, out);
}

void TrajectoryProposals::brake(int n, Trajectory& out) const noexcept {
  constexpr Command kStop{0.0F, 0.0F, true};
  out.proposal = Proposal::kBrake;
  RobotState robot = s_.start;
  const int after_k = n - static_cast<int>(std::ssize(kBrakesFor));
  if (after_k >= 0) {
    follow_from(robot, 0, s_.body.bounds.speed, out);
    const int after = kBrakesAfter[after_k];
    return std::fill(out.commands.begin() + after, out.commands.end(), kStop);
  }
  const int wait = kBrakesFor[n];
  drive_out(robot, 0, wait, kStop, out);
  if (wait < kSteps) follow_from(robot, wait, s_.body.bounds.speed, out);
}

void TrajectoryProposals::arc(int n, Trajectory& out) const noexcept {
  const int row = n / kTurnCount, back = row - static_cast<int>(std::ssize(kForward));
  const MotionBounds& b = s_.body.bounds;
  const float v = constant_ > 0.0F ? constant_ : back < 0 ? kForward[row] * b.speed : -kBack[back] * b.back;
  out.proposal = v < 0.0F ? Proposal::kArcBack : Proposal::kArc;
  out.commands.fill(permitted({v, kTurns[n % kTurnCount] * b.turn}));
}

void TrajectoryProposals::arc_then_follow(int n, Trajectory& out) const noexcept {
  const MotionBounds& b = s_.body.bounds;
  const bool back = constant_ <= 0.0F && n >= kBentForward;
  const int row = (back ? n - kBentForward : n) / kTurnCount;
  const float v = constant_ > 0.0F ? constant_
                  : back           ? -kBack[row] * b.back
                                   : kForward[row / std::ssize(kBends)] * b.speed;
  const int steps = back ? kBends[0] : kBends[row % std::ssize(kBends)];
  out.proposal = back ? Proposal::kBackThenFollow : Proposal::kArcThenFollow;
  RobotState robot = s_.start;
  drive_out(robot, 0, steps, permitted({v, kTurns[n % kTurnCount] * b.turn}), out);
  follow_from(robot, steps, constant_ > 0.0F ? constant_ : b.speed, out);
}

/// Turns to one of twelve headings, then drives straight on at full speed: an escape that the guide does not show
/// (docs/explanation/decisions/motion-rollouts.md).
void TrajectoryProposals::go_straight(int n, Trajectory& out) const noexcept {
  const float heading = s_.start.heading + 2.0F * cell::kPiF * static_cast<float>(n) / static_cast<float>(kStraights);
  out.proposal = Proposal::kGoStraight;
  RobotState robot = s_.start;
  for (int step = 0; step < kSteps; step += kSteerEvery) {
    const Command command = towards(cell::wrapped(heading - robot.heading), s_.body.bounds.speed);
    drive_out(robot, step, std::min(step + kSteerEvery, kSteps), permitted(command), out);
  }
}

void TrajectoryProposals::drive_out(RobotState& robot, int from, int to, Command command,
                                    Trajectory& out) const noexcept {
  for (int step = from; step < to; ++step) {
    out.commands[static_cast<std::size_t>(step)] = command;
    robot = moved(robot, command, s_.body.bounds, kStepS);
  }
}

void TrajectoryProposals::follow_from(RobotState robot, int step, float speed, Trajectory& out) const noexcept {
  if (s_.goes_by_poses() && constant_ <= 0.0F) follow_way(robot, step, speed, out);
  for (; step < kSteps; step += kSteerEvery) {
    const Command command =
        turns_at_goal(s_, robot) ? turn_to(s_.goal_heading, robot, s_.body.bounds) : pursuit(robot, speed);
    drive_out(robot, step, std::min(step + kSteerEvery, kSteps), permitted(command), out);
  }
}

/// As far as the way from poses leads; `robot` and `step` are then where that ends.
void TrajectoryProposals::follow_way(RobotState& robot, int& step, float speed, Trajectory& out) const noexcept {
  WayPursuit pursuit(s_, robot);
  while (step < kSteps && pursuit.has_more(robot)) {
    const int to = std::min(step + kSteerWayEvery, kSteps);
    drive_out(robot, step, to, permitted(pursuit.command(robot, speed)), out);
    step = to;
  }
}

/// No faster to where nothing looks than the supervisor lets it; at constant speed that is not asked.
Command TrajectoryProposals::permitted(const Command& command) const noexcept {
  return constant_ > 0.0F ? command : s_.body.blind.slowed(command);
}

/// Towards where, half a metre off, the goal is nearest in time.
Command TrajectoryProposals::pursuit(const RobotState& r, float speed) const noexcept {
  float round[kDirections], close[kClose];
  kCompass.round.ask(s_.guide, r.x, r.y, round);
  const auto best = static_cast<std::size_t>(std::min_element(round, round + kDirections) - round);
  if (round[best] >= Guide::kNoWay_s) return {constant_, 0.0F};
  kCompass.close[best].ask(s_.guide, r.x, r.y, close);
  float sum = 0.0F, weights = 0.0F;
  for (int k = -kAside; k <= kAside; ++k) {
    const float t = close[close_at(k)];
    if (t >= Guide::kNoWay_s) continue;
    const float weight = cell::exp((round[best] - t) * kSharpness);
    sum += weight * off_rad(k), weights += weight;
  }
  return towards(cell::wrapped(direction_rad(best) + (weights > 0.0F ? sum / weights : 0.0F) - r.heading), speed);
}

/// Proportional steering to a heading `error_rad` to the left; a large error is turned off nearly in place first.
Command TrajectoryProposals::towards(float error_rad, float speed) const noexcept {
  const float turn = s_.body.bounds.turn, wanted = kGain * error_rad;
  const bool turns_first = constant_ <= 0.0F && std::fabs(error_rad) > kTurnsFirstRad;
  return {turns_first ? std::min(speed, kWhileTurningMps) : speed, std::clamp(wanted, -turn, turn)};
}

void TrajectoryProposals::perturb(const Trajectory& base, std::uint32_t decision, int round, int number,
                                  Trajectory& out) const noexcept {
  const MotionBounds& b = s_.body.bounds;
  const auto n = static_cast<std::uint32_t>(number);
  cell::Draws draws({decision, kProposalPurpose, static_cast<std::uint32_t>(round), n});
  const float v_size = (constant_ > 0.0F ? 0.0F : (n & 1U) != 0 ? 0.42F : 0.17F) * b.speed;
  const float w_size = (n & 2U) != 0 ? 0.5F : 0.2F;
  float v_goal = 0.0F, w_goal = 0.0F, v = 0.0F, w = 0.0F;
  int hold = 0;
  out.proposal = base.proposal;
  out.perturbed = true;
  for (int step = 0; step < kSteps; ++step) {
    if (hold-- == 0) {
      hold = 4 + static_cast<int>(10.0F * draws.uniform());
      v_goal = v_size * draws.normal();
      w_goal = w_size * draws.normal();
    }
    v += 0.3F * (v_goal - v);
    w += 0.3F * (w_goal - w);
    const Command& c = base.commands[static_cast<std::size_t>(step)];
    const float to = c.brakes ? c.v : std::clamp(c.v + v, -b.back, b.speed);  // a brake that is half on is none
    out.commands[static_cast<std::size_t>(step)] = {constant_ > 0.0F ? constant_ : to,
                                                    std::clamp(c.w + w, -b.turn, b.turn), c.brakes};
  }
}

void TrajectoryProposals::smooth(const Trajectory& base, int half, Trajectory& out) const noexcept {
  const auto turn_at = [&](int step) {
    return step < 0 ? s_.start.w : base.commands[static_cast<std::size_t>(std::min(step, kSteps - 1))].w;
  };
  out = base;
  out.perturbed = true;
  for (int step = 0; step < kSteps; ++step) {
    float sum = 0.0F;
    for (int near = step - half; near <= step + half; ++near) sum += turn_at(near);
    out.commands[static_cast<std::size_t>(step)].w = sum / static_cast<float>(2 * half + 1);
  }
}

Trajectory shifted(const Trajectory& trajectory, float by_s) noexcept {
  Trajectory out = trajectory;
  const float steps = by_s / kStepS;
  const auto& old = trajectory.commands;
  for (int k = 0; k < kSteps; ++k) {
    const float at = static_cast<float>(k) + steps;
    const auto i = static_cast<std::size_t>(std::min(static_cast<int>(at), kSteps - 1));
    const std::size_t j = std::min(i + 1, old.size() - 1);
    const float share = at - static_cast<float>(static_cast<int>(at));
    out.commands[static_cast<std::size_t>(k)] = {old[i].v + share * (old[j].v - old[i].v),
                                                 old[i].w + share * (old[j].w - old[i].w), old[i].brakes};
  }
  out.proposal = Proposal::kLast;
  return out;
}

}  // namespace jaywalk::motion
