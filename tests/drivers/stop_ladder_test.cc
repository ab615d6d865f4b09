#include "drivers/stop_ladder.h"

#include "tests/support/catch.h"

using namespace jaywalk;
using namespace std::chrono_literals;

namespace {

constexpr Duration kTick = 20ms;

/// Wheels at 6 rad/s, owed a ramp of 10 rad/s2: rest after 0.6 s, and 60 ms of response.
struct Bench {
  StopLadder ladder{{.brake_radps2 = 10.0, .tolerance_radps = 0.5}};
  Time now{10s};
  std::array<WheelFeedback, 2> wheels{{{6.0, Time{10s}}, {6.0, Time{10s}}}};

  StopStage tick(double left, double right, bool stopping = true, bool trouble = false) {
    now += kTick;
    wheels = {{{left, now}, {right, now}}};
    return ladder.update(now, stopping, trouble, wheels);
  }
  /// A feedback that stays as it was, for the wheel on the right.
  StopStage tick_right_silent(double left, bool trouble) {
    now += kTick;
    wheels[0] = {left, now};
    return ladder.update(now, true, trouble, wheels);
  }
};

}  // namespace

TEST_CASE("a stop that both wheels follow stays where it is, and one that is confirmed is over") {
  Bench bench;
  double speed = 6.0;
  for (int k = 0; k < 40; ++k) {
    CHECK(bench.tick(speed, speed) == StopStage::kNone);
    speed = std::max(speed - 10.0 * 0.02, 0.0);
  }
  // Pushed by hand at rest: nobody's stop is under way.
  CHECK(bench.tick(2.0, 2.0) == StopStage::kNone);
  CHECK(bench.tick(2.0, 2.0) == StopStage::kNone);
}

TEST_CASE("a wheel that keeps its speed takes a commanded stop to silence 120 ms after the order") {
  Bench bench;
  // The order is seen in the first tick; v - b (t - 60 ms) + 0.5 is below 6 rad/s from t = 110 ms on.
  for (int ms = 0; ms <= 100; ms += 20) CHECK(bench.tick(0.0, 6.0) == StopStage::kNone);
  CHECK(bench.tick(0.0, 6.0) == StopStage::kQuickStop);
  CHECK(bench.tick(0.0, 6.0) == StopStage::kNetworkStop);
  CHECK(bench.tick(0.0, 6.0) == StopStage::kSilent);
  CHECK(bench.tick(0.0, 0.0) == StopStage::kSilent);  // until a person's reset
  bench.ladder.reset();
  CHECK(bench.tick(0.0, 0.0) == StopStage::kNone);
}

TEST_CASE("a stop at the end of a commanded ramp is owed no second ramp") {
  // 6 rad/s commanded down with 10 rad/s2 in 0.6 s; the right wheel never follows. 60 ms after the command is zero it
  // counts as stuck: silence 120 ms after that command.
  StopLadder ladder({.brake_radps2 = 10.0, .tolerance_radps = 0.5});
  Time now{10s};
  for (double told = 6.0; told > 0.1; told -= 0.2, now += kTick) {
    REQUIRE(ladder.update(now, false, false, {{{told, now, told}, {6.0, now, told}}}) == StopStage::kNone);
  }
  for (int ms = 0; ms <= 60; ms += 20, now += kTick) {
    CHECK(ladder.update(now, true, false, {{{0.0, now, 0.0}, {6.0, now, 0.0}}}) == StopStage::kNone);
  }
  for (const StopStage stage : {StopStage::kQuickStop, StopStage::kNetworkStop, StopStage::kSilent}) {
    CHECK(ladder.update(now, true, false, {{{0.0, now, 0.0}, {6.0, now, 0.0}}}) == stage);
    now += kTick;
  }
}

TEST_CASE("a command that drops faster than the ramp owes the ramp all the same") {
  StopLadder ladder({.brake_radps2 = 10.0, .tolerance_radps = 0.5});
  Time now{10s};
  static_cast<void>(ladder.update(now, false, false, {{{6.0, now, 6.0}, {6.0, now, 6.0}}}));
  now += kTick;
  static_cast<void>(ladder.update(now, false, false, {{{6.0, now, 0.1}, {6.0, now, 0.1}}}));
  double speed = 6.0;
  for (int k = 0; k < 40; ++k) {
    now += kTick;
    CHECK(ladder.update(now, true, k > 5, {{{speed, now, 0.0}, {speed, now, 0.0}}}) <= StopStage::kQuickStop);
    speed = std::max(speed - 10.0 * 0.02, 0.0);
  }
}

TEST_CASE("a stop that turned into trouble because it was not confirmed is not begun anew") {
  Bench bench;
  StopStage stage = StopStage::kNone;
  Duration silent{0};
  for (int ms = 0; ms <= 300 && silent == Duration{0}; ms += 20) {
    stage = bench.tick(6.0, 6.0, true, stage != StopStage::kNone);
    if (stage == StopStage::kSilent) silent = bench.now - Time{10s} - kTick;
  }
  CHECK(silent == 160ms);  // as without: 120 ms is the first tick beyond the ramp, and two stages more
}

TEST_CASE("with trouble a wheel whose feedback stops coming takes the stop to silence within 120 ms") {
  Bench bench;
  Duration silent{0};
  for (int k = 0; k < 10 && silent == Duration{0}; ++k) {
    if (bench.tick_right_silent(0.0, true) == StopStage::kSilent) silent = bench.now - Time{10s} - kTick;
  }
  CHECK(silent > Duration{0});
  CHECK(silent <= 120ms);
}

TEST_CASE("in trouble a wheel that turns again after it stood takes the stop further") {
  Bench bench;
  for (int k = 0; k < 50; ++k) CHECK(bench.tick(0.0, 0.0, true, true) == StopStage::kQuickStop);
  CHECK(bench.tick(0.0, 1.0, true, true) == StopStage::kNetworkStop);
  CHECK(bench.tick(0.0, 1.0, true, true) == StopStage::kSilent);
}

TEST_CASE("a speed that is no number confirms nothing") {
  Bench bench;
  StopStage stage = StopStage::kNone;
  for (int k = 0; k < 8; ++k) stage = bench.tick(0.0, std::numeric_limits<double>::quiet_NaN());
  CHECK(stage == StopStage::kSilent);
}

TEST_CASE("trouble that comes into a stop under way gives it no time anew") {
  Bench bench;
  for (int ms = 0; ms <= 80; ms += 20) CHECK(bench.tick(0.0, 6.0) == StopStage::kNone);
  CHECK(bench.tick(0.0, 6.0, true, true) == StopStage::kQuickStop);  // 100 ms after the order
  CHECK(bench.tick(0.0, 6.0, true, true) == StopStage::kNetworkStop);
  CHECK(bench.tick(0.0, 6.0, true, true) == StopStage::kSilent);
}
