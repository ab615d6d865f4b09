// A tick of the whole controller with both ends of its wires in this process, time moved on by hand.
#include <fcntl.h>
#include <linux/input.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <optional>

#include "firmware/far_end/in_process_robot.h"
#include "firmware/far_end/living_clock.h"
#include "tests/support/allocation_guard.h"
#include "tests/support/catch.h"
#include "tests/support/file_size_limit.h"

using namespace jaywalk;
using namespace std::chrono_literals;

namespace {

constexpr Duration kTick = 20ms;

std::string text_of(const std::filesystem::path& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

struct Bench {
  explicit Bench(const std::string& robot_name, const std::optional<PanelWiring>& panel = {}, int rate_hz = 50)
      : folder(std::filesystem::temp_directory_path() /
               ("jaywalk_wired_tick_" + robot_name + std::to_string(::getpid()))),
        period(duration_from_seconds(1.0 / rate_hz)),
        robot(file(robot_name, panel, rate_hz), sim::load_scenario(std::string(JAYWALK_RIG) + "/drive/hall.toml"), 3,
              clock, folder) {
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
  [[nodiscard]] RobotFile file(const std::string& name, const std::optional<PanelWiring>& panel, int rate_hz) const {
    std::filesystem::create_directories(folder);
    const std::filesystem::path mine = folder / "robot.toml";
    std::ofstream(mine) << "rate_hz = " << rate_hz << ".0\n"
                        << text_of(std::string(JAYWALK_RIG) + "/drive/" + name + ".toml");
    RobotFile wiring = load_robot_file(mine);
    wiring.setup.backend = Backend::kCpu;
    wiring.panel = panel;
    if (wiring.laser.host.empty()) wiring.laser.device = folder / "scanner";
    return wiring;
  }
  void sleep() {
    due += period;
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
  Duration period;
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

TEST_CASE(
    "a stranger that takes a drive out of operation latches, and a reset proves both drives before anything moves") {
  Bench bench("robot");
  bench.tick(10);
  CHECK(bench.robot.desk().obey("goto 9 8") == "going\n");
  bench.tick(150);
  REQUIRE(bench.speed_mps() > 0.3);
  CHECK(bench.robot.wires().port(3).send({.id = 0x000, .size = 2, .bytes = {0x80, 2}}) == SendResult::kQueued);
  bench.tick();
  CHECK(has(bench.last().verdict.reasons, Reason::kForeignMaster));
  bench.tick(35);
  CHECK(bench.speed_mps() == 0.0);
  CHECK(bench.last().wheels.stop == StopStage::kSilent);
  const std::string status = bench.robot.desk().obey("status");
  CHECK(status.find("\nlatched_by: foreign_master\n") != std::string::npos);
  CHECK(status.find("\nforeign_frame: 000#8002\n") != std::string::npos);
  bench.tick(30);

  CHECK(bench.robot.desk().obey("reset") == "reset\n");
  bench.tick(2);
  CHECK(has(bench.last().verdict.reasons, Reason::kLatched));
  CHECK(bench.robot.desk().obey("goto 9 8") ==
        "refused: the drives are being proved again; try again in some seconds\n");
  int ticks = 0;
  bench.heap_calls = 0;
  for (; ticks < 250 && has(bench.last().verdict.reasons, Reason::kLatched); ++ticks) bench.tick();
  CHECK(ticks > 20);
  CHECK(ticks < 250);
  CHECK(bench.heap_calls == 0);
  CHECK(bench.speed_mps() == 0.0);
  bench.tick(20);
  CHECK(bench.robot.desk().obey("status").rfind("state: waiting\n", 0) == 0);
  CHECK(bench.robot.desk().obey("goto 9 8") == "going\n");
  bench.tick(100);
  CHECK(bench.speed_mps() > 0.3);
}

TEST_CASE("at any rate of the loop ordinary drives, stops and turns are confirmed by the wheels' feedback") {
  for (const int rate_hz : {20, 200}) {
    Bench bench("robot", {}, rate_hz);
    const auto live = [&](double seconds) { bench.tick(static_cast<int>(seconds * rate_hz)); };
    live(0.5);
    for (const char* goal : {"goto 9 8", "goto 3 3 2.5"}) {
      for (const double seconds : {0.3, 1.6}) {
        CHECK(bench.robot.desk().obey(goal) == "going\n");
        live(seconds);
        CHECK(bench.robot.desk().obey("stop now") == "stopping\n");
        live(1.5);
        REQUIRE(bench.speed_mps() == 0.0);
        REQUIRE(bench.robot.drive().trouble() == DriveTrouble::kNone);
        REQUIRE(bench.last().wheels.stop == StopStage::kNone);
        CHECK(bench.robot.desk().obey("reset") == "reset\n");
        live(0.3);
      }
    }
  }
}

TEST_CASE("an emergency stop over the desk, and a reset after it, ask the drives for no proof") {
  Bench bench("robot");
  bench.tick(10);
  CHECK(bench.robot.desk().obey("goto 9 8") == "going\n");
  bench.tick(150);
  CHECK(bench.robot.desk().obey("stop now") == "stopping\n");
  bench.tick(100);
  CHECK(bench.speed_mps() == 0.0);
  CHECK(bench.last().wheels.stop == StopStage::kNone);
  CHECK(bench.robot.drive().is_proved());
  CHECK(bench.robot.desk().obey("reset") == "reset\n");
  bench.tick();
  CHECK_FALSE(has(bench.last().verdict.reasons, Reason::kLatched));
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

TEST_CASE("after an emergency stop that cut a drive's power a reset proves the drives anew and the robot drives") {
  for (const char* robot : {"odrive_hokuyo", "vesc_ld19"}) {
    Bench bench(robot);
    bench.tick(25);
    CHECK(bench.robot.desk().obey("goto 9 8") == "going\n");
    bench.tick(100);
    CHECK(bench.speed_mps() > 0.3);
    CHECK(bench.robot.desk().obey("stop now").rfind("stop", 0) == 0);
    bench.tick(100);
    bench.robot.far_end().drive(0).pull_cable();
    bench.tick(50);
    CHECK(bench.speed_mps() == 0.0);
    CHECK(bench.last().wheels.trouble == DriveTrouble::kDriveSilent);
    CHECK(bench.last().wheels.stop == StopStage::kSilent);
    bench.robot.far_end().drive(0).plug_cable();
    bench.tick(50);
    bench.heap_calls = 0;
    CHECK(bench.robot.desk().obey("reset").rfind("reset", 0) == 0);
    bench.tick(60);
    CHECK(bench.heap_calls == 0);
    CHECK(bench.robot.drive().is_proved());
    CHECK_FALSE(has(bench.last().verdict.reasons, Reason::kLatched));
    CHECK(bench.speed_mps() == 0.0);
    CHECK(bench.robot.desk().obey("goto 9 8") == "going\n");
    bench.tick(100);
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
