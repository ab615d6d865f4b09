// A tick of the whole controller with both ends of its wires in this process, time moved on by hand.
#include <filesystem>
#include <functional>

#include "tests/support/allocation_guard.h"
#include "tests/support/catch.h"
#include "tools/rig/plant/in_process_robot.h"

using namespace jaywalk;
using namespace std::chrono_literals;

namespace {

constexpr Duration kTick = 20ms;

/// Whoever sleeps lets the wires' far end and the scanner's thread live, a millisecond at a time.
class LivingClock final : public Clock {
 public:
  [[nodiscard]] Time now() noexcept override { return now_; }
  void sleep_until(Time wake) noexcept override {
    while (now_ < wake) {
      now_ += 1ms;
      if (live) live();
    }
  }
  std::function<void()> live;

 private:
  Time now_{};
};

struct Bench {
  explicit Bench(const std::string& robot_name)
      : folder(std::filesystem::temp_directory_path() / ("jaywalk_wired_tick_" + robot_name)),
        robot(file(robot_name), sim::load_scenario(std::string(JAYWALK_RIG) + "/drive/hall.toml"), 3, clock, folder) {
    clock.live = [this] {
      robot.step_far_end();
      const AllocationGuard guard;
      robot.laser().step();
      heap_calls += guard.calls();
    };
    while (robot.laser().latest().sequence == 0 && clock.now() < Time{5s}) clock.sleep_until(clock.now() + 1ms);
    static_cast<void>(robot.drive().arm());
    due = clock.now();
  }
  ~Bench() { std::filesystem::remove_all(folder); }
  [[nodiscard]] RobotFile file(const std::string& name) const {
    std::filesystem::create_directories(folder);
    RobotFile wiring = load_robot_file(std::string(JAYWALK_RIG) + "/drive/" + name + ".toml");
    wiring.setup.backend = Backend::kCpu;
    if (wiring.laser.host.empty()) wiring.laser.device = folder / "scanner";
    return wiring;
  }
  void tick() {
    due += kTick;
    clock.sleep_until(due);
    const AllocationGuard guard;
    robot.loop().tick(due);
    heap_calls += guard.calls();
    robot.runner().drain();
    while (robot.loop().traces().front() != nullptr) robot.loop().traces().pop();
  }
  [[nodiscard]] const TickRecord& last() { return robot.runner().last(); }

  std::filesystem::path folder;
  LivingClock clock;
  std::uint64_t heap_calls = 0;
  rig::InProcessRobot robot;
  Time due{};
};

}  // namespace

// A tick takes no time by this clock. What stays is what the structure costs: the verdict of the first tick after a
// scan's last byte uses that scan, and its command is on the bus before anything else happens.
TEST_CASE("a scan is in the verdict of the next tick, whose frames leave within it") {
  Bench bench("robot");
  CHECK(bench.robot.desk().obey("goto 9 8").rfind("refused", 0) == 0);  // the loop has not begun
  bench.tick();
  CHECK(bench.robot.desk().obey("goto 9 8") == "going\n");
  std::uint32_t used = bench.last().scan.sequence;
  for (int k = 0; k < 250; ++k) {
    bench.tick();
    REQUIRE(bench.robot.bus().sent() == bench.due);
    const auto& messages = bench.robot.messages();
    for (; used < bench.last().scan.sequence; ++used) REQUIRE(bench.due - messages[used] <= kTick);
    // None that was there is left for later.
    if (used < messages.size()) REQUIRE(messages[used] >= bench.due);
  }
  CHECK(used >= 70);  // 15 a second, 5 s
  CHECK(bench.last().verdict.reasons == Reason::kNone);
  CHECK(bench.robot.far_end().rim_speed() > 0.3);
}

TEST_CASE("ticks and what takes in scans and frames ask nothing of the heap, whatever the devices") {
  for (const char* robot : {"robot", "odrive_hokuyo", "vesc_ld19"}) {
    Bench bench(robot);
    for (int k = 0; k < 25; ++k) bench.tick();
    CHECK(bench.robot.desk().obey("goto 9 8") == "going\n");
    bench.heap_calls = 0;
    for (int k = 0; k < 100; ++k) bench.tick();
    const auto calls = bench.heap_calls;
    CHECK(calls == 0);
    CHECK(bench.robot.far_end().rim_speed() > 0.3);
  }
}
