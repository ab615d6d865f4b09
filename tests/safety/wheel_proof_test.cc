// The first way after arming: wheels that go farther or less far than they say.
#include "firmware/safety/wheel_proof.h"

#include "tests/safety/trial_robot.h"
#include "tests/support/catch.h"

using namespace jaywalk;

namespace {

struct Start {
  bool told = false, free = false;  ///< accused; faster than the slow metre
  double took_s = 0.0, way_m = 0.0, fastest_mps = 0.0;
};

/// Result of a start from rest: until the wheels are accused or proved, 15 s at most.
Start started(std::uint64_t seed, double wheels_go) {
  trials::TrialRobot robot(seed, trials::Fault::kNone, 0.0, {.proves_wheels = true, .wheels_go = wheels_go});
  Start start;
  while (robot.now_s() < 16.0 && !start.told && !start.free) {
    robot.tick();
    start.took_s = robot.now_s() - 1.0;
    start.fastest_mps = std::max(start.fastest_mps, robot.speed_mps());
    start.way_m += 0.02 * robot.speed_mps();
    start.told = robot.accused();
    start.free = robot.wheel_mps() > WheelProof::kSlow_mps + 0.02;
  }
  return start;
}

}  // namespace

TEST_CASE("wheels that go 2, 3 or 10 times as far as they say are told in the first way after arming, slowly") {
  const double times = GENERATE(2.0, 3.0, 10.0);
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    CAPTURE(times, seed);
    const Start start = started(seed, times);
    CHECK(start.told);
    CHECK(start.fastest_mps < 0.45);
    CHECK(start.way_m < 0.3);
  }
}

TEST_CASE("wheels that go as far as they say are proved within three seconds of driving, mostly, and never accused") {
  int slow = 0;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    CAPTURE(seed);
    const Start start = started(seed, 1.0);
    CHECK_FALSE(start.told);
    slow += start.took_s > 4.0 ? 1 : 0;
  }
  CHECK(slow <= 6);
}
