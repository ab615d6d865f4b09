#pragma once
#include <cmath>
#include <limits>

#include "firmware/safety/supervisor.h"
#include "tests/safety/scans.h"
#include "tests/support/catch.h"

namespace jaywalk::supervised {

/// A bench for the supervisor: everything fresh and free unless a test spoils it; time in ticks of 20 ms.
struct Bench {
  LaserScan scan = tests::scan_of(p3dx().laser, 10.0F);
  WheelState wheels;
  OperatorInput input;
  Time now = time_from_seconds(1.0);
  Time plan_stamp = now;
  bool scan_fresh = true, wheels_fresh = true, plan_fresh = true;
  MeasuredLatency latency;
  double most_speed_mps = std::numeric_limits<double>::infinity();
  bool pose_doubtful = false;
  Supervisor supervisor;

  explicit Bench(bool latches_all = false, const RobotModel& model = p3dx())
      : supervisor({.model = model, .latches_all = latches_all}) {
    wheels.sequence = 1;
    scan.stamp = wheels.stamp = now;
    input.has_goal = true;
  }
  Verdict tick(const Twist2& wanted) {
    now += std::chrono::milliseconds(20);
    if (scan_fresh) scan.stamp = now;
    if (wheels_fresh) wheels.stamp = now;
    if (plan_fresh) plan_stamp = now;
    return supervisor.judge(
        wanted, {scan, wheels, input, plan_stamp, now, latency, false, most_speed_mps, {}, {}, nullptr, pose_doubtful});
  }
  /// A press of the reset button at rest.
  void reset() {
    input.reset = true;
    tick({});
    input.reset = false;
  }
  Verdict ticks(int count, const Twist2& wanted) {
    Verdict verdict;
    for (int k = 0; k < count; ++k) verdict = tick(wanted);
    return verdict;
  }
};

}  // namespace jaywalk::supervised
