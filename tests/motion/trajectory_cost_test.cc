#include <algorithm>
#include <cmath>
#include <memory>

#include "hal/types/robot_model.h"
#include "planner/motion/proposals.h"
#include "planner/motion/situation.h"
#include "tests/motion/guided.h"
#include "tests/support/catch.h"

using namespace jaywalk;
using namespace jaywalk::motion;

namespace {

const NearReturns kNothing;

RobotBody body_of(float full_speed) {
  const Footprint f = p3dx().footprint;
  RobotBody body;
  body.rim = robot_body(f, {}, LaserModel{}, 1.0).rim;
  body.to_walls = body.to_movers = BodyDiscs::covering(f, 0.02);
  body.bounds = {.speed = full_speed,
                 .back = 0.3F,
                 .turn = 1.2F,
                 .turn_accel = 2.0F,
                 .accel = 0.5F,
                 .slowing = 0.8F,
                 .jerk = 0.75F,
                 .brake = 1.0F};
  return body;
}

/// A P3-DX at (0, 0), its goal straight ahead, open ground and the futures of some movers.
struct Scene {
  explicit Scene(float goal_m = 4.0F, std::span<const MoverBelief> movers = {}, const NearReturns& near = kNothing)
      : goal{goal_m, 0.0F}, returns(near) {
    settle();
    if (!movers.empty()) futures->draw(movers, {}, {}, guide, 1);
  }
  void settle() { (void)ground.towards({0.0, 0.0}, {double{goal.x}, 0.0}); }
  [[nodiscard]] Cost cost_of(const Trajectory& trajectory, RobotState* driven = nullptr) const {
    return trajectory_cost(situation, trajectory, 1e9F, driven);
  }
  [[nodiscard]] Cost cost_of(const Command& held, RobotState* driven = nullptr) const {
    Trajectory trajectory;
    trajectory.commands.fill(held);
    return cost_of(trajectory, driven);
  }

  Place goal;
  const NearReturns& returns;
  test::Guided ground;
  const Guide& guide = ground.guide();
  RobotBody body = body_of(0.6F);
  std::unique_ptr<Futures> futures = std::make_unique<Futures>();
  Situation situation{{{}, goal}, body, guide, *futures, returns, 0.24F};
};

/// What a robot in the open, its goal 4 m ahead, would pay for one command held all the time.
Cost cost_of(const Command& command, float stood_s, float turned = 0.0F, bool walled_in = false,
             float full_speed = 0.6F, bool alone = false, float wound_rad = 0.0F) {
  Scene scene;
  if (walled_in) {
    scene.ground.wall({2.0, -4.0}, {2.0, 6.0}).wall({-2.0, -4.0}, {-2.0, 6.0});
    scene.ground.wall({-2.0, -3.0}, {2.0, -3.0}).wall({-2.0, 3.0}, {2.0, 3.0});
    scene.settle();
  }
  scene.body = body_of(full_speed);
  scene.situation.turned = turned;
  scene.situation.stall = {stood_s, scene.guide.time_to_go(0.0F, 0.0F), alone, wound_rad};
  return scene.cost_of(command);
}

}  // namespace

TEST_CASE("beside movers a second is the dearer the longer the time to go has not fallen, however it is spent") {
  for (const Command& command : {Command{}, {0.6F, 0.0F}, {0.0F, 0.5F}, {-0.3F, 0.0F}}) {
    const float at_once = cost_of(command, 0.0F).time;
    const float seconds = at_once - motion::price::kArrivedEarly;
    CHECK(cost_of(command, 2.0F).time == Approx(at_once + 0.5F * seconds).margin(0.01));
    CHECK(cost_of(command, 4.0F).time == Approx(at_once + seconds).margin(0.01));
    CHECK(cost_of(command, 60.0F).time == cost_of(command, 4.0F).time);
  }
}

TEST_CASE("with no pedestrian about seconds are dearer until the time to go falls, the more so for twelve seconds") {
  const auto dearer = [](const Command& command, float stood_s) {
    return cost_of(command, stood_s, 0.0F, false, 0.6F, true).time -
           cost_of(command, 0.0F, 0.0F, false, 0.6F, true).time;
  };
  CHECK(dearer({}, 4.0F) == Approx(6.0F).margin(0.01));  // 6 s at a second each
  CHECK(dearer({}, 60.0F) == Approx(18.0F).margin(0.01));
  CHECK(dearer({0.2F, 1.0F}, 60.0F) == Approx(18.0F).margin(0.01));   // circling is no getting on,
  CHECK(dearer({-0.3F, 0.0F}, 60.0F) == Approx(18.0F).margin(0.01));  // nor is backing off
  CHECK(dearer({0.6F, 0.0F}, 4.0F) == Approx(1.3F).margin(0.2F));     // until it is 0.3 m on, at 0.75 m/s3
}

