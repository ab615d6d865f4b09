#include "hal/sim/social_walkers.h"

#include <cmath>
#include <functional>
#include <vector>

#include "hal/sim/simulation.h"
#include "hal/sim/world.h"
#include "tests/sim/made_worlds.h"
#include "tests/support/catch.h"

using namespace jaywalk;
using namespace jaywalk::sim;

namespace {

constexpr double kTick = 0.02;

Scenario room_with(const SocialSpec& spec) {
  Scenario scenario = in_room();
  scenario.model.laser.beams = 2;  // nobody looks
  scenario.social.push_back(spec);
  return scenario;
}

/// Lets the robot stand for so long.
void wait(World& world, double seconds, const std::function<void(const Truth&)>& look) {
  for (int k = 0; k < static_cast<int>(seconds / kTick + 0.5); ++k) {
    for (int step = 0; step < kStepsAMove; ++step) world.step();
    look(world.truth());
  }
}

/// One walker in a room of 10 m, and a robot that can be put anywhere.
class OneWalker {
 public:
  OneWalker(Reaction reaction)
      : scenario_(room_with({.count = 1, .reaction = reaction})),
        walls_(load_aria_map(scenario_.map_file)),
        grid_(walls_, 0.19, scenario_.start.position(), scenario_.goal),
        walkers_({scenario_, walls_, grid_}, 3, 0, {}) {
    for (int k = 0; k < 100; ++k) step({-50.0, -50.0, 0.0});  // it has begun to walk
  }
  void step(const Pose2& robot) { walkers_.step(kTick, {p3dx().footprint, robot}, {}, {}); }
  /// Stands ahead of the walker at so many metres.
  [[nodiscard]] Pose2 ahead(double way_m, double bearing = 0.0) const {
    const Vec2 at = here().position + direction(here().heading + bearing) * way_m;
    return {at.x, at.y, 0.0};
  }
  [[nodiscard]] const MoverTruth& here() const { return walkers_.movers()[0]; }
  [[nodiscard]] double speed() const { return norm(here().velocity); }
  [[nodiscard]] const SocialMeasures& caused() const { return walkers_.caused(); }

 private:
  Scenario scenario_;
  Walls walls_;
  FreeGrid grid_;
  SocialWalkers walkers_;
};

/// Least and mean distance (m) of the walker to a robot that stands 2.5 m ahead for 10 s.
struct Kept {
  double least_m = 100.0, last_m = 0.0, slowest_mps = 100.0;
};

Kept kept_from(Reaction reaction, double bearing = 0.0) {
  OneWalker one(reaction);
  const Pose2 robot = one.ahead(2.5, bearing);
  Kept kept;
  for (int k = 0; k < 500; ++k) {
    one.step(robot);
    kept.last_m = distance(one.here().position, robot.position());
    kept.least_m = std::min(kept.least_m, kept.last_m);
    if (k > 50) kept.slowest_mps = std::min(kept.slowest_mps, one.speed());
  }
  return kept;
}

}  // namespace

TEST_CASE("social movers stay in the room, walk at the speeds that they wish, and are the same again") {
  const Scenario scenario = room_with({.count = 8, .reaction = Reaction::kMixed});
  World world(scenario, 4), again(scenario, 4);
  double way_m = 0.0;
  wait(world, 60.0, [&](const Truth& truth) {
    for (const MoverTruth& m : truth.movers) {
      REQUIRE(world.walls().distance(m.position, 1.0) > 0.5 * m.radius_m);
      REQUIRE(norm(m.velocity) < 1.69 * 1.52 * 1.34);
      way_m += norm(m.velocity) * kTick;
    }
  });
  CHECK(way_m > 8 * 60.0 * 0.5);
  wait(again, 60.0, [](const Truth&) {});
  for (std::size_t k = 0; k < 8; ++k) CHECK(again.truth().movers[k].position == world.truth().movers[k].position);
  CHECK(again.truth().social.turned_rad == world.truth().social.turned_rad);
  CHECK(world.truth().social.personal_s > 1.0);
}

TEST_CASE("a regular walker goes round a standing robot and is slowed and turned by it") {
  OneWalker one(Reaction::kRegular);
  const double before_m = one.caused().slowed_m;
  const Pose2 robot = one.ahead(1.5);
  for (int k = 0; k < 100; ++k) {
    one.step(robot);
    REQUIRE(RobotBody{p3dx().footprint, robot}.gap({one.here().position, 0.25}) > 0.0);
  }
  CHECK(one.caused().slowed_m > before_m + 0.02);
  CHECK(one.caused().turned_rad > 0.02);
}

TEST_CASE("a surprised walker stands and looks at a robot within 4 m that it sees, and not at one behind it") {
  CHECK(kept_from(Reaction::kSurprised).slowest_mps < 0.05);
  OneWalker one(Reaction::kSurprised);
  const Pose2 behind = one.ahead(2.0, kPi);
  for (int k = 0; k < 50; ++k) one.step(behind);
  CHECK(one.speed() > 0.5);
  const Pose2 seen = one.ahead(3.0, 1.0);
  for (int k = 0; k < 100; ++k) one.step(seen);
  const Vec2 to_robot = seen.position() - one.here().position;
  CHECK(std::fabs(wrap_angle(one.here().heading - jaywalk::atan2(to_robot.y, to_robot.x))) < 0.1);
  for (int k = 0; k < 1500; ++k) one.step(seen);  // its 30 s are over
  CHECK(one.speed() > 0.5);
}

TEST_CASE("a curious walker comes to 1.5 m, an afraid one stays away, a hurried one passes close") {
  const Kept curious = kept_from(Reaction::kCurious), afraid = kept_from(Reaction::kAfraid);
  CHECK(curious.last_m == Approx(1.5).margin(0.1));
  CHECK(afraid.least_m > kept_from(Reaction::kRegular).least_m + 0.3);
  CHECK(kept_from(Reaction::kHurried).least_m < afraid.least_m);
}

TEST_CASE("three that walk together stay together") {
  World world(room_with({.count = 3, .group = 3}), 5);
  double apart_m = 0.0;
  int ticks = 0;
  wait(world, 60.0,
       [&](const Truth& truth) { apart_m += distance(truth.movers[0].position, truth.movers[1].position), ++ticks; });
  CHECK(apart_m / ticks < 1.8);
}

TEST_CASE("times in intimate and personal space are those of the nearest mover's middle to the outline") {
  // A P3-DX's front is 0.227 m ahead of its axle (hal/types/robot_model.cc). A recorded walker stands 0.4 m before it
  // for 2 s, and then 1.0 m before it for 3 s.
  Scenario scenario = in_room();
  const double front_m = 5.0 + scenario.model.footprint.front_m;
  const auto row = [&](double t_s, double way_m) {
    return std::to_string(t_s) + ",1," + std::to_string(front_m + way_m) + ",5.0\n";
  };
  const std::string rows = "t_s,id,x_m,y_m\n" + row(0.0, 0.4) + row(2.0, 0.4) + row(2.001, 1.0) + row(5.0, 1.0);
  scenario.recorded.push_back({.file = folder().write("walker.csv", rows)});
  World world(scenario, 1);
  wait(world, 8.0, [](const Truth&) {});
  CHECK(world.truth().social.intimate_s == Approx(2.0).margin(0.021));
  CHECK(world.truth().social.personal_s == Approx(3.0).margin(0.041));
  CHECK(world.truth().social.slowed_m == 0.0);
}
