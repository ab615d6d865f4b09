// What the robot sees of itself, a mast, a rider's feet, must not hide or invent anybody.
#include <algorithm>
#include <memory>

#include "hal/types/robot_model.h"
#include "tests/perception/watch.h"
#include "tests/support/catch.h"

using namespace jaywalk;
using namespace jaywalk::test;

namespace {

/// A robot that carries things, by the discs that they are in its own frame.
struct Carrier {
  std::unique_ptr<Watch> watch = std::make_unique<Watch>();
  std::vector<Disc> own;

  void see(Room room, const Pose2& robot = {}) {
    for (const Disc& d : own) room.discs.push_back({robot * d.centre, d.radius_m});
    watch->see(room, robot);
  }
  /// Six turns round: it knows what it carries by then.
  void turn_round() {
    for (int k = 0; k <= 300; ++k) see(with({}), {0.0, 0.0, wrap_angle(6.0 * 2.0 * kPi * k / 300)});
  }
  [[nodiscard]] const Track* track_near(Vec2 place) const {
    return test::track_near(watch->tracker.tracks(), place, 0.5);
  }
};

/// A robot whose laser is told where it sees the robot itself.
struct Blanked {
  std::unique_ptr<Watch> watch = std::make_unique<Watch>();
  Blanking own;

  Blanked(std::initializer_list<BlankedSector> sectors) {
    for (const BlankedSector& sector : sectors) (void)own.push_back(sector);
  }
  void see(const Room& room, const Pose2& robot) {
    LaserScan scan = scan_of(room, robot, ++watch->scan, kNoiseM);
    blank(own, scan);
    watch->tracker.update(scan, robot, {0.6, -0.06});
    watch->most_moving = std::max(watch->most_moving, watch->tracker.moving().size());
  }
};

}  // namespace

TEST_CASE("who comes where a rider's feet were is seen, feet withdrawn or not") {
  for (const bool withdrawn : {true, false}) {
    Carrier robot;
    robot.own = {{{0.5, -0.15}, 0.06}, {{0.5, 0.15}, 0.06}};
    robot.turn_round();
    if (withdrawn) robot.own.clear();
    const Vec2 way = direction(withdrawn ? 0.29 : 0.0);  // over the left foot, or between both
    for (int k = 0; k <= 60; ++k) robot.see(with({{way * (4.0 - 0.04 * k), 0.15}}));
    const Track* const comes = robot.track_near(way * 1.6);
    REQUIRE(comes != nullptr);
    CHECK(comes->moving);
  }
}

TEST_CASE("who comes out from behind blanked beams is seen to move") {
  Blanked robot({{0.35, 0.65}, {-0.65, -0.35}});
  const auto walker = [](double k) { return Disc{{3.0, 2.5 - 0.05 * k}, 0.25}; };
  for (int k = 0; k < 50; ++k) robot.see(with({walker(k)}), {});
  CHECK(distance(only_mover(robot.watch->tracker).position_in_map, walker(49).centre) < 0.2);
}

TEST_CASE(
    "what comes into view beside blanked beams may go on behind them: nothing moves, before the robot has turned, "
    "too") {
  Blanked robot({{0.57, 0.89}, {-0.8, -0.43}});
  const Room room = with({{{2.04, -2.42}, 0.38}, {{-2.39, 1.47}, 0.18}, {{3.6, -2.47}, 0.27}},
                         {{{-1.7, 1.09}, {-2.08, 1.35}}, {{0.43, 2.63}, {0.69, 3.33}}});
  for (int k = 0; k < 150; ++k) {  // 0.6 m/s, and a quarter radian to the right in four seconds
    const double heading = -0.0042 * k;
    robot.see(room, {-4.0 + 0.04 * k, 0.3 * heading, heading});
  }
  CHECK(robot.watch->most_moving == 0);
}

TEST_CASE("who stands in the middle of the robot's way round him is somebody all the time") {
  Carrier robot;
  for (int k = 0; k < 240; ++k) {
    const double round = 0.03 * std::max(0, k - 30);  // rad; once round, from the third second on
    robot.see(with({{{}, 0.25}}), Pose2{0.0, 0.0, wrap_angle(round)} * Pose2{0.8, 0.0, kPi / 2});
  }
  CHECK(robot.track_near({}) != nullptr);
  CHECK(robot.watch->most_moving == 0);
}

TEST_CASE("who stands half behind the robot's mast is not whole, and stands while the robot sways") {
  Carrier robot;
  robot.own = {{{0.5, 0.0}, 0.03}};
  robot.turn_round();
  for (int k = 0; k < 20; ++k) robot.see(with({}));
  const Vec2 place{2.5, 0.0};
  double farthest_m = 0.0, fastest_mps = 0.0;
  for (int k = 0; k < 120; ++k) {
    robot.see(with({{place, 0.27}}), {0.0, 0.0, 0.25 * direction(0.1 * k).y});
    const Track* const track = robot.track_near(place);
    if (k < 20 || track == nullptr) continue;
    farthest_m = std::max(farthest_m, distance(track->position_in_map, place));
    fastest_mps = std::max(fastest_mps, norm(track->velocity_in_map));
  }
  CHECK(robot.watch->most_moving == 0);
  CHECK(farthest_m < 0.15);
  CHECK(fastest_mps < 0.3);
}

TEST_CASE("who goes behind beams that are blocked for good walks on there as behind anything else") {
  Watch watch;
  watch.fan = {.beams = 1081, .first_rad = -kPi, .step_rad = 2.0 * kPi / 1081};
  const auto see = [&](const Room& room, const Pose2& robot) {
    LaserScan scan = scan_of(room, robot, ++watch.scan, kNoiseM, watch.fan);
    for (std::size_t b = 0; b < scan.beam_count; ++b)
      if (scan.angle_rad(b) > 0.5 * kPi) scan.range_m[b] = 0.0F;  // the chair's back
    watch.tracker.update(scan, robot);
  };
  for (int k = 0; k < 30; ++k) see(with({}), {0.0, 0.0, 0.05 * (k - 30)});
  for (int k = 0; k < 46; ++k) see(with({{{3.0 - k / 15.0, 2.5}, 0.25}}), {});  // 1 m/s, half behind it
  const Track& goes = only_mover(watch.tracker);
  CHECK(distance(goes.position_in_map, {0.0, 2.5}) < 0.06);
  CHECK(goes.velocity_in_map.x == Approx(-1.0).margin(0.15));
}
