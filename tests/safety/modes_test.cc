#include "firmware/safety/supervisor.h"
#include "tests/support/catch.h"

using namespace jaywalk;

namespace {

/// Every input that there is, by its bits.
constexpr ModeInput input_of(unsigned bits) {
  const auto bit = [bits](unsigned k) { return ((bits >> k) & 1U) != 0; };
  return {.fault = bit(0),
          .latches = bit(1),
          .stop_pressed = bit(2),
          .reset_edge = bit(3),
          .wants_zero = bit(4),
          .drives_ready = bit(5),
          .has_goal = bit(6),
          .at_goal = bit(7),
          .at_rest = bit(8)};
}
constexpr unsigned kInputs = 1U << 9U;

template <class Visit>
void for_each_step(Visit&& visit) {
  for (const Mode mode :
       {Mode::kStandby, Mode::kArmed, Mode::kDriving, Mode::kTurning, Mode::kStopping, Mode::kLatched}) {
    for (unsigned bits = 0; bits < kInputs; ++bits) {
      const ModeInput in = input_of(bits);
      visit(mode, in, next_mode(mode, in));
    }
  }
}

bool lets_setpoints_out(Mode mode) { return mode == Mode::kDriving || mode == Mode::kTurning; }

}  // namespace

TEST_CASE("a fault that latches leads to latched from every mode, but in the tick of a reset") {
  for_each_step([](Mode from, const ModeInput& in, Mode to) {
    if (in.latches && from != Mode::kLatched) CHECK(to == Mode::kLatched);
    if (in.fault) CHECK_FALSE(lets_setpoints_out(to));
  });
}

TEST_CASE("latched is left by a reset's edge with the button released and a wanted twist of zero, and to rest") {
  int ways_out = 0;
  for_each_step([&](Mode from, const ModeInput& in, Mode to) {
    if (from != Mode::kLatched || to == Mode::kLatched) return;
    ++ways_out;
    CHECK(in.reset_edge);
    CHECK(in.wants_zero);
    CHECK_FALSE(in.stop_pressed);
    CHECK(to == (in.drives_ready && !in.latches ? Mode::kArmed : Mode::kStandby));
  });
  CHECK(ways_out > 0);
}

TEST_CASE("setpoints leave only with drives that are ready, and never straight from standby unless the wish was zero") {
  for_each_step([](Mode from, const ModeInput& in, Mode to) {
    if (!lets_setpoints_out(to)) return;
    CHECK(in.drives_ready);
    CHECK(in.has_goal);
    if (from == Mode::kStandby) CHECK(in.wants_zero);
  });
}
