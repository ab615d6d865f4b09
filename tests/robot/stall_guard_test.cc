#include <condition_variable>
#include <mutex>

#include "firmware/robot/robot_loop.h"
#include "tests/support/catch.h"

using namespace jaywalk;
using namespace std::chrono_literals;

namespace {

/// Time that a test moves on, for a thread that sleeps by it: it stands still until that thread sleeps again.
class SteppedClock final : public Clock {
 public:
  [[nodiscard]] Time now() noexcept override {
    const std::scoped_lock lock(mutex_);
    return now_;
  }
  void sleep_until(Time wake) noexcept override {
    std::unique_lock lock(mutex_);
    wake_ = wake;
    changed_.notify_all();
    changed_.wait(lock, [&] { return now_ >= wake || ends_; });
  }
  void pass(Duration time) {
    std::unique_lock lock(mutex_);
    for (const Time end = now_ + time;;) {
      changed_.wait(lock, [&] { return wake_ > now_; });
      if (wake_ > end) return static_cast<void>(now_ = end);
      now_ = wake_;
      changed_.notify_all();
    }
  }
  /// Nobody sleeps any more.
  void end() {
    const std::scoped_lock lock(mutex_);
    ends_ = true;
    changed_.notify_all();
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  Time now_{1h}, wake_{};
  bool ends_ = false;
};

class CountingBrake final : public EmergencyBrake {
 public:
  void brake() noexcept override { ++count; }
  std::atomic<int> count{0};
};

struct Bench {
  Bench() { guard.start(0); }
  ~Bench() { clock.end(); }
  void beat_for(Duration time) {
    for (const Time end = clock.now() + time; clock.now() < end; clock.pass(5ms)) guard.beat(clock.now());
  }

  SteppedClock clock;
  CountingBrake brake;
  StallGuard guard{brake, clock, 100ms};
};

}  // namespace

TEST_CASE("a loop that beats is left alone") {
  Bench bench;
  bench.clock.pass(600ms);  // not begun yet
  bench.beat_for(900ms);
  CHECK(bench.brake.count == 0);
  bench.guard.rest();
  bench.clock.pass(600ms);
  CHECK(bench.brake.count == 0);
  CHECK(bench.guard.stalls() == 0);
}

TEST_CASE("a loop that stalls is braked for until it beats again") {
  Bench bench;
  bench.beat_for(50ms);  // the last beat at 45 ms; the guard looks at 25, 50, 75 ms
  bench.clock.pass(250ms);
  CHECK(bench.brake.count == 7);  // at 150 ms, and every 25 ms to 300 ms
  CHECK(bench.guard.stalls() == 1);
  bench.beat_for(300ms);
  CHECK(bench.brake.count == 7);
  bench.clock.pass(150ms);
  CHECK(bench.guard.stalls() == 2);
}