TEST_CASE("where no way is known it may stand for ever") {
  const float at_once = cost_of({}, 0.0F, 0.0F, true).total();
  REQUIRE(at_once > 400.0F);
  CHECK(cost_of({}, 60.0F, 0.0F, true).total() == at_once);
}

TEST_CASE("turning to the other side than before costs once, at three times the speed a third as much time") {
  const auto cost = [](float turned, float full_speed) {
    return cost_of({0.3F, 0.5F}, 0.0F, turned, false, full_speed).total();
  };
  CHECK(cost(-1.0F, 0.6F) == Approx(cost(1.0F, 0.6F) + 1.5F).margin(0.01));
  CHECK(cost(0.0F, 0.6F) == Approx(cost(1.0F, 0.6F)).margin(0.01));
  CHECK(cost(-1.0F, 1.8F) == Approx(cost(1.0F, 1.8F) + 0.5F).margin(0.01));
}

TEST_CASE("having turned by more than half a circle without getting on, it is cheaper to turn back than right round") {
  const auto cost_wound = [](float wound_rad, float turn_radps) {
    return cost_of({0.0F, turn_radps}, 0.0F, 0.0F, false, 0.6F, false, wound_rad).time;
  };
  CHECK(cost_wound(3.5F, -0.6F) < cost_wound(3.5F, 0.6F) - 2.0F);
  CHECK(cost_wound(-3.5F, 0.6F) < cost_wound(-3.5F, -0.6F) - 2.0F);
  CHECK(cost_wound(1.0F, 0.3F) == cost_wound(0.0F, 0.3F));  // within half a circle it may turn either way
  CHECK(cost_wound(5.0F, 0.0F) == Approx(cost_wound(0.0F, 0.0F) + 6.0F * (5.0F - 3.14159F)).margin(0.01));
}

TEST_CASE("a trajectory is given up only where its whole cost is above the bound: what its end takes back counts") {
  const Scene scene(1.6F);
  Trajectory ahead;
  ahead.commands.fill({0.6F, 0.0F});
  const float whole = scene.cost_of(ahead).total();
  REQUIRE(whole < 4.0F);  // it arrives
  CHECK(trajectory_cost(scene.situation, ahead, whole + 0.01F).total() == whole);
  CHECK(trajectory_cost(scene.situation, ahead, whole - 0.01F).total() > whole - 0.01F);
}

TEST_CASE("where nothing looks behind, it backs at its speed only as far as it has driven forward") {
  Scene scene;
  scene.situation.start.v = -0.3F;
  const auto backed = [&scene](KnownBehind known) {
    scene.situation.known_behind = known;
    std::array<RobotState, kSteps> driven{};
    CHECK(scene.cost_of(Command{-0.3F, 0.0F}, driven.data()).total() < 1e9F);
    return driven;
  };
  CHECK(backed(KnownBehind(false)).back().x == Approx(-1.8F).margin(0.05));
  KnownBehind known(true);
  known.drive(0.6F, 0.5F);  // 0.3 m
  CHECK(backed(known)[8].v == -0.3F);
  CHECK(backed(known).back().v == Approx(-0.12F).margin(1e-3));
  CHECK(backed(known).back().x == Approx(-0.3F - 5.0F * 0.12F).margin(0.1));
}

TEST_CASE("with a heading wanted at the goal, to set out later costs, though it turns after the trajectory's end") {
  Scene scene(2.7F);
  scene.situation.goal_heading = -1.9F;
  scene.situation.wants_heading = true;
  const auto cost_after = [&](int steps) {
    Trajectory ahead;
    std::fill(ahead.commands.begin() + steps, ahead.commands.end(), Command{0.6F, 0.0F});
    const int there = std::min(45 + steps, kSteps);  // within 0.24 m of it
    std::fill(ahead.commands.begin() + there, ahead.commands.end(), Command{0.0F, -0.6F});
    return scene.cost_of(ahead).time;
  };
  CHECK(cost_after(10) > cost_after(0) + 0.7F);
  CHECK(cost_after(30) > cost_after(0) + 2.0F);
}

