// A scanner that says "nothing within reach" (SAFETY 29): the robot never touches what it does not see, and never
// drives on as if it saw.
#include <cmath>
#include <string>

#include "tests/firmware/simulated_drive.h"
#include "tests/support/catch.h"

using namespace jaywalk;

namespace {

constexpr double kDeg = kPi / 180.0;

struct Failure {
  double width_deg = 270.0;  ///< of the sector, ahead
  double at_s = 5.0;         ///< under way; 0.5: at rest, before the goal
};

struct Outcome {
  bool touched = false;
  double told_s = 1e9;   ///< after the failure, at the first tick that limits the robot for what it does not see
  double blind_m = 0.0;  ///< way above 0.3 m/s before that
};

/// A run of 25 s towards a goal behind walls, whose laser's sector claims free from a moment on.
Outcome run(const std::string& scenario, std::uint64_t seed, const Failure& failure) {
  SimulatedDrive drive(scenario, seed, [&](sim::Scenario& s) {
    s.wanderers.clear();
    const double half = 0.5 * failure.width_deg * kDeg;
    s.faults = {{.at_s = failure.at_s,
                 .for_s = 1e6,
                 .kind = sim::FaultKind::kBeamsLost,
                 .lost = {-half, half},
                 .claims_free = true}};
  });
  Outcome outcome;
  constexpr Reason kTold = Reason::kUnwatched | Reason::kSightLost | Reason::kScanInvalid;
  Vec2 before = drive.truth().map_from_robot.position();
  (void)drive.drive(25.0, [&](const TickRecord& t) {
    const double since_s = to_seconds(t.now.time_since_epoch()) - failure.at_s;
    const Vec2 here = drive.truth().map_from_robot.position();
    if (since_s > 0.0 && has(t.verdict.reasons, kTold)) outcome.told_s = std::min(outcome.told_s, since_s);
    if (since_s > 0.0 && outcome.told_s > 1e6 && std::fabs(drive.truth().twist.v_mps) > 0.31)
      outcome.blind_m += distance(before, here);
    before = here;
    outcome.touched = drive.truth().contacts > 0;
    return outcome.touched;
  });
  return outcome;
}

}  // namespace

TEST_CASE("a scanner whose beams say that nothing is there is not believed where they hit something before") {
  for (const char* scenario : {"map3_00", "door"}) {
    for (const double width_deg : {270.0, 80.0, 40.0, 20.0}) {
      for (const double at_s : {0.5, 5.0}) {
        INFO(scenario << ", " << width_deg << " degrees at " << at_s << " s");
        const Outcome outcome = run(scenario, 3, {width_deg, at_s});
        CHECK_FALSE(outcome.touched);
        CHECK((outcome.told_s <= 0.5 || outcome.blind_m < 0.3));
      }
    }
  }
}
