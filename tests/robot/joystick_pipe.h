#pragma once
#include <fcntl.h>
#include <linux/input.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <string>

#include "drivers/wire/file_descriptor.h"
#include "tests/support/catch.h"

namespace jaywalk::tests {

/// A named pipe in the place of a joystick.
class JoystickPipe {
 public:
  JoystickPipe() {
    std::filesystem::remove(path);
    REQUIRE(::mkfifo(path.c_str(), 0600) == 0);
    pipe_ = wire::FileDescriptor(::open(path.c_str(), O_RDWR | O_NONBLOCK));
  }
  ~JoystickPipe() { std::filesystem::remove(path); }
  void press(std::uint16_t button, bool pressed = true) { write(EV_KEY, button, pressed ? 1 : 0); }
  void take_dead_man() { press(BTN_TL, false), press(BTN_TL); }
  /// Lets the stick go for five ticks, and pushes it ahead.
  template <class Bench>
  void push_from_middle(Bench& bench) {
    push(0);
    bench.tick(5);
    push(32767);
  }
  /// Moves the stick, -32767 to 32767; ahead counts down.
  void push(std::int32_t forward) { write(EV_ABS, ABS_Y, -forward); }
  void write(std::uint16_t type, std::uint16_t code, std::int32_t value) {
    input_event event{};
    event.type = type;
    event.code = code;
    event.value = value;
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

}  // namespace jaywalk::tests
