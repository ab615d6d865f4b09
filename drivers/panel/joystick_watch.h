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

/// A joystick in front of whatever else tells the robot what to do: it adds its stop and its reset, and lets the goal
/// through only while the dead man's button is held. A joystick that is gone is an emergency stop. Where the stick
/// drives, it does so when it leaves its middle, goal or no goal, and goes on while there is none.
class JoystickPanel final : public OperatorPanel {
 public:
  /// Both outlive it. Without `needs_dead_man` the goal always passes, and no stick drives.
  JoystickPanel(OperatorPanel& goals, JoystickWatch& joystick, bool needs_dead_man, bool stick_drives = false) noexcept
      : goals_(goals), joystick_(joystick), needs_dead_man_(needs_dead_man), stick_drives_(stick_drives) {}

  [[nodiscard]] OperatorInput latest() noexcept override;
  /// As of the last call of latest().
  [[nodiscard]] const JoystickState& joystick() const noexcept { return state_; }

 private:
  OperatorPanel& goals_;
  JoystickWatch& joystick_;
  JoystickState state_;
  bool needs_dead_man_, stick_drives_;
};

}  // namespace jaywalk::panel
