#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "hal/sim/movers.h"
#include "hal/sim/simulation.h"
#include "tests/sim/made_worlds.h"
#include "tests/support/catch.h"

using namespace jaywalk;
using namespace jaywalk::sim;

namespace {

constexpr double kTick = 0.02;

using Movers = std::vector<MoverTruth>;

/// Lets the robot stand, and shows the movers before and after each of their steps.
void watch(Simulation& sim, double seconds, const std::function<void(const Movers&, const Movers&)>& look) {
  const auto now = [&] { return Movers(sim.truth().movers.begin(), sim.truth().movers.end()); };
  Movers before = now();
  drive(sim, 0.0, 0.0, seconds, [&] {
    const Movers after = now();
    look(before, after);
    before = after;
  });
}

bool walks(const MoverTruth& m) { return norm(m.velocity) > 0.0; }

/// The rule in its own words: within `reach` of the mover's edge and within `half_angle` of its heading.
bool ahead(const MoverTruth& m, Vec2 p, double reach, double half_angle) {
  const Vec2 to = p - m.position;
  return norm(to) <= m.radius_m + reach && std::fabs(wrap_angle(jaywalk::atan2(to.y, to.x) - m.heading)) <= half_angle;
}

bool any_point(Vec2 from, Vec2 to, const std::function<bool(Vec2)>& holds) {
  const int count = static_cast<int>(distance(from, to) / 0.01) + 1;
  for (int k = 0; k <= count; ++k) {
    if (holds(from + (to - from) * (static_cast<double>(k) / count))) return true;
  }
  return false;
}

struct Slack {
  double reach, half_angle;
};
// Movers step one after the other, 8 mm at most; test points lie 1 cm apart.
constexpr Slack kGenerous{0.53, kPi / 4 + 0.06}, kStrict{0.47, kPi / 4 - 0.06};

bool wall_ahead(const Simulation& sim, const MoverTruth& m, Slack slack) {
  return std::any_of(sim.walls().begin(), sim.walls().end(), [&](const WallSegment& wall) {
    return distance(m.position, wall) < 1.0 &&
           any_point(wall.from, wall.to, [&](Vec2 p) { return ahead(m, p, slack.reach, slack.half_angle); });
  });
}

bool mover_ahead(const Movers& all, const MoverTruth& m, Slack slack) {
  return std::any_of(all.begin(), all.end(), [&](const MoverTruth& other) {
    if (other.id == m.id || distance(other.position, m.position) > 1.5) return false;
    for (int k = 0; k < 360; ++k) {
      if (ahead(m, other.position + direction(k * kPi / 180) * other.radius_m, slack.reach, slack.half_angle))
        return true;
    }
    return false;
  });
}

bool robot_ahead(const Simulation& sim, const MoverTruth& m, Slack slack) {
  const Pose2& pose = sim.truth().map_from_robot;
  const Footprint body = p3dx().footprint;
  const double f = body.front_m, r = -body.rear_m, w = body.half_width_m;
  const Vec2 corners[] = {{f, w}, {r, w}, {r, -w}, {f, -w}, {f, w}};
  for (int k = 0; k < 4; ++k) {
    const auto holds = [&](Vec2 p) { return ahead(m, p, slack.reach, slack.half_angle); };
    if (any_point(pose * corners[k], pose * corners[k + 1], holds)) return true;
  }
  return false;
}

Scenario crowded_room(const WanderSpec& spec) {
  Scenario scenario = in_room();
  scenario.model.laser.beams = 2;  // nobody looks
  scenario.wanderers.push_back(spec);
  return scenario;
}

}  // namespace

TEST_CASE("movers walk at constant speed, straight, and turn only while they stand, at 1 rad/s") {
  Simulation sim(crowded_room({.count = 6}), 1);
  watch(sim, 300.0, [](const Movers& before, const Movers& after) {
    for (std::size_t k = 0; k < after.size(); ++k) {
      const Vec2 moved = after[k].position - before[k].position;
      if (walks(after[k])) {
        REQUIRE(norm(after[k].velocity) == Approx(0.4));
        REQUIRE(distance(moved, after[k].velocity * kTick) < 1e-12);
        REQUIRE(after[k].heading == before[k].heading);
      } else {
        REQUIRE(moved == Vec2{});
        REQUIRE(std::fabs(wrap_angle(after[k].heading - before[k].heading)) <= 1.0 * kTick + 1e-9);
      }
    }
  });
}

TEST_CASE("a mover stops only when something is ahead, and is forced only by the robot alone") {
  Simulation sim(crowded_room({.count = 6}), 1);
  int stops = 0, forced = 0;
  watch(sim, 600.0, [&](const Movers& before, const Movers& after) {
    for (std::size_t k = 0; k < after.size(); ++k) {
      const MoverTruth& m = after[k];
      if (walks(m)) {
        REQUIRE_FALSE(wall_ahead(sim, before[k], kStrict));
        REQUIRE_FALSE(m.forced);
      }
      if (!walks(before[k]) || walks(m)) continue;
      ++stops;
      const bool other = wall_ahead(sim, m, kGenerous) || mover_ahead(after, m, kGenerous);
      REQUIRE((other || robot_ahead(sim, m, kGenerous)));
      if (!m.forced) REQUIRE(other);
      if (!m.forced) continue;
      ++forced;
      REQUIRE(robot_ahead(sim, m, kGenerous));
      REQUIRE_FALSE(wall_ahead(sim, m, kStrict));
      REQUIRE_FALSE(mover_ahead(after, m, kStrict));
    }
  });
  CHECK(stops > 100);
  CHECK(forced > 5);
  CHECK(sim.truth().forced_movers >= static_cast<std::uint32_t>(forced));
}

