// "Nothing within reach" is a claim, held against the scans before (SAFETY 29).
#include <cmath>
#include <functional>
#include <random>
#include <vector>

#include "firmware/safety/beam_filter.h"
#include "tests/safety/driven_robot.h"
#include "tests/support/catch.h"

using namespace jaywalk;

namespace {

constexpr double kDeg = kPi / 180.0;
constexpr float kFree = std::numeric_limits<float>::infinity();

/// A scanner of 10 m and 10 Hz on open ground, on a robot whose wheels are 1 m about.
class Eye {
 public:
  explicit Eye(bool all_round = false) : model_(p3dx()), filter_(model(all_round), 0) {}

  std::vector<Obstacle> things;
  Pose2 pose{};
  std::function<void(LaserScan&)> spoil = [](LaserScan&) {};

  /// The next scan as the filter leaves it, after the robot went so far by its wheels.
  const LaserScan& next(double way_m = 0.0, double turn_rad = 0.0) {
    const Vec2 way = direction(pose.heading + 0.5 * turn_rad) * way_m;
    pose = {pose.x + way.x, pose.y + way.y, pose.heading + turn_rad};
    const double half_track_m = 0.5 * model_.drive.track_width_m, radius_m = model_.drive.wheel_radius_m;
    wheels_.left_rad += (way_m - half_track_m * turn_rad) / radius_m;
    wheels_.right_rad += (way_m + half_track_m * turn_rad) / radius_m;
    now_ += std::chrono::milliseconds(100);
    wheels_.stamp = scan_.stamp = now_;
    ++wheels_.sequence, ++scan_.sequence;
    for (std::size_t k = 0; k < scan_.beam_count; ++k) {
      const Vec2 along = direction(pose.heading + scan_.angle_rad(k));
      double range = 1e9;
      for (const Obstacle& thing : things) range = std::min(range, thing.ray(pose.position(), along));
      scan_.range_m[k] = range < 10.0 ? static_cast<float>(range + 0.01 * noise_(random_)) : kFree;
    }
    spoil(scan_);
    filter_.filter(scan_, wheels_);
    return scan_;
  }
  [[nodiscard]] int doubted() const {
    const auto ranges = std::span(scan_.range_m).first(scan_.beam_count);
    return static_cast<int>(std::ranges::count(ranges, 0.0F));
  }
  [[nodiscard]] const WheelState& wheels() const { return wheels_; }
  [[nodiscard]] const RobotModel& robot() const { return model_; }

 private:
  RobotModel model(bool all_round) {
    const double fov = all_round ? 2.0 * kPi * 719 / 720 : 1.5 * kPi;
    model_.laser = {
        .robot_from_laser = {}, .fov_rad = fov, .beams = all_round ? 720U : 541U, .rate_hz = 10.0, .range_max_m = 10.0};
    scan_.beam_count = model_.laser.beams;
    scan_.first_angle_rad = static_cast<float>(all_round ? 0.0 : -0.5 * fov);
    scan_.angle_step_rad = static_cast<float>((all_round ? -1.0 : 1.0) * fov / (model_.laser.beams - 1));
    scan_.range_min_m = 0.05F;
    scan_.range_max_m = 10.0F;
    return model_;
  }

  RobotModel model_;
  LaserScan scan_{};
  BeamFilter filter_;
  WheelState wheels_{};
  Time now_{std::chrono::seconds(1)};
  std::mt19937_64 random_{1};
  std::normal_distribution<double> noise_;
};

std::function<void(LaserScan&)> silence(double half_rad) {
  return [half_rad](LaserScan& scan) {
    for (std::size_t k = 0; k < scan.beam_count; ++k)
      if (std::fabs(wrap_angle(scan.angle_rad(k))) <= half_rad) scan.range_m[k] = kFree;
  };
}

Obstacle wall_ahead(double x_m) { return {.centre = {x_m + 0.05, 0.0}, .half = {0.05, 3.0}}; }

}  // namespace

