#include "firmware/safety/latency.h"

#include <cmath>
#include <vector>

#include "hal/types/robot_model.h"
#include "tests/support/catch.h"

using namespace jaywalk;

namespace {

/// A wheel command that swings between 0 and 6 rad/s in four seconds, as ramps.
double wanted_radps(double t_s) { return 6.0 * std::fabs(std::remainder(t_s, 4.0)) / 2.0; }

/// What is measured after ten seconds of a drive that follows with a dead time and a lag, with feedback 4 ms old.
double measured_s(double loop_hz, double dead_s, double lag_s) {
  DriveResponse response(p3dx().drive);
  double felt = 0.0;
  WheelState wheels;
  constexpr double kStep_s = 0.001;
  double due_s = 1.0;
  std::vector<double> commanded{0.0};
  for (int k = 0; k < 10000; ++k) {
    const double now_s = 1.0 + k * kStep_s;
    if (now_s >= due_s - 1e-9) {
      due_s += 1.0 / loop_hz;
      commanded.push_back(wanted_radps(now_s));
      response.add(wheels, {time_from_seconds(now_s), commanded.back(), commanded.back()});
    }
    const auto before = static_cast<std::size_t>(std::floor((now_s - dead_s - 1.0) * loop_hz + 1e-6) + 1.0);
    const double obeyed = now_s - dead_s < 1.0 ? 0.0 : commanded[before];
    felt += (obeyed - felt) * kStep_s / lag_s;
    if (k % 10 == 6) {
      wheels.stamp = time_from_seconds(now_s);
      ++wheels.sequence;
      wheels.left_radps = wheels.right_radps = felt;
    }
  }
  return response.seconds();
}

}  // namespace

TEST_CASE("a drive's response is its dead time and its lag together") {
  const double loop_hz = GENERATE(20.0, 50.0, 200.0);
  CAPTURE(loop_hz);
  CHECK(measured_s(loop_hz, 0.0, 0.05) == Approx(0.05).margin(0.02));
  CHECK(measured_s(loop_hz, 0.1, 0.05) == Approx(0.15).margin(0.02));
  CHECK(measured_s(loop_hz, 0.02, 0.2) == Approx(0.22).margin(0.04));
  CHECK(measured_s(loop_hz, 0.6, 0.1) == Approx(0.3));  // no more is reckoned with
}

TEST_CASE("a steady speed tells nothing of the drives, nor do wheels that are no numbers") {
  DriveResponse response(p3dx().drive);
  WheelState wheels;
  for (int k = 1; k < 500; ++k) {
    const Time now = time_from_seconds(0.02 * k);
    wheels = {.stamp = now, .sequence = static_cast<std::uint32_t>(k), .left_radps = 2.0, .right_radps = 2.0};
    if (k > 250) wheels.left_radps = std::nan("");
    const double wanted = k > 250 ? 0.1 * (k % 50) : 3.0;
    response.add(wheels, {now, wanted, wanted});
  }
  CHECK(response.seconds() == 0.0);
}

TEST_CASE("the worst tick counts for five seconds at least and ten at most") {
  Latency latency(p3dx().drive);
  const auto at = [&latency](double now_s, Duration took) {
    latency.add(time_from_seconds(now_s), took, {}, {.stamp = time_from_seconds(now_s)});
    return latency.measured().tick_s;
  };
  CHECK(at(1.0, std::chrono::milliseconds(3)) == Approx(0.003));
  CHECK(at(5.0, std::chrono::milliseconds(12)) == Approx(0.012));
  for (int k = 0; k < 250; ++k) REQUIRE(at(5.02 + 0.02 * k, Duration{0}) == Approx(0.012));
  for (int k = 0; k < 260; ++k) static_cast<void>(at(10.04 + 0.02 * k, Duration{0}));
  CHECK(latency.measured().tick_s == 0.0);
}

TEST_CASE("control and drive take a period, the tick and the drive's lag, 0.08 s at least and never without bounds") {
  constexpr Duration k50Hz = std::chrono::milliseconds(20), k20Hz = std::chrono::milliseconds(50);
  constexpr DriveTimes kUsual;
  CHECK(control_and_drive_s(k50Hz, kUsual, {}) == Approx(0.08));
  CHECK(control_and_drive_s(std::chrono::milliseconds(5), kUsual, {}) == Approx(0.08));
  CHECK(control_and_drive_s(k20Hz, kUsual, {}) == Approx(0.11));
  CHECK(control_and_drive_s(k50Hz, kUsual, {0.015, 0.12}) == Approx(0.155));
  CHECK(control_and_drive_s(k50Hz, kUsual, {9.0, 9.0}) == Approx(0.42));
  constexpr DriveTimes kSlow{.report_s = 0.1, .late_s = 0.06, .response_s = 0.15};  // 0.3 + 0.24 s at most
  CHECK(control_and_drive_s(k50Hz, kSlow, {}) == Approx(0.18));
  CHECK(control_and_drive_s(k50Hz, kSlow, {0.01, 9.0}) == Approx(0.57));
}

TEST_CASE(
    "a reading of the wheels is old after two reports and what the next may be late, or as the loop's rate has it") {
  constexpr Duration k50Hz = std::chrono::milliseconds(20), k20Hz = std::chrono::milliseconds(50);
  CHECK(oldest_wheels({}, k50Hz) == std::chrono::milliseconds(60));
  CHECK(oldest_wheels({}, k20Hz) == std::chrono::milliseconds(125));
  CHECK(oldest_wheels({.report_s = 0.1}, k50Hz) == std::chrono::milliseconds(250));
  CHECK(oldest_wheels({.report_s = 0.01, .late_s = 0.06}, k50Hz) == std::chrono::milliseconds(80));
}
