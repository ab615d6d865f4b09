#include "planner/motion/speed_choice.h"

#include <array>

#include "tests/support/catch.h"

using namespace jaywalk;

namespace {

/// Straight ahead along +x from the origin, 10 m in steps of 0.1 m.
Path straight_path() {
  Path path;
  for (int k = 0; k <= 100; ++k) REQUIRE(path.push_back({0.1 * k, 0.0}));
  return path;
}

Track walker(Vec2 position, Vec2 velocity) {
  Track track;
  track.position_in_map = position;
  track.velocity_in_map = velocity;
  track.radius_m = 0.27;
  track.moving = true;
  return track;
}

const SpeedChoiceConfig kConfig{.robot = {.radius_m = 0.3}, .max_speed_mps = 0.6, .max_accel_mps2 = 0.5};

}  // namespace

TEST_CASE("with nobody about the robot goes at full speed, with no path it stays") {
  CHECK(choose_speed({straight_path()}, {}, 0.6, {}, kConfig) == 0.6);
  CHECK(choose_speed({Path{}}, {}, 0.6, {}, kConfig) == 0.0);
}

TEST_CASE("somebody who crosses ahead is let pass") {
  // Robot at 0.6 m/s reaches x = 1.5 in 2.5 s; the walker crosses there from y = -1.2 at 0.4 m/s in 3 s.
  const std::array crossing{walker({1.5, -1.2}, {0.0, 0.4})};
  CHECK(choose_speed({straight_path()}, {}, 0.6, crossing, kConfig) < 0.6);
}

TEST_CASE("somebody not yet called moving counts when clearly under way, and not when the speed may be noise") {
  Track crossing = walker({1.5, -1.2}, {0.0, 0.4});
  crossing.moving = false;
  crossing.covariance.vv = 0.1 * 0.1;  // 0.4 m/s is four standard deviations
  CHECK(choose_speed({straight_path()}, {}, 0.6, std::array{crossing}, kConfig) < 0.6);
  crossing.covariance.vv = 0.3 * 0.3;  // and here one and a third
  CHECK(choose_speed({straight_path()}, {}, 0.6, std::array{crossing}, kConfig) == 0.6);
}

TEST_CASE("where every speed meets somebody at once the robot stands, and does not wait for who has stopped") {
  SpeedChoiceConfig stands = kConfig;
  stands.stands_at_worst = true;
  for (const double away_m : {0.7, 1.0, 1.3})
    CHECK(choose_speed({straight_path()}, {}, 0.0, std::array{walker({away_m, 0.0}, {-0.8, 0.0})}, stands) == 0.0);
  CHECK(choose_speed({straight_path()}, {}, 0.0, std::array{walker({0.5, 0.4}, {0.05, 0.0})}, stands) == 0.6);
}

TEST_CASE("somebody who walks away behind does not slow the robot") {
  const std::array leaving{walker({-1.2, 0.0}, {-0.4, 0.0})};
  CHECK(choose_speed({straight_path()}, {}, 0.6, leaving, kConfig) == 0.6);
}

TEST_CASE("a walker minds what stands in the 45 degrees ahead and not what stands abeam") {
  // Robot disc of 0.3 m, walker of 0.27 m, both counted from their edges: 1.0 m apart leaves 0.43 m.
  CHECK(in_conflict({1.0, 0.0}, {1, 0}, {{0, 0}, {0.4, 0.0}, 0.27, 0.0}, kConfig));
  CHECK_FALSE(in_conflict({0.0, 1.0}, {1, 0}, {{0, 0}, {0.4, 0.0}, 0.27, 0.0}, kConfig));
  CHECK_FALSE(in_conflict({-1.0, 0.0}, {1, 0}, {{0, 0}, {0.4, 0.0}, 0.27, 0.0}, kConfig));
  CHECK(in_conflict({-0.7, 0.0}, {1, 0}, {{0, 0}, {0.4, 0.0}, 0.27, 0.0},
                    kConfig));  // 0.13 m: too near for any direction
}

TEST_CASE("a long body's corners meet who walks before it, and its sides let pass who walks beside it") {
  SpeedChoiceConfig chair = kConfig;
  chair.robot = {.footprint = wheelchair().footprint};
  chair.stands_at_worst = true;
  // Both stand still for the other in time: it crosses 0.5 m before its front, 1.25 m before its axle.
  const std::array crossing{walker({1.25 + 0.27, -0.6}, {0.0, 0.8})};
  CHECK(choose_speed({straight_path()}, {}, 0.6, crossing, kConfig) > 0.0);
  CHECK(choose_speed({straight_path()}, {}, 0.6, crossing, chair) == 0.0);
  const std::array along{walker({0.6, 1.2}, {0.6, 0.0})};  // 0.6 m from its side, at its speed
  CHECK(choose_speed({straight_path()}, {}, 0.6, along, chair) == 0.6);
}

TEST_CASE("a footprint is in somebody's way with a corner, or lying across it, and not beside it") {
  const RobotShape chair{.footprint = wheelchair().footprint};  // 0.75 m ahead, 0.35 m behind, 0.325 m aside
  const Vec2 ahead{1.0, 0.0};
  CHECK(chair.distance_to({1.25, 2.0}, {0.0, 2.0}, ahead) == Approx(0.5));
  CHECK(chair.distance_to({0.0, 3.25}, {0.0, 2.0}, {0.0, 1.0}) == Approx(0.5));
  CHECK(chair.out_of_way({0.2, -2.0}, {0.0, 1.0}, {}, ahead) < 0.0);   // straight for its side
  CHECK(chair.out_of_way({-1.2, -1.2}, {0.0, 1.0}, {}, ahead) < 0.0);  // (-0.35, 0.325) lies 0.85 aside, 1.53 ahead
  CHECK(chair.out_of_way({-2.5, -1.2}, {0.0, 1.0}, {}, ahead) > 0.0);
  CHECK(chair.out_of_way({0.2, -2.0}, {0.0, -1.0}, {}, ahead) > 0.0);
  CHECK(chair.out_of_way({0.75 + 1.0, 0.0}, {0.0, 1.0}, {}, ahead) == Approx((1.0 - 0.325) * 0.7071).margin(1e-4));
}

TEST_CASE("on a manoeuvre that backs, the body lies behind as it looks, and not as it goes") {
  SpeedChoiceConfig chair = kConfig;
  chair.robot = {.footprint = wheelchair().footprint};
  Path back, looking;
  for (int k = 0; k <= 10; ++k) REQUIRE((back.push_back({-0.1 * k, 0.0}) && looking.push_back({1.0, 0.0})));
  const std::array crossing{walker({-2.4, -0.8}, {0.0, 0.6})};  // 0.78 m behind where its rear will be at last
  CHECK(choose_speed({back, &looking}, {}, 0.0, crossing, chair) == 0.6);
}
