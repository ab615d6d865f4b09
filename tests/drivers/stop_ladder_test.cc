#include <algorithm>
#include <vector>

#include "drivers/wired_drive.h"
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

namespace {

WheelFeedback drives_at(double speed, Time now) { return {speed, now, speed}; }

/// The last tick in which the drives were told anything, counted from the order to stop: the wheel on the left obeys,
/// the other one brakes as it should down to `stuck` and keeps that. Feedback is a tick old.
Duration last_word(double speed, double stuck, Duration tick) {
  StopLadder ladder(stop_limits(10.0, 0.5, tick));
  const Time order{10s};
  static_cast<void>(
      ladder.update(order - tick, false, false, {drives_at(speed, order - tick), drives_at(speed, order - tick)}));
  Duration last{0};
  for (Time now = order; now < order + 3s; now += tick) {
    const double braked = 10.0 * std::max(to_seconds(now - tick - order), 0.0), obeys = std::max(speed - braked, 0.0);
    const WheelFeedback left{obeys, now - tick, 0.0}, right{std::max(obeys, stuck), now - tick, 0.0};
    if (ladder.update(now, true, false, {left, right}) != StopStage::kSilent) last = now - order;
  }
  return last;
}

}  // namespace

TEST_CASE("at any rate of the loop the last word to a wheel that does not stop is within the ramp and 100 ms") {
  for (const Duration tick : {50ms, 40ms, 33ms, 20ms, 10ms, 5ms}) {
    for (double speed = 0.55; speed < 12.0; speed += 0.05) {
      for (double stuck = 0.55; stuck <= speed; stuck += 0.35) {
        CAPTURE(tick.count(), speed, stuck);
        REQUIRE(last_word(speed, stuck, tick) <= duration_from_seconds(speed / 10.0) + 100ms);
      }
    }
  }
}

TEST_CASE("at any rate of the loop a stop that both wheels follow 60 ms late is confirmed, with one late tick too") {
  for (const Duration tick : {50ms, 40ms, 33ms, 20ms, 10ms, 5ms}) {
    for (double speed = 0.0; speed < 12.0; speed += 0.35) {
      for (int late = -1; late < static_cast<int>(1400ms / tick); ++late) {
        StopLadder ladder(stop_limits(10.0, 0.5, tick));
        const Time order{10s};
        Time now = order, before = order - tick;
        auto stage = ladder.update(before, false, false, {drives_at(speed, before), drives_at(speed, before)});
        for (int k = 0; now < order + 1500ms; ++k) {
          const double felt = std::clamp(speed - 10.0 * to_seconds(before - 60ms - order), 0.0, speed);
          stage = std::max(stage, ladder.update(now, true, false, {{{felt, before, 0.0}, {felt, before, 0.0}}}));
          before = now;
          now += k == late ? tick * 3 / 2 : tick;
        }
        CAPTURE(tick.count(), speed, late);
        REQUIRE(stage == StopStage::kNone);
      }
    }
  }
}

TEST_CASE("at 20 Hz the last word to a wheel that does not stop is the network stop") {
  // 2 rad/s: rest after 0.2 s, nothing sent after 0.3 s. The ramp, 120 ms of response and 0.5 rad/s of tolerance take
  // until 170 ms: quick stop at 200 ms; the network stop at 250 ms; at 300 ms a last one, then nothing.
  StopLadder ladder(stop_limits(10.0, 0.5, 50ms));
  std::vector<StopStage> stages;
  Time now = Time{10s} - 50ms;
  static_cast<void>(ladder.update(now, false, false, {drives_at(2.0, now), drives_at(2.0, now)}));
  for (now = Time{10s}; now <= Time{10s} + 400ms; now += 50ms)
    stages.push_back(ladder.update(now, true, false, {{{2.0, now, 0.0}, {0.0, now, 0.0}}}));
  CHECK(stages[3] == StopStage::kNone);
  CHECK(stages[6] == StopStage::kSilent);
  CHECK(std::find(stages.begin(), stages.end(), StopStage::kNetworkStop) != stages.end());
}
