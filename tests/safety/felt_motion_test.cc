#include "firmware/safety/felt_motion.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <functional>
#include <random>

#include "tests/support/catch.h"

using namespace jaywalk;

namespace {

constexpr DriveModel kWheels{.wheel_radius_m = 0.1, .track_width_m = 0.4};
constexpr MotionLimits kLimits{.max_speed_mps = 0.6, .brake_mps2 = 1.0};

DriveModel with(const DriveTimes& times) {
  DriveModel drive = kWheels;
  drive.times = times;
  return drive;
}

/// Two wheels of 0.1 m, each with a motor that follows its command with a lag of 50 ms and at most 1.5 m/s2, and whose
/// speed is read some time later, in steps of 1000 counts a turn over 10 ms: 0.063 m/s.
struct Bench {
  double period_s = 0.02, late_s = 0.02, dead_s = 0.0, step_mps = 0.0;
  double left_motor = 1.0, right_motor = 1.0;  ///< -1 reversed, 0 stuck
  bool runs_away = false;                      ///< it turns as it turned
  DriveTrouble trouble = DriveTrouble::kNone;
  DriveTimes times{};
  double report_every_s = 0.001;  ///< its reports are up to times.late_s later, and stamped as they come
  FeltMotion felt{with(times), kLimits};
  std::minstd_rand draws{1};
  double now_s = 1.0, left_mps = 0.0, right_mps = 0.0, left_m = 0.0, right_m = 0.0;
  double left_counts = 1.0, right_counts = 1.0;  ///< what their counters make of the wheels' turning
  double counted_every_s = 0.001;
  bool speeds_stand = false;
  double speeds_off_m = 0.0;  ///< way of the left wheel less that of the speeds told of it, since they stand
  double next_report_s = 0.0, delivered_s = 0.0;
  std::deque<WheelState> readings{};
  WheelCommand sent{};
  std::deque<WheelCommand> orders{};  ///< those not obeyed yet, and before them the one that is

  double turned(double speed, double wanted) const {
    return runs_away ? speed : speed + std::clamp((wanted - speed) / 0.05, -1.5, 1.5) * 0.001;
  }
  double read(double speed) const {
    return 10.0 * (step_mps > 0.0 ? std::floor(speed / step_mps + 0.5) * step_mps : speed);
  }
  void report() {
    next_report_s = now_s + report_every_s;
    const double late = times.late_s * std::uniform_real_distribution(0.0, 1.0)(draws);
    delivered_s = std::max(delivered_s, now_s + late);
    const bool counts = readings.empty() || std::fmod(now_s + 1e-6, counted_every_s) < 0.001;
    const bool stand = speeds_stand && !readings.empty();
    readings.push_back({.stamp = time_from_seconds(delivered_s),
                        .sequence = 1,
                        .left_rad = counts ? 10.0 * left_m : readings.back().left_rad,
                        .right_rad = counts ? 10.0 * right_m : readings.back().right_rad,
                        .left_radps = stand ? readings.back().left_radps : read(left_mps),
                        .right_radps = stand ? readings.back().right_radps : read(right_mps),
                        .trouble = trouble});
  }
  /// A tick that then commands these; whether what came before was disobeyed.
  bool tick(double left, double right) {
    for (double t = 0.0; t < period_s - 1e-9; t += 0.001) {
      now_s += 0.001;
      while (orders.size() > 1 && orders[1].stamp <= time_from_seconds(now_s - dead_s)) orders.pop_front();
      const WheelCommand obeyed = orders.empty() ? WheelCommand{} : orders.front();
      left_mps = turned(left_mps, left_motor * 0.1 * obeyed.left_radps);
      right_mps = turned(right_mps, right_motor * 0.1 * obeyed.right_radps);
      left_m += 0.001 * left_counts * left_mps;
      right_m += 0.001 * right_counts * right_mps;
      if (speeds_stand) speeds_off_m += 0.001 * (left_mps - 0.1 * readings.back().left_radps);
      if (now_s >= next_report_s - 1e-9) report();
    }
    while (readings.size() > 1 && readings[1].stamp <= time_from_seconds(now_s - late_s)) readings.pop_front();
    const bool disobeyed = felt.disobeys(sent, readings.front(), time_from_seconds(now_s));
    sent = {time_from_seconds(now_s), 10.0 * left, 10.0 * right};
    orders.push_back(sent);
    return disobeyed;
  }
  /// Seconds until disobedience is told; infinity where it is not within `limit_s`.
  double told_after(double limit_s, const std::function<std::pair<double, double>(double)>& commanded) {
    const double began_s = now_s;
    while (now_s - began_s < limit_s) {
      const auto [left, right] = commanded(now_s - began_s);
      if (tick(left, right)) return now_s - began_s;
    }
    return std::numeric_limits<double>::infinity();
  }
};

/// Rest, 0.5 m/s2 to 0.6 m/s, a turn, an emergency stop, back and forth on the spot, each for a second.
std::pair<double, double> lively(double t_s) {
  const double part_s = t_s - 6.0 * std::floor(t_s / 6.0);
  if (part_s < 1.0) return {0.0, 0.0};
  if (part_s < 2.2) return {0.5 * (part_s - 1.0), 0.5 * (part_s - 1.0)};
  if (part_s < 3.0) return {0.3, 0.9};
  if (part_s < 4.0) return {0.0, 0.0};  // at once: the drive ramps
  return part_s < 5.0 ? std::pair{-0.25, 0.25} : std::pair{0.25, -0.25};
}

/// Both wheels at this speed all the time.
auto at(double mps) {
  return [mps](double) { return std::pair{mps, mps}; };
}

}  // namespace

