// Somebody on two legs who stands in a passage 1.5 m wide, which leaves 0.73 m beside him: simulated from start to
// goal.
#include <cmath>

#include "tests/firmware/simulated_drive.h"
#include "tests/support/catch.h"

using namespace jaywalk;

namespace {

/// He stands there from the third second to the 48th.
struct Passing {
  bool arrived = false;                                     ///< and touched nothing
  double seconds = 0.0, nearest_m = 1e9, beside_mps = 0.0;  ///< the speed where it is nearest
};

/// He stands `aside_m` nearer to the passage's side.
Passing pass(const RobotModel& model, std::uint64_t seed, double aside_m = 0.0) {
  SimulatedDrive drive("passage", seed, [&](sim::Scenario& s) {
    s.model = model;
    s.recorded[0].offset.y -= aside_m;
  });
  Passing passing;
  passing.arrived = drive.arrives(90.0, [&](const TickRecord& t) {
    passing.seconds = to_seconds(t.now);
    if (drive.truth().mover_clearance_m < passing.nearest_m) {
      passing.nearest_m = drive.truth().mover_clearance_m;
      passing.beside_mps = std::fabs(t.wanted.v_mps);
    }
  });
  return passing;
}

}  // namespace

TEST_CASE("a robot 0.38 m wide keeps clear of somebody who stands in a passage, and not of his shins alone") {
  RobotModel narrow = p3dx();
  narrow.footprint = {0.2275, 0.2275, 0.1905};
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    CAPTURE(seed);
    const Passing passing = pass(narrow, seed);
    CAPTURE(passing.nearest_m, passing.seconds);
    CHECK(passing.arrived);
    CHECK(passing.beside_mps < 0.35);  // politely: 0.2 m/s, or the gap within a second
    CHECK(passing.nearest_m > 0.2);    // 0.25 to 0.28 m, in 29 to 37 s
    CHECK(passing.seconds < 48.0);
  }
}

TEST_CASE("a wheelchair that has no room beside him waits until he goes on") {
  const Passing passing = pass(wheelchair(), 1);
  CHECK(passing.arrived);
  CHECK(passing.seconds > 48.0);
  CHECK(passing.nearest_m > 0.33);
}

TEST_CASE("a wheelchair that has room beside him passes, and leaves some") {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    CAPTURE(seed);
    const Passing passing = pass(wheelchair(), seed, 0.4);
    CHECK(passing.arrived);
    CHECK(passing.seconds < 40.0);
    CHECK(passing.nearest_m > 0.25);
    CHECK(passing.beside_mps < passing.nearest_m + 0.05);  // politely: the gap within a second
  }
}
