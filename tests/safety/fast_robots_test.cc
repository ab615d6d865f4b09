// The stop zone reaches as far as the robot needs to stop, whatever robot it is (SAFETY 7 and 19).
#include "tests/safety/driven_robot.h"
#include "tests/support/catch.h"

using namespace jaywalk;

TEST_CASE("a robot of 2 m/s that brakes with 0.5 m/s2 stops before a wall that it sees from afar, and from 2.9 m") {
  for (const double brake : {0.5, 1.0, 3.0}) {
    for (const double wall_m : {2.9, 9.0}) {
      RobotModel fast = p3dx();
      fast.limits.max_speed_mps = 2.0;
      fast.limits.brake_mps2 = brake;
      DrivenRobot robot(fast, {{.centre = {wall_m + 0.1, 0.0}, .half = {0.1, 3.0}}});
      double v = 0.0, least_m = 10.0;
      for (int k = 0; k < 1500; ++k) {
        v = robot.tick({std::min(2.0, v + 0.05), 0.0}).permitted.v_mps;
        least_m = std::min(least_m, robot.clearance_m());
      }
      CHECK(least_m > 0.03);
      CHECK(least_m < 0.3);
    }
  }
}

TEST_CASE("at every rate of loop and scanner a wall is stopped for") {
  for (const double loop_hz : {20.0, 50.0, 200.0}) {
    for (const double scan_hz : {5.0, 15.0, 50.0}) {
      RobotModel model = p3dx();
      model.limits.max_speed_mps = 1.2;
      model.laser.rate_hz = scan_hz;
      const Duration tick = duration_from_seconds(1.0 / loop_hz);
      DrivenRobot robot(model, {{.centre = {4.0, 0.0}, .half = {0.1, 3.0}}}, {.model = model, .tick = tick});
      double v = 0.0, least_m = 10.0;
      for (int k = 0; k < static_cast<int>(12.0 * loop_hz); ++k) {
        v = robot.tick({std::min(1.2, v + 1.0 / loop_hz), 0.0}).permitted.v_mps;
        least_m = std::min(least_m, robot.clearance_m());
      }
      INFO(loop_hz << " Hz, scans " << scan_hz << " Hz");
      CHECK(least_m > 0.0);
    }
  }
}
