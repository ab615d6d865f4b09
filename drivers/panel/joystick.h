#pragma once
// A joystick or a box of buttons as Linux shows it.
#include <array>
#include <atomic>
#include <cstdint>
#include <optional>
#include <string>
#include <thread>
#include <utility>

#include "drivers/wire/file_descriptor.h"
#include "hal/hal.h"
#include "hal/mailbox.h"
#include "hal/types/time.h"

struct input_event;  // <linux/input.h>

namespace jaywalk::panel {

/// Which of a device's buttons and axes mean what, by the numbers of <linux/input-event-codes.h>.
struct JoystickSetup {
  std::string path;                ///< "/dev/input/by-id/...-event-joystick"; it may be plugged in later
  std::uint16_t dead_man = 0x136;  ///< BTN_TL, the left shoulder
  std::uint16_t stop = 0x131;      ///< BTN_EAST
  /// The stop is a contact that opens: released, and not known, mean stop. So a wire that breaks stops.
  bool stop_opens = false;
  std::uint16_t reset = 0x13B;   ///< BTN_START
  std::uint16_t forward = 0x01;  ///< ABS_Y: pushed away counts down
  std::uint16_t left = 0x00;     ///< ABS_X: to the left counts down
  /// The dead man counts for so long after the newest event of any button or axis; then it must be released and pressed
  /// anew. 0: for as long as it is held, as befits a cable.
  Duration dead_man_renew{0};
  /// A device that does not tell of the stop, and of the dead man and the stick where they are needed, counts as gone.
  bool asks_device = false;
  bool needs_dead_man = true, steers = false;
};

struct JoystickState {
  bool connected = false;  ///< all else is false or 0 where it is not, but stop is true
  bool dead_man = false;   ///< held, and seen released since it was connected: one that is tied down does not count
  bool stop = true;
  std::uint32_t stops = 0;  ///< how often stop began: one that is let go at once is seen all the same
  bool reset = false;
  /// On Bluetooth and without dead_man_renew: a link that dies would leave the dead man held. It counts as released.
  bool needs_renewal = false;
  /// -1 to 1; 0 near the middle, without the dead man, and until both were in the middle while it was held: a stick
  /// that is pushed when the dead man is pressed moves nothing.
  double forward = 0.0;
  double left = 0.0;  ///< the same
};

/// Asks an open device on which bus it is, by the numbers of <linux/input.h>; nothing where it does not answer.
using BusOf = std::optional<std::uint16_t> (*)(int device) noexcept;
[[nodiscard]] std::optional<std::uint16_t> bus_of(int device) noexcept;

/// A joystick or a box of buttons behind evdev; a device that goes is looked for twice a second, and opening it may
/// block. The kernel tells changes only: a device that is dead without the kernel's knowing looks as it last was. A
/// radio's receiver on USB is one of these, and cannot be told from a cable; see JoystickSetup::dead_man_renew.
/// Thread: one; no memory is taken after construction.
class Joystick {
 public:
  explicit Joystick(JoystickSetup setup, BusOf bus = bus_of) : setup_(std::move(setup)), ask_bus_(bus) {}
  /// Takes in what happened since.
  void poll(Time now) noexcept;
  [[nodiscard]] JoystickState state() const noexcept;

 private:
  struct Axis {
    std::int32_t least = -32767, most = 32767, value = 0;
    [[nodiscard]] double share() const noexcept;
  };
  enum class Button : std::uint8_t { kUnknown, kReleased, kPressed };

  void open() noexcept;
  void close() noexcept { device_ = wire::FileDescriptor(); }
  void ask_present_state() noexcept;
  void read() noexcept;
  void take(const input_event& event) noexcept;
  void take_button(std::uint16_t code, bool pressed) noexcept;
  void count_stop() noexcept;
  void expire_dead_man(Time now) noexcept;
  void note_centred() noexcept;
  [[nodiscard]] bool is_held() const noexcept;
  [[nodiscard]] bool stops() const noexcept;

  JoystickSetup setup_;
  BusOf ask_bus_;
  bool on_bluetooth_ = false;
  wire::FileDescriptor device_;
  Time tried_ = kNever;
  Button dead_man_ = Button::kUnknown, stop_ = Button::kUnknown, reset_ = Button::kUnknown;
  bool seen_released_ = false;
  bool seen_centred_ = false;  ///< since the dead man is held
  bool heard_ = false;         ///< an event of a button or an axis since the last poll()
  Time heard_at_ = kNever;
  bool stopped_before_ = true;
  std::uint32_t stops_ = 0;
  Axis forward_, left_;
};

/// What an input device says that it has (EVIOCGBIT), a bit for each number of <linux/input-event-codes.h>.
struct DeviceKeys {
  bool answers = false;       ///< it is an evdev device
  bool old_joystick = false;  ///< it is one of the older interface, /dev/input/js0 say
  std::array<std::uint8_t, 96> buttons{};
  std::array<std::uint8_t, 8> axes{};
};

/// Asks an open device.
[[nodiscard]] DeviceKeys keys_of(int device) noexcept;

/// Which of the buttons and axes that a setup needs the device lacks, in words; empty where it has them all.
[[nodiscard]] std::string lacking(const DeviceKeys& keys, const JoystickSetup& setup);

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

 private:
  OperatorPanel& goals_;
  JoystickWatch& joystick_;
  std::uint32_t stops_ = 0;  ///< of the joystick, at the last call
  bool needs_dead_man_, stick_drives_;
};

}  // namespace jaywalk::panel
