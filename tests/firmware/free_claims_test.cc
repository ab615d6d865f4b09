// A scanner that says "nothing within reach" (SAFETY 29): the robot never touches what it does not see, and never
// drives on as if it saw.
#include <array>
#include <cmath>
#include <string>

#include "tests/firmware/simulated_drive.h"
#include "tests/support/catch.h"

using namespace jaywalk;

namespace {

constexpr double kDeg = kPi / 180.0;

struct Failure {
  double width_deg = 270.0;           ///< of the sector, ahead
  double at_s = 5.0;                  ///< under way; 0.5: at rest, before the goal
  const LaserModel* laser = nullptr;  ///< null: the scenario's
};

struct Outcome {
  int hits_before = 0;  ///< in the sector, of the last scan before the failure: without any nothing contradicts it
  bool touched = false;
  double told_s = 1e9;   ///< after the failure, at the first tick that limits the robot for what it does not see
  double blind_m = 0.0;  ///< way above 0.3 m/s before that
};

int hits_within(const LaserScan& scan, double half_rad) {
  int hits = 0;
  for (std::size_t k = 0; k < scan.beam_count; ++k)
    hits += scan.is_hit(k) && std::fabs(scan.angle_rad(k)) <= half_rad ? 1 : 0;
  return hits;
}

/// A run of 25 s towards a goal behind walls, whose laser's sector claims free from a moment on.
Outcome run(const std::string& scenario, std::uint64_t seed, const Failure& failure) {
  SimulatedDrive drive(scenario, seed, [&](sim::Scenario& s) {
    s.wanderers.clear();
    if (failure.laser != nullptr) s.model.laser = *failure.laser;
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
    if (since_s < 0.0) outcome.hits_before = hits_within(t.scan, 0.5 * failure.width_deg * kDeg);
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
  const std::string scenario = GENERATE("map3_00", "door");
  const double width_deg = GENERATE(270.0, 80.0, 40.0, 20.0);
  const double at_s = GENERATE(0.5, 5.0);
  CAPTURE(scenario, width_deg, at_s);
  const Outcome outcome = run(scenario, 3, {width_deg, at_s});
  CHECK_FALSE(outcome.touched);
  CHECK((outcome.told_s <= 0.5 || outcome.blind_m < 0.3));
}

// Hidden: 160 runs, six minutes of a core. build/tests/firmware/firmware_tests "[claims]"
TEST_CASE("40 runs of each kind of scanner that claims free", "[.][claims]") {
  const auto degrees = [](double fov_deg, std::uint32_t beams, double rate_hz, double range_m) {
    const Pose2 mount = p3dx().laser.robot_from_laser;
    return LaserModel{mount, fov_deg * kDeg, beams, rate_hz, 0.05, range_m, 0.01};
  };
  struct Kind {
    const char* name;
    LaserModel laser;
  };
  const Kind kinds[] = {{"Hokuyo UTM-30LX", degrees(270.0, 1081, 40.0, 30.0)},
                        {"LMS200", degrees(180.0, 181, 12.0, 8.183)},
                        {"ROS 2, all round", degrees(359.0, 360, 10.0, 12.0)},
                        {"ROS 2, far", degrees(270.0, 541, 15.0, 25.0)}};
  for (const Kind& kind : kinds) {
    DYNAMIC_SECTION(kind.name) {
      int touched = 0, late = 0, nothing_there = 0;
      for (int k = 0; k < 40; ++k) {
        const char* const maps[] = {"map1_00", "map2_00", "map3_00", "map4_00", "door"};
        const double width_deg = std::array{359.0, 80.0, 40.0, 20.0}[static_cast<std::size_t>(k) % 4];
        const double at_s = k % 8 < 4 ? 0.5 : 3.0 + 0.31 * k;
        const Outcome outcome = run(maps[k / 8], static_cast<std::uint64_t>(100 + k), {width_deg, at_s, &kind.laser});
        touched += outcome.touched ? 1 : 0;
        const bool is_late = outcome.told_s > 0.5 && outcome.blind_m > 0.3, could_tell = outcome.hits_before > 3;
        late += is_late && could_tell ? 1 : 0;
        nothing_there += is_late && !could_tell ? 1 : 0;
        if (outcome.touched || is_late)
          WARN(maps[k / 8] << ", seed " << 100 + k << ", " << width_deg << " degrees at " << at_s << " s: told after "
                           << outcome.told_s << " s, " << outcome.blind_m << " m blind");
      }
      WARN(kind.name << ": touched " << touched << " of 40, told late " << late << ", nothing to tell by "
                     << nothing_there);
      CHECK(touched == 0);
      CHECK(late == 0);
    }
  }
}