TEST_CASE("who has stood for long is a surface as wide as a person, though the map holds nothing of him") {
  const auto cost_beside = [](float left_m, float stood_s) {
    MoverBelief him{.id = 1, .x = 1.0F, .y = left_m, .radius_m = 0.25F, .usual_mps = 0.6F};
    him.is_pedestrian = true, him.stood_s = stood_s;
    return Scene(4.0F, {&him, 1}).cost_of(Command{0.3F, 0.0F});
  };
  const float side = static_cast<float>(p3dx().footprint.half_width_m) + 0.25F;
  CHECK(cost_beside(side + 0.15F, 10.0F).touch > 400.0F);  // no nearer than kFromStanding_m
  CHECK(cost_beside(side + 0.25F, 10.0F).touch == 0.0F);
  CHECK(cost_beside(side + 0.25F, 10.0F).clearance > cost_beside(side + 0.35F, 10.0F).clearance);
  CHECK(cost_beside(side + 0.1F, 1.0F).clearance == 0.0F);  // may go on at once, and is met, not passed
}

TEST_CASE(
    "the supervisor's braking is foreseen: slowly past a place 6 cm beside the way, whatever the map holds of it") {
  LaserScan scan;
  scan.beam_count = 3;
  scan.first_angle_rad = 0.5F, scan.angle_step_rad = 0.1F;
  scan.range_min_m = 0.02F, scan.range_max_m = 20.0F;
  const float ahead = 0.4F, left = static_cast<float>(p3dx().footprint.half_width_m) + 0.06F;
  scan.range_m[1] = std::sqrt(ahead * ahead + left * left);
  scan.first_angle_rad = std::atan2(left, ahead) - scan.angle_step_rad;
  NearReturns returns;
  returns.update(SeenFrom{&scan, {}}, {}, body_of(0.6F), {}, {});
  struct Passed {
    float braked_s, least_mps;
  };
  const auto pass_at = [](float speed, const NearReturns& seen) {
    Scene scene(5.6F, {}, seen);
    scene.ground.wall({-1.0, 0.4}, {0.5, 0.4});
    scene.settle();
    scene.situation.start.v = speed;
    RobotState driven[kSteps];
    const float braked_s = scene.cost_of(Command{speed, 0.0F}, driven).stop_zone;
    return Passed{braked_s, std::ranges::min_element(driven, {}, [](const RobotState& r) { return r.v; })->v};
  };
  const float permitted = StopZoneRules<float>::permitted_rim(0.06F);
  CHECK(pass_at(0.6F, returns).least_mps <= permitted);
  CHECK(pass_at(0.3F, returns).least_mps <= permitted);
  CHECK(pass_at(0.3F, returns).braked_s > 0.5F);
  CHECK(pass_at(0.3F, returns).braked_s < pass_at(0.6F, returns).braked_s);
  CHECK(pass_at(0.08F, returns).braked_s == 0.0F);
  CHECK(pass_at(0.6F, kNothing).braked_s == 0.0F);
  CHECK(pass_at(0.6F, kNothing).least_mps >= 0.599F);
}

TEST_CASE("beside who stands the way costs, and not the time: waiting there gains nothing") {
  const auto nearness_at = [](float speed, float walks_mps) {
    MoverBelief beside{.id = 1, .x = 0.3F, .y = 0.8F, .vx = walks_mps, .radius_m = 0.25F, .usual_mps = 0.4F};
    beside.is_pedestrian = true, beside.stood_s = walks_mps > 0.0F ? 0.0F : 1000.0F;
    Scene scene(4.0F, {&beside, 1});
    scene.situation.start.v = speed;
    return scene.cost_of(Command{speed, 0.0F}).nearness;
  };
  CHECK(nearness_at(0.0F, 0.0F) < 0.02F);
  CHECK(nearness_at(0.1F, 0.0F) > 0.1F);
  CHECK(nearness_at(0.0F, 0.1F) > 0.1F);  // who walks comes nearer by itself
}

TEST_CASE("in a walker's way already, to drive into the walker costs more than to stand") {
  const MoverBelief comes{.id = 1, .x = 1.0F, .vx = -0.4F, .radius_m = 0.25F, .usual_mps = 0.4F, .is_pedestrian = true};
  const Scene scene(4.0F, {&comes, 1});
  CHECK(scene.cost_of(Command{0.3F, 0.0F}).conflict > scene.cost_of(Command{}).conflict + 50.0F);
}

