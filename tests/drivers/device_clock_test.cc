#include "drivers/laser/scanner_protocol.h"
#include "tests/support/catch.h"

using namespace jaywalk;
using namespace std::chrono_literals;

TEST_CASE("a message held up for 30 ms is late by 30 ms") {
  DeviceClock clock(1us, std::uint64_t{1} << 32U);
  CHECK(clock.delay(1'000'000, Time{10s}) == 0ns);                  // the first: nothing to compare with
  CHECK(clock.delay(1'100'000, Time{10s + 130ms}) == 30ms - 52us);  // 130 ms of drift at 400 ppm are 52 us
  CHECK(clock.delay(1'200'000, Time{10s + 200ms}) == 0ns);  // quicker than the first by the drift that was allowed
}

TEST_CASE("a message faster than the first shows how late the first was") {
  DeviceClock clock(1ms, 1U << 24U);
  CHECK(clock.delay(500, Time{1s}) == 0ns);
  CHECK(clock.delay(600, Time{1s + 60ms}) == 0ns);           // 40 ms less under way
  CHECK(clock.delay(700, Time{1s + 200ms}) == 40ms - 56us);  // as slow as the first; 140 ms at 400 ppm
}

TEST_CASE("a device's clock may wrap between two messages") {
  DeviceClock clock(1us, std::uint64_t{1} << 32U);
  CHECK(clock.delay(0xFFFFFFFFU - 9'999U, Time{1s}) == 0ns);
  CHECK(clock.delay(90'000, Time{1s + 100ms}) == 0ns);            // 10 ms to the wrap and 90 ms beyond it
  CHECK(clock.delay(190'000, Time{1s + 300ms}) == 100ms - 80us);  // 200 ms of drift
}

TEST_CASE("a device whose clock is slow by 100 ppm never looks late") {
  DeviceClock clock(1us, std::uint64_t{1} << 32U);
  for (std::uint64_t k = 0; k < 36'000; ++k) {  // an hour
    const Duration late = clock.delay(k * 99'990, Time{k * 100ms});
    REQUIRE(late == 0ns);
  }
}

TEST_CASE("a device whose clock was set back is believed again at once") {
  DeviceClock clock(1us, std::uint64_t{1} << 32U);
  CHECK(clock.delay(5'000'000, Time{1s}) == 0ns);
  CHECK(clock.delay(0, Time{1s + 100ms}) == 0ns);
  CHECK(clock.delay(100'000, Time{1s + 200ms}) == 0ns);
  clock.forget();
  CHECK(clock.delay(7, Time{9s}) == 0ns);
}
