#include "hal/sim/plant.h"

#include <cmath>
#include <limits>

#include "tests/support/catch.h"

using namespace jaywalk;
using namespace jaywalk::sim;

namespace {

constexpr double kStep = 0.002;
constexpr double kRadius = 0.0975, kTrack = 0.33;
constexpr double kTick = 2.0 * kPi / kTicksPerTurn;

/// Commands the plant at 50 Hz and moves it on.
class Drive {
 public:
  explicit Drive(const SlipSpec& slip = {}) : plant(p3dx(), {}, 1, slip) {}

  Plant plant;

  void run(double left, double right, double seconds, bool commands = true) {
    for (int k = 0; k < static_cast<int>(seconds / kStep + 0.5); ++k) {
      if (commands && k % 10 == 0) plant.command({now_, left, right}, now_);
      now_ += duration_from_seconds(kStep);
      plant.step(kStep, now_);
    }
  }
  void coast(double seconds) { run(0.0, 0.0, seconds, false); }
  WheelState read() { return plant.read_encoders(now_); }

 private:
  Time now_{};
};

}  // namespace

TEST_CASE("after one time constant of 50 ms a motor has 63.2 percent of its speed") {
  Drive drive;
  drive.run(0.5, 0.5, 0.05);
  CHECK(drive.plant.rim_speed() == Approx(0.5 * kRadius * (1.0 - std::exp(-1.0))).epsilon(0.02));
  drive.run(0.5, 0.5, 0.5);
  CHECK(drive.plant.rim_speed() == Approx(0.5 * kRadius).epsilon(0.001));
}

TEST_CASE("full speed is reached at the drive's 1.5 m/s2, 0.15 m/s after 0.1 s, and is 14 rad/s, 1.365 m/s") {
  Drive drive;
  drive.run(14.0, 14.0, 0.1);
  CHECK(drive.plant.rim_speed() == Approx(0.15));
  drive.run(14.0, 14.0, 0.1);
  CHECK(drive.plant.rim_speed() == Approx(0.30));
  drive.run(100.0, 100.0, 3.0);
  CHECK(drive.plant.twist().v_mps == Approx(14.0 * kRadius));
}

TEST_CASE("equal speeds drive straight, along the heading, as far as the wheels roll") {
  Drive drive;
  drive.run(0.5, 0.5, 10.0);
  const WheelState wheels = drive.read();
  CHECK(drive.plant.map_from_robot().x == Approx(wheels.left_rad * kRadius).margin(kTick * kRadius));
  CHECK(drive.plant.map_from_robot().x == Approx(0.5 * kRadius * (10.0 - kMotorLag)).epsilon(0.001));
  CHECK(drive.plant.map_from_robot().y == 0.0);
  CHECK(drive.plant.map_from_robot().heading == 0.0);
}

TEST_CASE("opposite speeds turn in place to the left, 2 r w over the track") {
  Drive drive;
  drive.run(-1.0, 1.0, 5.0);
  CHECK(drive.plant.map_from_robot().x == Approx(0.0).margin(1e-12));
  CHECK(drive.plant.map_from_robot().y == Approx(0.0).margin(1e-12));
  CHECK(drive.plant.twist().w_radps == Approx(2.0 * kRadius / kTrack).epsilon(0.001));
  const WheelState wheels = drive.read();
  const double heading = (wheels.right_rad - wheels.left_rad) * kRadius / kTrack;
  CHECK(drive.plant.map_from_robot().heading == Approx(heading).margin(2 * kTick * kRadius / kTrack));
}

TEST_CASE("on a steady curve the robot stays on the circle of radius v over w") {
  Drive drive;
  drive.run(2.0, 4.0, 2.0);  // spun up
  const Pose2 from = drive.plant.map_from_robot();
  const auto [v, w] = drive.plant.twist();
  drive.run(2.0, 4.0, 3.0);
  const Pose2 to = drive.plant.map_from_robot();
  CHECK(wrap_angle(to.heading - from.heading) == Approx(wrap_angle(3.0 * w)).margin(1e-6));
  CHECK(to.x - from.x == Approx(v / w * (std::sin(to.heading) - std::sin(from.heading))).margin(1e-6));
  CHECK(to.y - from.y == Approx(v / w * (std::cos(from.heading) - std::cos(to.heading))).margin(1e-6));
}

TEST_CASE("without slip the encoders' angles give back the truth after curves") {
  // Chords of 10 ms: on an arc of radius r the chord is shorter than the arc by (d / r)^2 / 24.
  Drive drive;
  double x = 0.0, y = 0.0, heading = 0.0;
  WheelState last = drive.read();
  for (int k = 0; k < 2000; ++k) {
    const double bend = 1.5 * std::sin(k * 0.01);
    drive.run(3.0 - bend, 3.0 + bend, 0.01);
    const WheelState now = drive.read();
    const double left = (now.left_rad - last.left_rad) * kRadius, right = (now.right_rad - last.right_rad) * kRadius;
    const double turned = (right - left) / kTrack;
    x += 0.5 * (left + right) * std::cos(heading + 0.5 * turned);
    y += 0.5 * (left + right) * std::sin(heading + 0.5 * turned);
    heading += turned;
    last = now;
  }
  const Pose2& truth = drive.plant.map_from_robot();
  CHECK(std::fabs(heading) > 0.01);
  CHECK(truth.x == Approx(x).margin(0.001));
  CHECK(truth.y == Approx(y).margin(0.001));
  CHECK(truth.heading == Approx(heading).margin(2 * kTick * kRadius / kTrack));
}