namespace {

MoverBelief coming(float from_m) {
  return {.id = 1, .x = from_m, .vx = -1.2F, .radius_m = 0.25F, .usual_mps = 1.2F, .is_pedestrian = true};
}

/// A robot at 0.6 m/s, and a pedestrian that comes towards it at 1.2 m/s from so far ahead.
struct Oncoming : Scene {
  explicit Oncoming(float from_m) : Scene(5.6F, std::array{coming(from_m)}) {
    body = robot_body(p3dx().footprint, p3dx().limits, p3dx().laser, 1.0);
    situation.start.v = 0.6F;
  }
  using Scene::cost_of;
  [[nodiscard]] Cost cost_of(float until_v_mps, int after, bool brakes) const {
    Trajectory trajectory;
    trajectory.commands.fill({until_v_mps, 0.0F});
    std::fill(trajectory.commands.begin() + after, trajectory.commands.end(), Command{0.0F, 0.0F, brakes});
    return cost_of(trajectory);
  }
};

}  // namespace

TEST_CASE("a trajectory is unsafe that still moves when somebody is touched within two seconds") {
  const Oncoming far(2.2F);  // 1.65 m between them: met after 0.9 s, or after 1.4 s by a robot that has stopped
  CHECK_FALSE(far.cost_of(0.6F, kSteps, false).is_safe());
  CHECK_FALSE(far.cost_of(0.6F, 0, false).is_safe());  // within the comfort of 0.75 m/s3 it stops in 1.8 s
  CHECK(far.cost_of(0.0F, 0, true).is_safe());
  CHECK(Oncoming(5.0F).cost_of(0.6F, kSteps, false).is_safe());  // decided on again in time
}

TEST_CASE("among trajectories that all touch somebody while moving the slower and later one is better") {
  const Oncoming near(0.9F);  // 0.35 m between them
  const Cost brakes = near.cost_of(0.0F, 0, true), slows = near.cost_of(0.0F, 0, false),
             later = near.cost_of(0.6F, 3, true), drives = near.cost_of(0.6F, kSteps, false);
  for (const Cost& cost : {brakes, slows, later, drives}) CHECK_FALSE(cost.is_safe());
  CHECK(brakes.is_better_than(slows));
  CHECK(brakes.is_better_than(later));
  CHECK(slows.is_better_than(drives));
  CHECK(brakes.conflict < slows.conflict);
  CHECK(slows.conflict < drives.conflict);
}

TEST_CASE("having lost many seconds it asks people to let it pass, and touches none for that") {
  const auto conflict_after = [](float lost_s, float from_m) {
    Oncoming comes(from_m);
    comes.situation.stall.lost_s = lost_s;
    return comes.cost_of(0.6F, kSteps, false).conflict;
  };
  CHECK(conflict_after(20.0F, 5.0F) == conflict_after(0.0F, 5.0F));
  CHECK(conflict_after(20.5F, 5.0F) == Approx(0.5F * conflict_after(0.0F, 5.0F)));
  CHECK(conflict_after(60.0F, 0.9F) > 100.0F);  // touched within kSafeForS
}

TEST_CASE("where every trajectory touches somebody, the one that is at rest soonest is proposed and is best") {
  const Oncoming near(0.9F);
  const TrajectoryProposals proposals(near.situation, 0.0F);
  Cost best{.time = 1e9F, .hit_share = 1.0F};
  std::array<RobotState, kSteps> driven{}, best_driven{};
  Trajectory trial;
  proposals.each(trial, [&](const Trajectory& proposed) {
    const Cost cost = near.cost_of(proposed, driven.data());
    CHECK_FALSE(cost.is_safe());
    if (cost.is_better_than(best)) best = cost, best_driven = driven;
  });
  CHECK(best_driven[5].v == Approx(0.0F).margin(1e-5));  // 0.6 m/s at 1 m/s2
}

TEST_CASE("perturbations keep the brake on") {
  const Oncoming near(0.9F);
  const TrajectoryProposals proposals(near.situation, 0.0F);
  Trajectory brakes, trial;
  brakes.commands.fill({0.0F, 0.0F, true});
  for (int n = 0; n < 24; ++n) {
    proposals.perturb(brakes, 1, 0, n, trial);
    for (const Command& c : trial.commands) CHECK((c.brakes && c.v == 0.0F));
  }
  CHECK(shifted(brakes, 0.25F).commands[0].brakes);
}
