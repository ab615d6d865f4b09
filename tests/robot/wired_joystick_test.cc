// The whole controller with a joystick in front of it.
#include <fcntl.h>
#include <linux/input.h>
#include <sys/stat.h>

#include "tests/robot/wired_bench.h"

using namespace jaywalk;
using namespace std::chrono_literals;
using Bench = tests::WiredBench;

namespace {

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
