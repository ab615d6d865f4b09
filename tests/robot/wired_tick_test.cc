// A tick of the whole controller over its wires.
#include <sys/mman.h>

#include <cmath>
#include <iostream>
#include <utility>
#include <vector>

#include "apps/view/view_scene.h"
#include "tests/robot/wired_bench.h"
#include "tests/support/file_size_limit.h"

using namespace jaywalk;
using namespace std::chrono_literals;
using Bench = tests::WiredBench;

// A tick takes no time by this clock. What stays is what the structure costs: the verdict of the first tick after a
// scan's last byte uses that scan, and its command is on the bus before anything else happens.
TEST_CASE("a scan is in the verdict of the next tick, whose frames leave within it") {
  Bench bench("robot");
  CHECK(bench.obey("goto 9 8").starts_with("refused"));  // the loop has not begun
  bench.tick();
  CHECK(bench.obey("goto 9 8") == "going\n");
  std::uint32_t used = bench.last().scan.sequence;
  for (int k = 0; k < 250; ++k) {
    bench.tick();
    REQUIRE(bench.robot.bus().sent() == bench.due);
    const auto& messages = bench.robot.messages();
    for (; used < bench.last().scan.sequence; ++used) REQUIRE(bench.due - messages[used] <= 20ms);
    // None that was there is left for later.
    if (used < messages.size()) REQUIRE(messages[used] >= bench.due);
  }
  CHECK(used >= 70);  // 15 a second, 5 s
  CHECK(bench.last().verdict.reasons == Reason::kNone);
  CHECK(bench.speed_mps() > 0.3);
}

