#pragma once
// A joystick that says what a test writes, and the panel behind it.
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <string>
#include <thread>
#include <vector>

#include "drivers/panel/joystick.h"
#include "tests/drivers/hand_clock.h"
#include "tests/support/allocation_guard.h"
#include "tests/support/catch.h"

namespace jaywalk::panel::tests {

using namespace std::chrono_literals;
using Octets = std::vector<std::uint8_t>;

inline constexpr std::uint16_t kDeadMan = 0x136, kStop = 0x131, kReset = 0x13B, kX = 0, kY = 1;

/// An event as the kernel lays it out where time takes two longs: both of them, type, code, value.
inline Octets event(std::uint8_t type, std::uint16_t code, std::int32_t value) {
  Octets made(2 * sizeof(long), 0xA5);
  made.push_back(type);
  made.push_back(0);
  made.push_back(static_cast<std::uint8_t>(code));
  made.push_back(static_cast<std::uint8_t>(code >> 8U));
  for (int shift = 0; shift < 32; shift += 8) {
    made.push_back(static_cast<std::uint8_t>(static_cast<std::uint32_t>(value) >> shift));
  }
  return made;
}

struct GoalAtOne final : OperatorPanel {
  [[nodiscard]] OperatorInput latest() noexcept override {
    OperatorInput input;
    input.has_goal = true;
    input.goal_in_map = {1.0, 0.0};
    return input;
  }
};

/// A named pipe in the place of a device: it says what a test writes, and nothing when asked how things stand.
class Bench {
 public:
  explicit Bench(bool stop_opens = false, Duration renew = 0s, BusOf bus = bus_of, bool stick_drives = false)
      : path_((std::filesystem::temp_directory_path() / ("jaywalk_panel_" + std::to_string(::getpid()))).string()),
        watch(clock, {.path = path_, .stop_opens = stop_opens, .dead_man_renew = renew}, bus),
        panel(goals, watch, true, stick_drives) {
    std::filesystem::remove(path_);
  }
  ~Bench() { std::filesystem::remove(path_); }

  [[nodiscard]] const std::string& path() const { return path_; }
  void plug_in() {
    REQUIRE(::mkfifo(path_.c_str(), 0600) == 0);
    writer_ = wire::FileDescriptor(::open(path_.c_str(), O_RDWR | O_NONBLOCK));
  }
  void pull() {
    std::filesystem::remove(path_);
    writer_ = wire::FileDescriptor();
  }
  void write(const Octets& bytes) {
    REQUIRE(::write(writer_.get(), bytes.data(), bytes.size()) == static_cast<ssize_t>(bytes.size()));
  }
  void press(std::uint16_t code, bool pressed = true) { write(event(EV_KEY, code, pressed ? 1 : 0)); }
  void press_dead_man() {
    press(kDeadMan, false);
    press(kDeadMan);
  }
  /// Plugs it in and holds its dead man's button after that was seen released.
  void plug_in_and_hold() {
    plug_in();
    static_cast<void>(after(0ms));
    press_dead_man();
  }
  OperatorInput after(Duration time) {
    clock.sleep_until(clock.now() + time);
    watch.step();
    return tick();
  }
  OperatorInput tick() {
    const AllocationGuard guard;
    const OperatorInput input = panel.latest();
    heap_calls += guard.calls();
    return input;
  }

 private:
  std::string path_;
  wire::FileDescriptor writer_;

 public:
  GoalAtOne goals;
  jaywalk::tests::HandClock clock;
  JoystickWatch watch;
  JoystickPanel panel;
  std::uint64_t heap_calls = 0;
};

}  // namespace jaywalk::panel::tests
