#include "firmware/robot/stall_guard.h"

#include "firmware/robot/steady_clock.h"
#include "tests/support/catch.h"

using namespace jaywalk;
using namespace std::chrono_literals;

namespace {

class CountingBrake final : public EmergencyBrake {
 public:
  void brake() noexcept override { ++count; }
  std::atomic<int> count{0};
};

struct Bench {
  Bench() { guard.start(0); }
  void beat_for(Duration time) {
    for (const Time end = clock.now() + time; clock.now() < end; clock.sleep_until(clock.now() + 5ms)) {
      guard.beat(clock.now());
    }
  }
  void keep_still(Duration time) { clock.sleep_until(clock.now() + time); }

  SteadyClock clock;
  CountingBrake brake;
  StallGuard guard{brake, clock, 400ms};  // the limit is long: this machine may be busy
};

}  // namespace

TEST_CASE("a loop that beats is left alone") {
  Bench bench;
  bench.keep_still(600ms);  // not begun yet
  bench.beat_for(900ms);
  CHECK(bench.brake.count == 0);
  bench.guard.rest();
  bench.keep_still(600ms);
  CHECK(bench.brake.count == 0);
  CHECK(bench.guard.stalls() == 0);
}

TEST_CASE("a loop that stalls is braked for until it beats again") {
  Bench bench;
  bench.beat_for(50ms);
  bench.keep_still(1500ms);
  CHECK(bench.brake.count >= 2);  // at 400 ms or so, and every 100 ms from then
  CHECK(bench.guard.stalls() == 1);
  bench.beat_for(300ms);
  const int braked = bench.brake.count;
  bench.beat_for(300ms);
  CHECK(bench.brake.count == braked);
}
