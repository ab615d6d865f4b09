#include "hal/sim/wanderers.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "hal/types/errors.h"

namespace jaywalk::sim {
namespace {

constexpr double kRoomToWalls = 0.3;   // m between a mover's edge and what is near when it is placed
constexpr double kRoomToRobot = 2.0;   // m from the robot's start
constexpr double kRoomToGoal = 1.0;    // m from the goal
constexpr double kRoomToMovers = 0.5;  // m between edges
constexpr int kPlacements = 20000;     // tries for one mover: 16 find room on maps that are 99 % walls
constexpr int kHeadingsAStep = 16;     // tries for a free heading before it looks again in the next step
constexpr double kTouch = 0.01;        // m: nearer than this a mover walks on into nobody

}  // namespace

Wanderers::Wanderers(const Scenario& scenario, const Walls& walls, const FreeGrid& grid, std::uint64_t seed)
    : walls_(walls) {
  Random random(seed, Purpose::kPlacement);
  for (const WanderSpec& spec : scenario.wanderers) {
    for (int k = 0; k < spec.count; ++k) place(spec, scenario, grid, seed, random);
  }
}

bool Wanderers::has_room(Vec2 p, double radius_m, const Scenario& scenario, const FreeGrid& grid) const {
  const double to_walls = radius_m + kRoomToWalls;
  if (distance(p, scenario.start.position()) < kRoomToRobot + radius_m) return false;
  if (distance(p, scenario.goal) < kRoomToGoal + radius_m) return false;
  for (const MoverTruth& other : movers_) {
    if (distance(p, other.position) < radius_m + other.radius_m + kRoomToMovers) return false;
  }
  return grid.reachable(p) && walls_.distance(p, to_walls) >= to_walls;
}

void Wanderers::place(const WanderSpec& spec, const Scenario& scenario, const FreeGrid& grid, std::uint64_t seed,
                      Random& random) {
  const auto& [low, high] = walls_.bounds();
  const auto id = static_cast<std::uint32_t>(movers_.size() + 1);
  for (int k = 0; k < kPlacements; ++k) {
    const double x = random.uniform(low.x, high.x), y = random.uniform(low.y, high.y);
    if (!has_room({x, y}, spec.radius_m, scenario, grid)) continue;
    const double heading = random.uniform(-kPi, kPi);
    movers_.push_back(
        {.id = id, .position = {x, y}, .heading = heading, .radius_m = spec.radius_m, .on_legs = spec.legs});
    minds_.push_back({.speed_mps = spec.speed_mps,
                      .turn_rate_radps = spec.turn_rate_radps,
                      .spontaneous_turns_hz = spec.spontaneous_turns_hz,
                      .random = Random(seed, Purpose::kWanderer, id)});
    return;
  }
  throw StartupError(scenario.map_file.string() + ": no room for mover " + std::to_string(id),
                     "ask for fewer or smaller movers");
}

Wanderers::Blocker Wanderers::ahead(std::size_t self, double heading, const Surroundings& near) const noexcept {
  const MoverTruth& mover = movers_[self];
  const Zone zone{mover.position, direction(heading), mover.radius_m + kWanderZone};
  bool wall = false;
  walls_.for_each_near(zone.apex, zone.reach_m, [&](const auto& shape) { wall = wall || zone.meets(shape); });
  if (wall) return Blocker::kOther;
  const auto in_zone = [&](const MoverTruth& other) {
    return other.id != mover.id && zone.meets(Disc{other.position, other.radius_m});
  };
  if (std::any_of(movers_.begin(), movers_.end(), in_zone)) return Blocker::kOther;
  if (std::any_of(near.others.begin(), near.others.end(), in_zone)) return Blocker::kOther;
  return near.robot.in(zone) ? Blocker::kRobot : Blocker::kNothing;
}

/// Whom the mover would run into from the side, where its zone does not look; walls cannot be met so
/// (see docs/reference/scenarios.md). Only coming nearer counts, so that two that touch can part.
Wanderers::Blocker Wanderers::touched(std::size_t self, Vec2 next, const Surroundings& near) const noexcept {
  const MoverTruth& mover = movers_[self];
  const auto runs_into = [&](const MoverTruth& other) {
    const double after = distance(next, other.position);
    return other.id != mover.id && after < mover.radius_m + other.radius_m + kTouch &&
           after < distance(mover.position, other.position);
  };
  if (std::any_of(movers_.begin(), movers_.end(), runs_into)) return Blocker::kOther;
  if (std::any_of(near.others.begin(), near.others.end(), runs_into)) return Blocker::kOther;
  const double gap = near.robot.gap({next, mover.radius_m});
  const bool into_robot = gap <= 0.0 && distance(next, near.robot.map_from_robot.position()) <
                                            distance(mover.position, near.robot.map_from_robot.position());
  return into_robot ? Blocker::kRobot : Blocker::kNothing;
}

void Wanderers::halt(std::size_t self, Blocker blocker) noexcept {
  MoverTruth& mover = movers_[self];
  mover.velocity = {};
  minds_[self].activity = Activity::kChoosing;
  if (blocker == Blocker::kRobot && !mover.forced) {
    mover.forced = true;
    ++forced_;
  }
}

void Wanderers::walk(std::size_t self, double step_s, const Surroundings& near) noexcept {
  MoverTruth& mover = movers_[self];
  Mind& mind = minds_[self];
  const bool whim = mind.random.uniform() < mind.spontaneous_turns_hz * step_s;
  const Blocker in_zone = ahead(self, mover.heading, near);
  if (whim || in_zone != Blocker::kNothing) return halt(self, in_zone);
  const Vec2 velocity = direction(mover.heading) * mind.speed_mps;
  const Vec2 next = mover.position + velocity * step_s;
  const Blocker beside = touched(self, next, near);
  if (beside == Blocker::kRobot) bumped_robot_ = true;
  if (beside != Blocker::kNothing) return halt(self, beside);
  mover.position = next;
  mover.velocity = velocity;
  mover.forced = false;
}

void Wanderers::choose(std::size_t self, const Surroundings& near) noexcept {
  Mind& mind = minds_[self];
  for (int k = 0; k < kHeadingsAStep; ++k) {
    const double heading = mind.random.uniform(-kPi, kPi);
    if (ahead(self, heading, near) != Blocker::kNothing) continue;
    mind.new_heading = heading;
    mind.activity = Activity::kTurning;
    return;
  }
}

void Wanderers::turn(std::size_t self, double step_s) noexcept {
  MoverTruth& mover = movers_[self];
  Mind& mind = minds_[self];
  const double left = wrap_angle(mind.new_heading - mover.heading);
  const double most = mind.turn_rate_radps * step_s;
  if (std::fabs(left) <= most) {
    mover.heading = mind.new_heading;
    mind.activity = Activity::kWalking;
  } else {
    mover.heading = wrap_angle(mover.heading + (left > 0.0 ? most : -most));
  }
}

void Wanderers::step(double step_s, const RobotBody& robot, std::span<const MoverTruth> others) noexcept {
  bumped_robot_ = false;
  const Surroundings near{robot, others};
  for (std::size_t self = 0; self < movers_.size(); ++self) {
    switch (minds_[self].activity) {
      case Activity::kWalking:
        walk(self, step_s, near);
        break;
      case Activity::kChoosing:
        choose(self, near);
        break;
      case Activity::kTurning:
        turn(self, step_s);
        break;
    }
  }
}

}  // namespace jaywalk::sim