TEST_CASE("wheels that obey late, with a lag and in coarse steps are no fault at any rate of the loop") {
  const double period_s = GENERATE(0.005, 0.02, 0.05);
  const double late_s = GENERATE(0.01, 0.05);
  const double step_mps = GENERATE(0.0, 0.063);
  Bench bench{.period_s = period_s, .late_s = late_s, .step_mps = step_mps};
  CHECK(std::isinf(bench.told_after(18.0, lively)));
}

TEST_CASE("a wheel that is reversed or stuck is told within half a second of driving, whichever it is") {
  const double period_s = GENERATE(0.005, 0.02, 0.05);
  const double late_s = GENERATE(0.01, 0.05);
  for (const auto& [left, right] : {std::pair{-1.0, -1.0}, {-1.0, 1.0}, {1.0, -1.0}, {0.0, 1.0}, {1.0, 0.0}}) {
    Bench bench{.period_s = period_s, .late_s = late_s, .left_motor = left, .right_motor = right};
    CHECK(bench.told_after(2.0, at(0.3)) < 0.5);
  }
}

TEST_CASE("a wheel that sticks under way is told within half a second") {
  Bench bench;
  REQUIRE(std::isinf(bench.told_after(2.0, at(0.3))));
  bench.right_motor = 0.0;
  CHECK(bench.told_after(2.0, at(0.3)) < 0.5);
}

TEST_CASE("wheels that turn though they are commanded to stand are told, on either side and in either direction") {
  const double felt_mps = GENERATE(0.2, -0.2);
  const bool left = GENERATE(true, false);
  FeltMotion felt(kWheels, kLimits);
  double told_s = 0.0;
  for (double t = 0.0; told_s == 0.0 && t < 2.0; t += 0.02) {
    WheelState wheels{.stamp = time_from_seconds(t), .sequence = 1};
    (left ? wheels.left_rad : wheels.right_rad) = 10.0 * felt_mps * t;
    (left ? wheels.left_radps : wheels.right_radps) = 10.0 * felt_mps;
    if (felt.disobeys({}, wheels, time_from_seconds(t))) told_s = t;
  }
  CHECK(told_s > 0.1);  // 0.18 m/s too much for 0.167 s is 0.03 m
  CHECK(told_s < 0.25);
}

TEST_CASE("a drive in trouble may brake by itself, but not go on") {
  Bench bench;
  REQUIRE(std::isinf(bench.told_after(2.0, at(0.3))));
  bench.trouble = DriveTrouble::kEmergency;
  bench.left_motor = bench.right_motor = 0.0;
  CHECK(std::isinf(bench.told_after(0.5, at(0.3))));
  CHECK(std::isinf(bench.told_after(3.0, at(0.0))));
  Bench racing;
  REQUIRE(std::isinf(racing.told_after(2.0, at(0.3))));
  racing.trouble = DriveTrouble::kLeftOperation;
  racing.runs_away = true;
  const double told_s = racing.told_after(2.0, at(0.0));
  CHECK(told_s > 0.4);  // 0.2 s to obey, then from 0.3 m/s down at 1 m/s2, and 0.03 m
  CHECK(told_s < 0.7);
}

