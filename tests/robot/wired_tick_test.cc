// A tick of the whole controller with both ends of its wires in this process, time moved on by hand.
#include <fcntl.h>
#include <linux/input.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <iostream>
#include <optional>

#include "tests/support/allocation_guard.h"
#include "tests/support/catch.h"
#include "tests/support/file_size_limit.h"
#include "tools/rig/plant/in_process_robot.h"
#include "tools/rig/plant/living_clock.h"

using namespace jaywalk;
using namespace std::chrono_literals;

namespace {

constexpr Duration kTick = 20ms;

struct Bench {
  explicit Bench(const std::string& robot_name, const std::optional<PanelWiring>& panel = {})
      : folder(std::filesystem::temp_directory_path() /
               ("jaywalk_wired_tick_" + robot_name + std::to_string(::getpid()))),
        robot(file(robot_name, panel), sim::load_scenario(std::string(JAYWALK_RIG) + "/drive/hall.toml"), 3, clock,
              folder) {
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
  [[nodiscard]] RobotFile file(const std::string& name, const std::optional<PanelWiring>& panel) const {
    std::filesystem::create_directories(folder);
    RobotFile wiring = load_robot_file(std::string(JAYWALK_RIG) + "/drive/" + name + ".toml");
    wiring.setup.backend = Backend::kCpu;
    wiring.panel = panel;
    if (wiring.laser.host.empty()) wiring.laser.device = folder / "scanner";
    return wiring;
  }
  void sleep() {
    due += kTick;
    clock.sleep_until(due);
  }
  void tick() {
    sleep();
    const AllocationGuard guard;
    robot.loop().tick(due);
    heap_calls += guard.calls();
    drain();
  }
  void drain() {
    robot.runner().drain();
    while (robot.loop().traces().front() != nullptr) robot.loop().traces().pop();
  }
  void tick(int times) {
    for (int k = 0; k < times; ++k) tick();
  }
  [[nodiscard]] double speed_mps() { return robot.far_end().rim_speed(); }
  [[nodiscard]] const TickRecord& last() { return robot.runner().last(); }

  std::filesystem::path folder;
  rig::HandLivingClock clock;
  std::uint64_t heap_calls = 0;
  rig::InProcessRobot robot;
  Time due{};
};

/// A named pipe in the place of a joystick.
class Joystick {
 public:
  Joystick() {
    std::filesystem::remove(path);
    REQUIRE(::mkfifo(path.c_str(), 0600) == 0);
    pipe_ = wire::FileDescriptor(::open(path.c_str(), O_RDWR | O_NONBLOCK));
  }
  ~Joystick() { std::filesystem::remove(path); }
  void press(std::uint16_t button, bool pressed = true) {
    input_event event{};
    event.type = EV_KEY;
    event.code = button;
    event.value = pressed ? 1 : 0;
    REQUIRE(::write(pipe_.get(), &event, sizeof event) == sizeof event);
  }
  void pull() {
    std::filesystem::remove(path);
    pipe_ = wire::FileDescriptor();
  }
  const std::string path = std::filesystem::temp_directory_path() / ("jaywalk_tick_" + std::to_string(::getpid()));

 private:
  wire::FileDescriptor pipe_;
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
  CHECK(bench.speed_mps() > 0.3);
}

TEST_CASE("a disk that is full is told in the status within a second, and the robot drives on") {
  Bench bench("robot");
  bench.tick(10);
  CHECK(bench.robot.desk().obey("goto 9 8") == "going\n");
  bench.tick(100);
  CHECK(bench.robot.desk().obey("status").find("not_recorded") == std::string::npos);
  const FileSizeLimit disk(1'000);  // less than there is of the recording
  bench.tick(50);
  CHECK(bench.robot.desk().obey("status").find("\nreasons: not_recorded\n") != std::string::npos);
  CHECK(bench.robot.desk().obey("status").rfind("state: driving\n", 0) == 0);
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
  CHECK(bench.robot.desk().obey(place + "2.5") == "going\n");
  bench.tick(40);
  const std::string on_the_way = bench.robot.desk().obey("status");
  CHECK(on_the_way.rfind("state: turning\n", 0) == 0);
  CHECK(on_the_way.find(" 2.5\nreasons: \n") != std::string::npos);
  CHECK(bench.speed_mps() > 0.1);
  bench.heap_calls = 0;
  bench.tick(250);
  CHECK(bench.heap_calls == 0);
  CHECK(bench.robot.desk().obey("status").rfind("state: reached\n", 0) == 0);
  CHECK(bench.speed_mps() == 0.0);
  CHECK(wrap_angle(bench.last().pose.map_from_robot.heading - 2.5) == Approx(0.0).margin(0.1));
  // Another goal there without a heading is reached as it stands.
  CHECK(bench.robot.desk().obey(place) == "going\n");
  bench.tick(10);
  CHECK(bench.robot.desk().obey("status").rfind("state: reached\n", 0) == 0);
  CHECK(bench.speed_mps() == 0.0);
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
    CHECK(bench.speed_mps() > 0.3);
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
  CHECK(bench.robot.desk().obey("goto 9 8") == "going\n");
  bench.tick(50);
  PageFaults faults;
  for (int k = 0; k < 1000; ++k) {
    if (k == 500) CHECK(bench.robot.desk().obey("goto 2 3") == "going\n");
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
  CHECK(bench.robot.desk().obey("status").find("\npage_faults: ") != std::string::npos);
}

TEST_CASE("with a joystick the robot drives while its dead man is held, and its stop and reset are the robot's") {
  Joystick joystick;
  Bench bench("robot", PanelWiring{.joystick = {.path = joystick.path}});
  bench.tick(10);
  CHECK(bench.robot.desk().obey("goto 9 8") == "going\n");
  bench.tick(50);
  CHECK(bench.speed_mps() == 0.0);
  joystick.press(BTN_TL, false);  // a button that was never seen released is tied down
  joystick.press(BTN_TL);
  bench.tick(100);
  CHECK(bench.speed_mps() > 0.3);
  joystick.press(BTN_TL, false);
  bench.tick(100);
  CHECK(bench.speed_mps() == 0.0);
  CHECK(has(bench.last().verdict.reasons, Reason::kNoGoal));
  CHECK_FALSE(has(bench.last().verdict.reasons, Reason::kLatched));
  joystick.press(BTN_TL);
  bench.tick(100);
  CHECK(bench.speed_mps() > 0.3);

  joystick.press(BTN_EAST);
  bench.tick(100);
  CHECK(bench.speed_mps() == 0.0);
  joystick.press(BTN_EAST, false);
  bench.tick(50);
  CHECK(has(bench.last().verdict.reasons, Reason::kLatched));
  joystick.press(BTN_START);
  bench.tick(50);
  CHECK_FALSE(has(bench.last().verdict.reasons, Reason::kLatched));
  CHECK(bench.speed_mps() == 0.0);  // the goal went with the stop
  CHECK(bench.robot.desk().obey("goto 9 8") == "going\n");
  bench.tick(100);
  CHECK(bench.speed_mps() > 0.3);
  joystick.pull();
  bench.tick(100);
  CHECK(bench.speed_mps() == 0.0);
  CHECK(has(bench.last().verdict.reasons, Reason::kEmergencyStop));
}