TEST_CASE("encoders count whole ticks and their speeds are differences of those") {
  Drive drive;
  drive.run(3.0, 1.0, 1.0);
  const WheelState before = drive.read();
  drive.run(3.0, 1.0, 0.1);
  const WheelState after = drive.read();
  const double ticks = after.left_rad / kTick;
  CHECK(std::fabs(ticks - std::floor(ticks + 0.5)) < 1e-6);
  CHECK(after.sequence == before.sequence + 1);
  CHECK(after.left_radps == Approx((after.left_rad - before.left_rad) / 0.1));
  CHECK(after.left_radps == Approx(3.0).margin(kTick / 0.1));
  CHECK(after.right_radps == Approx(1.0).margin(kTick / 0.1));
}

TEST_CASE("wheels that slip each by itself slow the robot by a share over root 2, and turn it off its way") {
  // The turn rate's standard deviation: sqrt 2 times the share of the rims' 0.39 m/s over a track of 0.33 m.
  const auto [spec, turn_radps] = GENERATE(std::pair{SlipSpec{}, 0.00836}, std::pair{SlipSpec{.std = 0.05}, 0.0836});
  Drive drive(spec);
  drive.run(4.0, 4.0, 1.0);
  double sum = 0.0, squares = 0.0, turns = 0.0;
  constexpr int kCount = 4000;
  for (int k = 0; k < kCount; ++k) {
    drive.plant.change_slip(5.0);  // five correlation times: nearly independent
    drive.run(4.0, 4.0, 0.02);
    const double slip = 1.0 - drive.plant.twist().v_mps / drive.plant.rim_speed();
    sum += slip;
    squares += slip * slip;
    turns += drive.plant.twist().w_radps * drive.plant.twist().w_radps;
  }
  CHECK(sum / kCount == Approx(0.0).margin(0.04 * spec.std));  // three times std / sqrt(2 * 4000), and a little
  CHECK(std::sqrt(squares / kCount) == Approx(spec.std / std::sqrt(2.0)).epsilon(0.05));
  CHECK(std::sqrt(turns / kCount) == Approx(turn_radps).epsilon(0.05));
}

TEST_CASE("wheels that slip by a share carry the robot by the rest") {
  // A mean slip of 0.05 and no more: two metres of rims are 1.9 m of ground, straight on.
  Drive drive(SlipSpec{.mean = 0.05, .std = 0.0});
  for (int k = 0; k < 100; ++k) {
    drive.plant.change_slip(0.02);
    drive.run(4.0, 4.0, 0.02);
  }
  const double rims_m = drive.read().left_rad * kRadius;
  CHECK(rims_m > 0.7);
  CHECK(drive.plant.map_from_robot().x == Approx(0.95 * rims_m).margin(kTick * kRadius));
  CHECK(drive.plant.map_from_robot().y == Approx(0.0).margin(1e-9));
}

TEST_CASE("a left wheel without grip turns as told, but the robot veers to the left") {
  Drive drive;
  drive.plant.grip(kLostGrip, 1.0);
  drive.run(2.0, 2.0, 1.0);
  CHECK(drive.read().left_radps == Approx(drive.read().right_radps));
  CHECK(drive.plant.twist().v_mps == Approx(0.5 * 2.0 * kRadius * (1.0 + kLostGrip)).epsilon(0.001));
  CHECK(drive.plant.twist().w_radps == Approx(2.0 * kRadius * (1.0 - kLostGrip) / kTrack).epsilon(0.001));
}

TEST_CASE("the drive holds a command for 100 ms, then brings itself to a stop") {
  Drive drive;
  drive.run(4.0, 4.0, 2.0);
  drive.coast(0.08);  // the last command came 20 ms before the run's end
  CHECK(drive.plant.rim_speed() == Approx(4.0 * kRadius).epsilon(0.001));
  drive.coast(0.02);
  CHECK(drive.plant.rim_speed() < 4.0 * kRadius * 0.999);
  CHECK(drive.plant.rim_speed() > 3.0 * kRadius);  // a ramp, not a jolt
  drive.coast(0.8);
  CHECK(drive.plant.rim_speed() == Approx(0.0).margin(0.001));
}

TEST_CASE("a command that is not finite is no command") {
  Drive drive;
  drive.run(4.0, 4.0, 2.0);
  drive.run(std::numeric_limits<double>::quiet_NaN(), 4.0, 1.0);
  CHECK(drive.plant.rim_speed() == Approx(0.0).margin(0.001));
  drive.run(4.0, std::numeric_limits<double>::infinity(), 1.0);
  CHECK(drive.plant.rim_speed() == Approx(0.0).margin(0.001));
}
