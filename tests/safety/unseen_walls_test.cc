// Corners that swing where nothing looks: into no wall that is seen elsewhere, nor into one that the map knows.
#include <random>

#include "tests/safety/driven_robot.h"
#include "tests/support/catch.h"

using namespace jaywalk;

namespace {

RobotModel looking(RobotModel model, double fov_deg) {
  model.laser.fov_rad = fov_deg * kPi / 180.0;
  model.laser.beams = static_cast<std::uint32_t>(3.0 * fov_deg) + 1;
  return model;
}

/// Along the right side, `gap_m` off, from 3 m behind to 3 m ahead.
Obstacle wall_beside(const RobotModel& model, double gap_m) {
  return {.centre = {0.0, -model.footprint.half_width_m - gap_m - 0.05}, .half = {3.0, 0.05}};
}

/// Noise of a laser, the same in every run.
struct Noise {
  std::mt19937 random{1};
  void operator()(LaserScan& scan) {
    std::uniform_real_distribution<float> metres(-0.017F, 0.017F);  // a standard deviation of 1 cm
    for (std::size_t k = 0; k < scan.beam_count; ++k) scan.range_m[k] += metres(random);
  }
};

}  // namespace

TEST_CASE("a robot that turns or curves beside a wall does not swing its rear into the part that it does not see") {
  const RobotModel body = GENERATE(p3dx(), wheelchair());
  const double fov_deg = GENERATE(180.0, 220.0, 270.0);
  const double gap_m = GENERATE(0.03, 0.05, 0.1, 0.2);
  const Twist2 wish = GENERATE(Twist2{0.0, 1.0}, Twist2{0.0, 0.3}, Twist2{0.28, 0.5}, Twist2{0.1, 0.4});
  const RobotModel model = looking(body, fov_deg);
  DrivenRobot robot(model, {wall_beside(model, gap_m)});
  robot.spoil = Noise{};
  double least = 1.0;
  for (int tick = 0; tick < 150 && robot.pose().heading < 1.2; ++tick) {
    (void)robot.tick(wish);
    least = std::min(least, robot.clearance_m());
  }
  CAPTURE(body.name, fov_deg, gap_m, wish.v_mps, wish.w_radps);
  CHECK(least > 0.005);
}

TEST_CASE("whatever it is asked for, it touches no wall that the map knows, whether its laser looks there or not") {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> part(-1.0, 1.0);
  for (const RobotModel& body : {p3dx(), wheelchair()}) {
    for (const double fov_deg : {180.0, 270.0}) {
      for (int run = 0; run < 6; ++run) {
        const RobotModel model = looking(body, fov_deg);
        DrivenRobot robot(model, {wall_beside(model, 0.05 + 0.05 * run),
                                  {.centre = {-model.footprint.rear_m - 0.2, 0.3}, .half = {0.05, 1.0}}});
        robot.spoil = Noise{};
        robot.knows_obstacles = true;
        double least = 1.0;
        for (int wish = 0; wish < 40; ++wish) {
          const Twist2 twist{0.4 * part(random), part(random)};
          for (int tick = 0; tick < 25; ++tick) {
            (void)robot.tick(twist);
            if (tick % 5 == 0) least = std::min(least, robot.clearance_m());
          }
        }
        INFO(body.name << ", " << fov_deg << " degrees, run " << run);
        CHECK(least > 0.005);
      }
    }
  }
}

TEST_CASE("a wall that ends where sight does is continued, one that would cut the body or turns off is not") {
  const RobotModel model = looking(p3dx(), 180.0);
  const auto points = [&](const std::vector<Obstacle>& obstacles) {
    DrivenRobot robot(model, obstacles);
    (void)robot.tick({});
    BlindGaps gaps(model.laser);
    gaps.update(robot.scan());
    UnseenWalls walls(model.footprint, 6.0);
    walls.update(robot.scan(), gaps, {});
    return std::vector<Vec2>(walls.points().begin(), walls.points().end());
  };
  const std::vector<Vec2> beside = points({wall_beside(model, 0.1)});
  REQUIRE(beside.size() > 5);
  double rearmost = 0.0, rearmost_of_end = 0.0;
  for (const Vec2 p : beside) {
    CHECK(p.y == Approx(-0.3125).margin(0.002));  // 0.2125 + 0.1
    CHECK(p.x < 0.001);
    rearmost = std::min(rearmost, p.x);
  }
  CHECK(rearmost < -model.footprint.rear_m - 0.1);
  for (const Vec2 p : points({{.centre = {-1.485, -0.3405}, .half = {1.515, 0.05}}})) {  // 3 cm of it are seen
    CHECK(p.y == Approx(-0.2905).margin(0.01));
    rearmost_of_end = std::min(rearmost_of_end, p.x);
  }
  CHECK(rearmost_of_end < -model.footprint.rear_m - 0.1);
  CHECK(points({}).empty());
  CHECK(points({{.centre = {0.6, -1.0}, .half = {0.05, 0.8}}}).empty());  // ahead, aside, across: ends within sight
  for (const Vec2 p :
       points({{.centre = {0.0, -1.2}, .half = {0.05, 0.8}}}))  // 5 cm of its end: along the body, no way
    CHECK(p.y == Approx(-0.4).margin(0.01));                    // through it, as its face would go on
}