TEST_CASE("a mover turns to a heading that is free: after the turn it walks") {
  Simulation sim(crowded_room({.count = 1}), 4);
  bool turned = false;
  int turns = 0;
  watch(sim, 300.0, [&](const Movers& before, const Movers& after) {
    const bool turns_now = after[0].heading != before[0].heading;
    if (turned && !turns_now) {
      REQUIRE(walks(after[0]));
      ++turns;
    }
    turned = turns_now;
  });
  CHECK(turns > 10);
}

TEST_CASE("a mover that would run into the robot beside it stays where it is, and that is a bump") {
  // The robot's narrow nose stands 1 mm from the mover's edge at 60 degrees to its heading, outside the zone; a step of
  // 8 mm would close the gap by 4 mm.
  const Scenario scenario = crowded_room({.count = 1});
  const Walls walls(load_aria_map(scenario.map_file));
  const FreeGrid grid(walls, 0.19, scenario.start.position(), scenario.goal);
  Wanderers wanderers({scenario, walls, grid}, 2);
  const MoverTruth mover = wanderers.movers()[0];
  const double bearing = mover.heading + kPi / 3;
  const Footprint narrow{.front_m = 0.2, .rear_m = 0.2, .half_width_m = 0.05};
  const Vec2 place = mover.position + direction(bearing) * (mover.radius_m + 0.001 + 0.2);
  const RobotBody robot{narrow, {place.x, place.y, wrap_angle(bearing + kPi)}};
  wanderers.step(kTick, robot, {});
  CHECK(wanderers.bumped_robot());
  CHECK(wanderers.forced() == 1);
  CHECK(wanderers.movers()[0].position == mover.position);
  wanderers.step(kTick, {narrow, {-50.0, -50.0, 0.0}}, {});
  CHECK_FALSE(wanderers.bumped_robot());
}

TEST_CASE("movers go through neither walls nor each other nor the robot in ten minutes") {
  Scenario scenario = load_scenario(JAYWALK_OWN_SCENARIOS "/map1_16.toml");
  scenario.model.laser.beams = 2;
  Simulation sim(scenario, 5);
  double to_wall = 1e9, to_mover = 1e9;
  watch(sim, 600.0, [&](const Movers&, const Movers& after) {
    for (std::size_t k = 0; k < after.size(); ++k) {
      for (const WallSegment& wall : sim.walls()) {
        to_wall = std::min(to_wall, distance(after[k].position, wall) - after[k].radius_m);
      }
      for (std::size_t other = 0; other < k; ++other) {
        to_mover = std::min(to_mover, distance(after[k].position, after[other].position) - 2 * after[k].radius_m);
      }
    }
  });
  CHECK(to_wall > 0.25);  // the zone is 0.77 / root 2 = 0.54 m wide from the middle: 0.27 m from the edge
  CHECK(to_mover > 0.0);
  CHECK(sim.truth().movers.size() == 16);
}

TEST_CASE("movers begin apart from walls, from each other, from the robot and from its goal") {
  const Scenario scenario = load_scenario(JAYWALK_OWN_SCENARIOS "/map4_16.toml");
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const Simulation sim(scenario, seed);
    const auto movers = sim.truth().movers;
    for (const MoverTruth& m : movers) {
      CHECK(distance(m.position, scenario.start.position()) >= 2.0);
      CHECK(distance(m.position, scenario.goal) >= 1.0);
      for (const MoverTruth& other : movers) {
        if (other.id < m.id) CHECK(distance(m.position, other.position) >= 2 * 0.27 + 0.5);
      }
      for (const WallSegment& wall : sim.walls()) CHECK(distance(m.position, wall) >= 0.27 + 0.3);
    }
  }
}

TEST_CASE("spontaneous turns come as often as asked: 0.5 a second of walking") {
  // A stop costs one step to choose and 1.6 / 50 s to turn on average: 1000 / (2.0 + 0.02 + 0.05) = 483 stops,
  // with a standard deviation of about 22.
  Simulation sim(crowded_room({.count = 1, .speed_mps = 0.001, .turn_rate_radps = 50.0, .spontaneous_turns_hz = 0.5}),
                 3);
  int stops = 0;
  watch(sim, 1000.0, [&](const Movers& before, const Movers& after) { stops += walks(before[0]) && !walks(after[0]); });
  CHECK(stops == Approx(483).margin(66));
}

TEST_CASE("too many movers for the room are refused") {
  const Scenario scenario = crowded_room({.count = 200});
  const std::string message = refusal_of([&] { const Simulation sim(scenario, 1); });
  CHECK(holds(message, "room.map: no room for mover"));
}
