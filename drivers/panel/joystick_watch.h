#pragma once
#include <atomic>
#include <thread>
#include <utility>

#include "drivers/panel/joystick.h"
#include "hal/hal.h"
#include "hal/mailbox.h"

namespace jaywalk::panel {

/// A joystick in a thread of its own, for opening a device and asking it how it stands may block. The loop's thread
/// only reads what was published last, and takes what is older than kLongestAge for a joystick that is gone.
class JoystickWatch {
 public:
  static constexpr Duration kPeriod = std::chrono::milliseconds(10);
  static constexpr Duration kLongestAge = std::chrono::milliseconds(100);

  /// `clock` outlives it and may be used by any thread.
  JoystickWatch(Clock& clock, JoystickSetup setup, BusOf bus = bus_of)
      : clock_(clock), joystick_(std::move(setup), bus) {}
  /// Waits for the thread.
  ~JoystickWatch();
  JoystickWatch(const JoystickWatch&) = delete;
  JoystickWatch& operator=(const JoystickWatch&) = delete;

  /// Starts the thread, with a priority of SCHED_FIFO (0: an ordinary one).
  void start(int priority);
  /// What the thread does every kPeriod: takes in what happened and publishes it. By hand where none was started.
  void step() noexcept;
  /// The loop's thread: how the joystick stands; as one that is gone where step() has not ended for kLongestAge.
  [[nodiscard]] JoystickState latest() noexcept;

 private:
  struct Report {
    JoystickState state;
    Time looked = kNever;
  };

  Clock& clock_;
  Joystick joystick_;
  Mailbox<Report> reports_;
  std::atomic<bool> ending_{false};
  std::thread thread_;
};

}  // namespace jaywalk::panel
