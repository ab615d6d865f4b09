#include <algorithm>

#include "planner/motion/cost/ground_cost.h"
#include "planner/motion/cost/mover_cost.h"
#include "planner/motion/cost/ride_cost.h"

namespace jaywalk::motion {
namespace {

/// Rolls a trajectory out until it stands at the goal or ends, at the price of the driving alone; returns how many
/// states that are. Arrived it slows down, and neither its time nor its comfort counts any more.
int roll_out(const Situation& s, const Trajectory& trajectory, RobotState* states, Cost& cost) noexcept {
  TimeCost time(s);
  ComfortCost comfort(s);
  StopZoneCost stop_zone(s);
  cost.time = price::kArrivedEarly;
  RobotState robot = s.start;
  KnownBehind behind = s.known_behind;
  bool arrived = false;
  const int last = s.stick != nullptr ? kStickSteps : kSteps;
  for (int step = 0; step < last; ++step) {
    const RobotState before = robot;
    const MotionBounds bounds = behind.limited(s.body.bounds);
    const Command wanted = trajectory.commands[static_cast<std::size_t>(step)];
    const Command command = arrived ? Command{} : within(bounds, wanted);
    robot = moved(before, command, bounds, kStepS);
    stop_zone.limit(before, robot, cost);
    states[step] = robot;
    behind.drive(robot.v, kStepS);
    if (arrived) {
      if (robot.v == 0.0F) return step + 1;
      continue;
    }
    if (s.stick == nullptr) comfort.add(before, robot, cost);  // a person turns and speeds up at will
    time.add(robot, cost);
    arrived = time.is_there(robot);
    if (arrived) cost.time -= price::kArrivedEarly;
  }
  if (arrived) return last;
  cost.time += s.stick != nullptr ? seconds_off(*s.stick, states, s.body.bounds) : time.price_to_go(robot);
  return last;
}

/// Adds the costs from surroundings: walls, unseen ground, movers. Gives up above `bound`.
void add_surroundings(const Situation& s, const RobotState* states, int steps, float bound, Cost& cost) noexcept {
  WallCost walls(s);
  UnseenCost unseen(s);
  MoverCost movers(s);
  for (int step = 0; step < steps; ++step) {
    const float t = static_cast<float>(step + 1) * kStepS;
    const cell::Heading along = cell::heading_at(states[step].heading);
    walls.add(states[step], along, t, cost);
    unseen.add(states[step], along, cost);
    if ((step & 1) == 0) continue;  // futures have a step for two of the robot's
    movers.add(states[step], along, (step + 1) / 2, t, cost);
    if (cost.total() > bound) return;
  }
}

}  // namespace

float seconds_off(const StickRollout& asked, const RobotState* states, const MotionBounds& bounds) noexcept {
  constexpr float kWeight = 2.0F;      // of a second off
  constexpr float kTurnArm_m = 0.25F;  // a radian aside is as far off as this: the lever of a seat or a front
  float sum_m = 0.0F;
  for (int k = 0; k < kFollowedSteps; ++k) {
    const RobotState& to = asked[static_cast<std::size_t>(k)];
    const float dx = states[k].x - to.x, dy = states[k].y - to.y;
    sum_m += std::sqrt(dx * dx + dy * dy) + kTurnArm_m * std::fabs(states[k].heading - to.heading);
  }
  return kWeight * sum_m / (bounds.speed * static_cast<float>(kFollowedSteps));
}

Cost trajectory_cost(const Situation& s, const Trajectory& trajectory, float bound, RobotState* driven) noexcept {
  Cost cost;
  RobotState states[kSteps];
  const int steps = roll_out(s, trajectory, states, cost);
  if (driven != nullptr) {
    std::copy_n(states, steps, driven);
    std::fill(driven + steps, driven + kSteps, states[steps - 1]);
  }
  if (cost.total() > bound) return cost;  // what it is near to can only add
  add_surroundings(s, states, steps, bound, cost);
  return cost;
}

}  // namespace jaywalk::motion