TEST_CASE("a disk that is full is told in the status within a second, and the robot drives on") {
  Bench bench("robot");
  bench.tick(10);
  bench.go(100);
  CHECK_FALSE(holds(bench.status(), "not_recorded"));
  const FileSizeLimit disk(1'000);  // less than there is of the recording
  bench.tick(50);
  CHECK(holds(bench.status(), "\nreasons: not_recorded\n"));
  CHECK(bench.status().starts_with("state: driving\n"));
  CHECK(bench.last().verdict.reasons == Reason::kNotRecorded);
  CHECK(bench.speed_mps() > 0.3);
  bench.tick(50);
  CHECK(bench.heap_calls == 0);
}

TEST_CASE("a heading that is asked for over the desk is turned to over the wires, and then the goal is reached") {
  Bench bench("robot");
  bench.tick(10);
  const Pose2 start = bench.robot.runner().setup().start;
  const std::string place = "goto " + std::to_string(start.x) + " " + std::to_string(start.y) + " ";
  CHECK(bench.obey(place + "2.5") == "going\n");
  const auto turns_freely = [&] { return bench.last().verdict.reasons == Reason::kNone && bench.speed_mps() > 0.1; };
  bench.tick_until(250, turns_freely);  // the wheels are proved first
  const std::string on_the_way = bench.status();
  INFO(on_the_way);
  CHECK(on_the_way.starts_with("state: turning\n"));
  // A pivot swings corners where the laser does not look: 0.3 m/s at most there, which the motion keeps by itself.
  CHECK(holds(on_the_way, " 2.5\nreasons: \n"));
  CHECK(bench.speed_mps() > 0.1);
  CHECK(std::fabs(bench.far_end().truth().twist.w_radps) *
            bench.robot.runner().setup().model.footprint.circumscribed_radius_m() <
        0.3);
  bench.heap_calls = 0;
  bench.tick(250);
  CHECK(bench.heap_calls == 0);
  CHECK(bench.status().starts_with("state: reached\n"));
  CHECK(bench.speed_mps() == 0.0);
  CHECK(wrap_angle(bench.last().pose.map_from_robot.heading - 2.5) == Approx(0.0).margin(0.1));
  // Another goal there without a heading is reached as it stands.
  CHECK(bench.obey(place) == "going\n");
  bench.tick(10);
  CHECK(bench.status().starts_with("state: reached\n"));
  CHECK(bench.speed_mps() == 0.0);
}

TEST_CASE("at any rate of the loop ordinary drives, stops and turns are confirmed by the wheels' feedback") {
  for (const int rate_hz : {20, 50, 200}) {
    Bench bench("robot", {}, rate_hz);
    const auto live = [&](double seconds) { bench.tick(static_cast<int>(seconds * rate_hz)); };
    live(0.5);
    for (const char* goal : {"goto 9 8", "goto 3 3 2.5"}) {
      for (const double seconds : {0.3, 1.6}) {
        bench.go(static_cast<int>(seconds * rate_hz), goal);
        CHECK(bench.obey("stop now") == "stopping\n");
        live(1.5);
        REQUIRE(bench.speed_mps() == 0.0);
        REQUIRE(bench.robot.drive().trouble() == DriveTrouble::kNone);
        REQUIRE(bench.last().wheels.stop == StopStage::kNone);
        REQUIRE(bench.robot.drive().is_proved());
        CHECK(bench.obey("reset") == "reset\n");
        bench.tick();
        CHECK_FALSE(bench.is_latched());  // the drives are asked for no proof
        live(0.3);
      }
    }
  }
}

TEST_CASE("ticks and what takes in scans and frames ask nothing of the heap, whatever the devices") {
  for (const char* robot : {"robot", "odrive_hokuyo", "vesc_ld19"}) {
    Bench bench(robot);
    bench.tick(25);
    bench.go(0);
    bench.heap_calls = 0;
    bench.tick(250);
    CHECK(bench.heap_calls == 0);
    // An LD19 has no word for "nothing within reach", and the hall is wider than its 12 m: what lies there is not
    // proven, and the supervisor holds the robot to 0.1 m/s there.
    CHECK(bench.speed_mps() > (std::string(robot) == "vesc_ld19" ? 0.05 : 0.3));
  }
}

/// What the live page has in the loop's thread.
struct PageOfLoop final : TickObserver {
  void after_tick(const TickRecord& record, const ControlLoop& loop) noexcept override { tap.after_tick(record, loop); }
  view::RunTap tap{EvidenceMap(64, 0.1, {})};
};

// A run without a page, one whose page is read, one whose page is not: the ring is full after four snapshots.
TEST_CASE("a live page that looks, or that stops reading, asks nothing of the heap and changes no command") {
  std::vector<std::vector<std::pair<double, double>>> commands;
  for (const char* page : {"none", "reads", "stopped"}) {
    PageOfLoop observer;
    view::RunTap& tap = observer.tap;
    tap.want(page != std::string("none"));
    Bench bench("robot", {}, 50, StickUse::kNone, &observer);
    bench.tick(25);
    CHECK(bench.obey("goto 9 8") == "going\n");
    bench.heap_calls = 0;
    auto& sent = commands.emplace_back();
    std::size_t shown = 0;
    for (int k = 0; k < 200; ++k) {
      bench.tick();
      sent.emplace_back(bench.last().command.left_radps, bench.last().command.right_radps);
      while (page == std::string("reads") && tap.snapshots().front() != nullptr) ++shown, tap.snapshots().pop();
    }
    CHECK(bench.heap_calls == 0);
    CHECK(sent == commands.front());
    CHECK(bench.speed_mps() > 0.3);
    if (page == std::string("reads")) CHECK(shown >= 100);  // 25 a second, 4 s
  }
}

// SAFETY: after arming no page fault. Memory is locked for the whole process, as a run does; what is counted is the
// loop.
TEST_CASE("a thousand busy ticks with memory locked have no page fault") {
  Bench bench("robot");
  const std::vector<std::string> refused = lock_memory();
  if (!refused.empty()) {
    std::cout << "skipped: " << refused.front() << '\n';
    return;
  }
  bench.tick(50);
  bench.go(50);
  PageFaults faults;
  for (int k = 0; k < 1000; ++k) {
    if (k == 500) CHECK(bench.obey("goto 2 3") == "going\n");
    bench.sleep();
    const PageFaults before = page_faults();
    bench.robot.loop().tick(bench.due);
    const PageFaults tick = page_faults().since(before);
    faults.minor += tick.minor;
    faults.major += tick.major;
    bench.drain();
  }
  ::munlockall();
  CHECK(faults.minor == 0);
  CHECK(faults.major == 0);
  CHECK(holds(bench.status(), "\npage_faults: "));
}