TEST_CASE("commands too small for a fault at once add up: a wheel that does not creep when commanded 0.1 m/s") {
  Bench bench{.left_motor = 0.0};
  const double told_s = bench.told_after(3.0, at(0.1));
  CHECK(told_s > 0.5);  // 0.2 s to obey, then 0.1 - 0.035 m/s for 0.46 s is 0.03 m
  CHECK(told_s < 0.9);
}

TEST_CASE("feedback that stopped coming, or is no number, says nothing of obedience") {
  FeltMotion felt(kWheels, kLimits);
  WheelState wheels{.stamp = time_from_seconds(0.0), .sequence = 1};
  for (double t = 0.0; t < 3.0; t += 0.02) {
    if (t > 1.0) wheels.left_radps = std::numeric_limits<double>::quiet_NaN(), wheels.stamp = time_from_seconds(t);
    const bool disobeyed = felt.disobeys({time_from_seconds(t), 3.0, 3.0}, wheels, time_from_seconds(t));
    if (t > 0.12) CHECK_FALSE(disobeyed);
  }
}

TEST_CASE("a counter that stands, or counts half or twice as much, while its wheel's speed is alive is told") {
  const double speed = GENERATE(0.2, 0.3, 0.6);
  for (const auto& [left, right] : {std::pair{0.0, 0.0}, {0.0, 1.0}, {1.0, 0.0}, {0.5, 0.5}, {1.0, 2.0}, {-1.0, 1.0}}) {
    Bench bench;
    REQUIRE(std::isinf(bench.told_after(2.0, at(speed))));
    bench.left_counts = left;
    bench.right_counts = right;
    const double within_s = left == 0.5 ? 1.5 : 0.6;
    CHECK(bench.told_after(2.0, at(speed)) < within_s);
  }
}

TEST_CASE("counters that are read less often than speeds, or a few per cent off, are no fault") {
  const double every_s = GENERATE(0.001, 0.02, 0.05);
  const double counts = GENERATE(0.95, 1.0, 1.05);
  Bench bench{.left_counts = counts, .counted_every_s = every_s};
  CHECK(std::isinf(bench.told_after(18.0, lively)));
}

TEST_CASE("bases that report every 10 to 100 ms, up to 60 ms late, are no fault, and are told where they do not obey") {
  const double report_s = GENERATE(0.01, 0.02, 0.05, 0.1);
  const unsigned seed = GENERATE(1U, 2U, 3U);
  CAPTURE(report_s, seed);
  const DriveTimes times{.report_s = report_s, .late_s = 0.06};
  Bench bench{.late_s = 0.0, .times = times, .report_every_s = report_s, .draws = std::minstd_rand(seed)};
  CHECK(std::isinf(bench.told_after(60.0, lively)));
  Bench reversed{.late_s = 0.0, .left_motor = -1.0, .times = times, .report_every_s = report_s};
  CHECK(reversed.told_after(2.0, at(0.3)) < 0.5 + report_s + 0.06);
}

TEST_CASE("a drive that states a slow response has the time it states") {
  for (const double response_s : {0.05, 0.25}) {
    const DriveTimes times{.report_s = 0.1, .response_s = response_s};
    Bench bench{.dead_s = response_s - 0.05, .times = times, .report_every_s = 0.1};
    CHECK(std::isinf(bench.told_after(30.0, lively)));
  }
  Bench slow{.dead_s = 0.6};
  CHECK(slow.told_after(6.0, lively) < 6.0);
}

TEST_CASE("speeds that stand while both counters live are told within centimetres of a difference in way") {
  const double from = GENERATE(0.3, 0.4, 0.5);
  const bool up = GENERATE(true, false);
  Bench bench;
  REQUIRE(std::isinf(bench.told_after(2.0, at(from))));
  bench.speeds_stand = true;
  REQUIRE(bench.told_after(3.0, at(up ? 0.6 : 0.2)) < 1.5);
  CHECK(std::fabs(bench.speeds_off_m) < 0.11);
}