TEST_CASE("a sector whose hits turn free from one scan to the next is doubted, at rest and under way") {
  const bool all_round = GENERATE(false, true);
  const double wall_m = GENERATE(0.6, 1.0, 2.0, 4.0, 8.0);
  const double half_deg = GENERATE(10.0, 20.0, 40.0, 180.0);
  const double way_m = GENERATE_COPY(0.0, 0.015, 0.05 * std::min(1.0, wall_m - 0.6));
  Eye eye(all_round);
  eye.things = {wall_ahead(wall_m)};
  for (int k = 0; k < 5; ++k) REQUIRE((eye.next(way_m), eye.doubted() == 0));
  eye.spoil = silence(half_deg * kDeg);
  CAPTURE(all_round, wall_m, half_deg, way_m);
  for (int k = 0; k < 5; ++k) {
    const LaserScan& scan = eye.next(way_m);
    bool all = true;
    for (std::size_t beam = 0; beam < scan.beam_count; ++beam) {
      const double angle = std::fabs(wrap_angle(scan.angle_rad(beam)));
      const bool on_wall = angle <= half_deg * kDeg && angle < std::atan2(2.5, wall_m);
      all = all && (!on_wall || scan.range_m[beam] == 0.0F);
    }
    CHECK(all);
    CHECK(eye.doubted() > 10);
  }
}

TEST_CASE("people who walk on open ground and walls that end are no failure of the scanner") {
  const bool all_round = GENERATE(false, true);
  const double away_m = GENERATE(0.45, 0.8, 2.0, 5.0);
  const double speed_mps = GENERATE(0.3, 0.8, 1.4, 1.8);
  const bool across = GENERATE(true, false);
  Eye eye(all_round);
  CAPTURE(all_round, away_m, speed_mps, across);
  int doubted = 0;
  for (int k = 0; k < 60; ++k) {
    const double gone_m = speed_mps * 0.1 * (k - 20);
    const Vec2 body = across ? Vec2{away_m, gone_m} : Vec2{away_m + std::fabs(gone_m), 0.3};
    const double step_m = 0.35 * std::sin(0.2 * kPi * k);
    eye.things = {{.centre = Transform2(eye.pose) * body, .radius_m = 0.25},
                  {.centre = {-1.0, 3.0 + step_m}, .radius_m = 0.06},  // a leg that swings
                  {.centre = {0.0, -1.0}, .half = {1.5, 0.05}}};
    (void)eye.next(0.02, 0.01);
    doubted += eye.doubted();
  }
  CHECK(doubted == 0);
}

TEST_CASE("doubted beams are believed when they have hit something in two scans, those beside them with them") {
  Eye eye;
  eye.things = {wall_ahead(2.0)};
  (void)eye.next();
  eye.spoil = silence(4.0);
  (void)eye.next();
  REQUIRE(eye.doubted() > 200);
  eye.spoil = [](LaserScan&) {};
  (void)eye.next();
  CHECK(eye.doubted() > 0);  // one echo is dust
  (void)eye.next();
  CHECK(eye.doubted() == 0);
}

TEST_CASE("without a hit for two seconds nothing is believed free, until there is one again") {
  Eye eye;
  for (int k = 0; k < 20; ++k) CHECK((eye.next(), eye.doubted() == 0));
  for (int k = 0; k < 5; ++k) (void)eye.next();
  CHECK(eye.doubted() == 541);
  eye.things = {{.centre = {5.0, 0.0}, .radius_m = 0.2}};
  CHECK((eye.next(), eye.doubted() == 0));
}

TEST_CASE("a scan that was judged is left as it is: recordings replay") {
  Eye eye;
  BeamFilter again(eye.robot(), 0);
  eye.things = {wall_ahead(3.0), {.centre = {1.0, 2.0}, .radius_m = 0.3}};
  std::mt19937_64 random(7);
  for (int k = 0; k < 400; ++k) {
    if (k % 20 == 10) eye.spoil = silence(static_cast<double>(random() % 100) * kDeg);
    if (k % 20 == 15) eye.spoil = [](LaserScan&) {};
    LaserScan judged = eye.next(0.02 * std::cos(0.05 * k), 0.05 * std::sin(0.11 * k));
    const auto before = judged.range_m;
    again.filter(judged, eye.wheels());
    REQUIRE(judged.range_m == before);
  }
}
