#include "planner/motion/proposals.h"

#include <algorithm>
#include <cmath>

#include "planner/cell/cell.h"
#include "planner/cell/draws.h"

namespace jaywalk::motion {
namespace {

constexpr std::uint32_t kProposalPurpose = 3;  ///< of the draws

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

constexpr float kPursuitLookM = 0.35F;  // pure pursuit: of the way ahead
constexpr float kPassedM = 0.03F;       // ahead of the axle: a pose is passed
constexpr float kTurnedRad = 0.06F;     // off: turned
constexpr float kTurnsWithin = 0.9F;    // of where it arrives: it turns to the heading wanted there
constexpr float kPursuitGain = 2.0F;    // rad/s a radian off, on the spot
constexpr float kTurnShare = 0.8F;      // of the fastest turn
constexpr float kPursuitSlowing = 0.35F, kLeastMps = 0.03F;  // m/s2, towards a change of gear
constexpr float kCloseM = 0.2F;  // nearer than this the circle through a place says little: by heading
constexpr float kKeepM = 0.055F, kRoomGain = 10.0F, kCreepMps = 0.12F;  // of the outline's edge, by its room
constexpr std::int32_t kSmallTurn = 2;                                  // poses of a turn that an arc has, too

/// Whether only the heading is left to be reached.
bool turns_at_goal(const Situation& s, const RobotState& r) {
  const float within = kTurnsWithin * s.arrives_within_m;
  return s.wants_heading && rests_near(r, s.goal.x, s.goal.y, within, within, s.body.bounds);
}

/// Turns on the spot.
Command turn_to(float heading, const RobotState& r, const MotionBounds& bounds) {
  const float most = kTurnShare * bounds.turn;
  return {0.0F, std::clamp(kPursuitGain * cell::wrapped(heading - r.heading), -most, most)};
}

}  // namespace

WayPursuit::WayPursuit(const Situation& situation, const RobotState& from) noexcept : s_(situation) {
  s_.poses->way_from(from.x, from.y, from.heading, way_);
  join_small_turns();
}

/// A step or two of turning between two drives of one gear is a bend of the drive.
void WayPursuit::join_small_turns() noexcept {
  for (std::int32_t k = 0; k < way_.count;) {
    std::int32_t end = k;
    while (end < way_.count && pose(end).gear == Gear::kTurn) ++end;
    const bool is_last = end == way_.count, is_first = k <= 1;
    if (end > k && end - k <= kSmallTurn && !is_last && (is_first || pose(k - 1).gear == pose(end).gear)) {
      for (std::int32_t n = k; n < end; ++n) way_.poses[static_cast<std::size_t>(n)].gear = pose(end).gear;
    }
    k = std::max(end, k + 1);
  }
}

bool WayPursuit::has_more(const RobotState& r) noexcept {
  if (turns_at_goal(s_, r)) return true;
  while (way_.count > 1 && at_ < way_.count) {
    const Gear gear = pose(at_).gear;
    end_ = at_;
    while (end_ + 1 < way_.count && pose(end_ + 1).gear == gear) ++end_;
    if (gear == Gear::kTurn) {
      if (std::fabs(cell::wrapped(pose(end_).heading - r.heading)) >= kTurnedRad) return true;
      at_ = end_ + 1;
      continue;
    }
    while (at_ <= end_ && is_passed(r, pose(at_))) ++at_;
    if (at_ <= end_) return true;
  }
  return false;
}

bool WayPursuit::is_passed(const RobotState& r, const WayPose& p) const noexcept {
  const cell::Heading a = cell::heading_at(r.heading);
  const float ahead = (p.x - r.x) * a.x + (p.y - r.y) * a.y;
  return (p.gear == Gear::kBackward ? -ahead : ahead) < kPassedM;
}

/// Place at which the way leaves the circle of kPursuitLookM, or the last one of this gear.
Place WayPursuit::look_ahead(const RobotState& r) const noexcept {
  const auto distance_to = [&](const WayPose& p) {
    return std::sqrt((p.x - r.x) * (p.x - r.x) + (p.y - r.y) * (p.y - r.y));
  };
  float before = 0.0F;
  for (std::int32_t k = at_; k <= end_; before = distance_to(pose(k)), ++k) {
    const WayPose& p = pose(k);
    const float d = distance_to(p);
    if (d < kPursuitLookM) continue;
    if (k == at_) return {p.x, p.y};
    const WayPose& from = pose(k - 1);
    const float share = (kPursuitLookM - before) / std::max(d - before, 1e-3F);
    return {from.x + share * (p.x - from.x), from.y + share * (p.y - from.y)};
  }
  return {pose(end_).x, pose(end_).y};
}

/// Curvature of the circle through a place; near it, of what turns to the heading there.
float WayPursuit::bend_to(Place target, const RobotState& r) const noexcept {
  const cell::Heading a = cell::heading_at(r.heading);
  const float dx = target.x - r.x, dy = target.y - r.y, d2 = std::max(dx * dx + dy * dy, 1e-4F);
  if (d2 >= kCloseM * kCloseM) return 2.0F * (dy * a.x - dx * a.y) / d2;
  const float sign = pose(at_).gear == Gear::kForward ? 1.0F : -1.0F;
  return sign * cell::wrapped(pose(end_).heading - r.heading) / std::max(std::sqrt(d2), 0.5F * kCloseM);
}

float WayPursuit::room_m() const noexcept {
  float least = 1.0F;
  for (std::int32_t k = std::max(0, at_ - 1); k <= std::min(at_ + 1, end_); ++k)
    least = std::min(least, pose(k).room_m);
  return least;
}

Command WayPursuit::command(const RobotState& r, float speed) noexcept {
  if (turns_at_goal(s_, r)) return turn_to(s_.goal_heading, r, s_.body.bounds);
  const Gear gear = pose(at_).gear;
  if (gear == Gear::kTurn) return turn_to(pose(end_).heading, r, s_.body.bounds);
  const MotionBounds& b = s_.body.bounds;
  const float bend = bend_to(look_ahead(r), r), size = std::fabs(bend);
  float v = gear == Gear::kForward ? speed : std::min(b.back, std::max(speed, kLeastMps));
  if (end_ + 1 < way_.count) {
    const float dx = pose(end_).x - r.x, dy = pose(end_).y - r.y;
    v = std::min(v, std::sqrt(2.0F * kPursuitSlowing * std::sqrt(dx * dx + dy * dy)) + kLeastMps);
  }
  if (size > 1e-3F) v = std::min(v, b.turn / size);
  const float rim_mps = std::max((room_m() - kKeepM) * kRoomGain, kCreepMps);
  v = std::min(v, rim_mps / (1.0F + size * s_.body.rim_m));
  const float signed_v = gear == Gear::kForward ? v : -v;
  return {signed_v, std::clamp(signed_v * bend, -b.turn, b.turn)};
}

void TrajectoryProposals::hold_then_follow(const Command& command, int steps, float speed,
                                           Trajectory& out) const noexcept {
  RobotState robot = s_.start;
  drive_out(robot, 0, steps, command, out);
  if (steps < kSteps) follow_from(robot, steps, speed, out);
}

void TrajectoryProposals::follow_then_hold(int steps, const Command& command, Trajectory& out) const noexcept {
  follow_from(s_.start, 0, s_.body.bounds.speed, out);
  std::fill(out.commands.begin() + steps, out.commands.end(), command);
}

/// Turns to a heading, then drives straight on at full speed: an escape that the guide does not show
/// (docs/explanation/decisions/motion-rollouts.md).
void TrajectoryProposals::go_straight(float heading, Trajectory& out) const noexcept {
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
