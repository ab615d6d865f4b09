#include "firmware/robot/robot_loop.h"

#include <sys/mman.h>

#include <condition_variable>
#include <mutex>
#include <nlohmann/json.hpp>
#include <thread>

#include "apps/report/run_observer.h"
#include "firmware/backends.h"
#include "tests/robot/wired_bench.h"

using namespace jaywalk;
using namespace std::chrono_literals;

namespace {

ChosenPlanner in_thread(const ControlSetup& setup) {
  static TickObserver nobody;
  ChosenPlanner chosen = make_planner(setup);
  chosen.planner = std::make_unique<PlannerThread>(std::move(chosen.planner), map_for(setup), nobody);
  return chosen;
}

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

struct Bench {
  Bench() { guard.start(0); }
  ~Bench() { clock.end(); }
  void beat_for(Duration time) {
    for (const Time end = clock.now() + time; clock.now() < end; clock.pass(5ms)) guard.beat(clock.now());
  }

  SteppedClock clock;
  std::atomic<int> braked{0};
  StallGuard guard{[this] { ++braked; }, clock, 100ms};
};

}  // namespace

TEST_CASE("a loop that is prepared and never started lives through no tick") {
  tests::WiredBench bench("robot");
  RobotLoop& loop = bench.robot.loop();
  CHECK(loop.prepare({.priority = 0}).empty());
  CHECK_FALSE(loop.has_ended());
  CHECK(loop.traces().front() == nullptr);
}

// In real time, with every thread that a run has. Nothing here depends on this machine's being in time: a tick that is
// missed latches, and ends all the same.
TEST_CASE("the loop's thread tells of its ticks, and ramps to rest and disarms when it is told to end") {
  const Scratch scratch;
  rig::RealLivingClock clock;
  RunObserver observer;
  rig::InProcessRobot robot(tests::robot_in(scratch.folder(), tests::rig_file("robot")),
                            sim::load_scenario(tests::rig_file("hall")), 3, clock,
                            {scratch.folder(), in_thread, &observer});
  clock.live = [&robot] { robot.step_far_end(); };
  robot.laser().start();
  while (robot.laser().latest().sequence == 0) clock.sleep_until(clock.now() + 1ms);
  RobotLoop& loop = robot.loop();
  CHECK(loop.prepare({.priority = 0}).empty());
  CHECK(loop.traces().front() == nullptr);
  static_cast<void>(robot.drive().arm());
  // From here on the loop's thread alone sleeps by the clock.
  SteadyClock mine;
  loop.start();
  std::uint64_t ticks = 0;
  bool asked = false;
  while (!loop.has_ended()) {
    mine.sleep_until(mine.now() + 5ms);
    robot.runner().drain();
    for (; loop.traces().front() != nullptr; loop.traces().pop()) ticks = loop.traces().front()->status.ticks;
    if (ticks > 5 && !asked) {
      const std::string said = robot.desk().obey("goto 9 8");
      asked = said == "going\n" || said.starts_with("refused: stopped by missed_ticks");
    }
    if (ticks > 100) loop.end();
  }
  CHECK(asked);
  CHECK(ticks > 100);
  CHECK_FALSE(robot.drive().is_enabled());
  CHECK(robot.far_end().rim_speed() == 0.0);
  CHECK(loop.times().tick_us.count() == loop.times().wake_late_us.count());
  CHECK(loop.times().tick_us.count() > 100);
  CHECK(loop.times().tick_us.max() > 0.0);
  robot.runner().finish({.outcome = "stopped", .loop_times = &loop.times()});
  const auto summary = nlohmann::json::parse(scratch.read("summary.json"));
  for (const char* key : {"wake_late_us", "tick_us"}) {
    for (const char* figure : {"p50", "p99", "p99.9", "max"}) CHECK(summary[key][figure].is_number());
    std::uint64_t counted = 0;
    for (const auto& bin : summary[key]["bins"]) counted += bin[1].get<std::uint64_t>();
    CHECK(counted == loop.times().tick_us.count());
  }
  CHECK(summary["page_faults"]["major"].is_number());
  CHECK(robot.far_end().drive(0).state_name() != "enabled");
}

TEST_CASE("a loop that beats is left alone") {
  Bench bench;
  bench.clock.pass(600ms);  // not begun yet
  bench.beat_for(900ms);
  CHECK(bench.braked == 0);
  bench.guard.rest();
  bench.clock.pass(600ms);
  CHECK(bench.braked == 0);
  CHECK(bench.guard.stalls() == 0);
}

TEST_CASE("a loop that stalls is braked for until it beats again") {
  Bench bench;
  bench.beat_for(50ms);  // the last beat at 45 ms; the guard looks at 25, 50, 75 ms
  bench.clock.pass(250ms);
  CHECK(bench.braked == 7);  // at 150 ms, and every 25 ms to 300 ms
  CHECK(bench.guard.stalls() == 1);
  bench.beat_for(300ms);
  CHECK(bench.braked == 7);
  bench.clock.pass(150ms);
  CHECK(bench.guard.stalls() == 2);
}

TEST_CASE("a run that is refused priority or locked memory does not start, unless it is told otherwise") {
  const std::vector<std::string> refused{
      "no real-time priority: Operation not permitted; run as root, or raise rtprio: ulimit -r 99"};
  CHECK_THROWS_WITH(require_realtime({}, refused),
                    refused.front() + "; or start without it: --allow-no-realtime, or [realtime] required = false");
  CHECK_NOTHROW(require_realtime({}, {}));
  CHECK_NOTHROW(require_realtime({.required = false}, refused));
}

TEST_CASE("a page that is touched for the first time is a fault of the thread that touches it") {
  constexpr std::size_t kPages = 64, kPage = 4096;
  void* const room = ::mmap(nullptr, kPages * kPage, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  REQUIRE(room != MAP_FAILED);
  ::madvise(room, kPages * kPage, MADV_NOHUGEPAGE);
  const PageFaults before = page_faults();
  for (std::size_t page = 0; page < kPages; ++page) static_cast<volatile char*>(room)[page * kPage] = 1;
  const PageFaults touched = page_faults().since(before);
  CHECK(touched.minor >= kPages);
  ::munmap(room, kPages * kPage);
}

TEST_CASE("a ring that is full and empty by turns hands out in order, between two threads nothing is lost or torn") {
  struct Pair {
    int value = 0, same = 0;
  };
  Ring<Pair, 8> ring;
  std::thread writer([&] {
    for (int k = 1; k <= 20000;) {
      Pair* const slot = ring.draft();
      if (slot == nullptr) continue;
      slot->value = slot->same = k++;
      ring.publish();
    }
  });
  int expected = 1;
  bool whole = true;
  while (expected <= 20000) {
    const Pair* const next = ring.front();
    if (next == nullptr) continue;
    whole = whole && next->value == expected && next->same == expected;
    ++expected;
    ring.pop();
  }
  writer.join();
  CHECK(whole);
}
