#pragma once
// Emulated drives and scanners at the far end of the wires, as a robot file has them.
#include <array>
#include <memory>
#include <string_view>
#include <vector>

#include "firmware/robot/robot_file.h"
#include "hil/emulators/drive_objects.h"
#include "hil/emulators/scanner_server.h"

namespace jaywalk::rig {

/// An ODrive's watchdog as docs/tutorial/first-real-robot.md advises it; longer where the loop is slow.
constexpr Duration kOdriveWatchdog = std::chrono::milliseconds(60);

/// One wheel's drive at the far end of the bus, of any kind, in the wheel's units.
class WheelDrive {
 public:
  virtual ~WheelDrive() = default;
  /// Takes what came in and moves the motor on to `now`.
  virtual void step(Time now) = 0;
  /// rad/s, forward positive, as the drive would have the wheel turn.
  [[nodiscard]] virtual double speed_radps() const noexcept = 0;
  /// What its encoder shows from now on.
  virtual void measure(double speed_radps, double turned_rad) noexcept = 0;
  [[nodiscard]] virtual std::string_view state_name() const noexcept = 0;
  /// When the controller was heard last; kNever before the first time.
  [[nodiscard]] virtual Time heard_controller() const noexcept = 0;
  /// Something broke, and it says so; `code` in its own numbers.
  virtual void raise_fault(std::uint16_t code) noexcept = 0;
  virtual void pull_cable() noexcept = 0;
  virtual void plug_cable() noexcept = 0;
  /// Power lost and back.
  virtual void restart() noexcept = 0;
  /// It goes on at its last target, whatever it is told; its watch over the controller works.
  virtual void stick() noexcept = 0;
  /// It obeys, and says nothing of its wheel any more.
  virtual void lose_feedback() noexcept = 0;
  /// Delays the mode that a CiA 402 drive shows after it is enabled.
  virtual void show_mode_late(Duration) noexcept {}
  /// Sets the wheel's speed below which a VESC lets its motor go.
  virtual void let_go_below(double /*speed_radps*/) noexcept {}
  /// Sets the watchdog that a Pioneer's board has in its FLASH.
  virtual void set_watchdog(Duration) noexcept {}
  /// Presses a Pioneer's stop button.
  virtual void press_stop() noexcept {}
  /// What a CiA 402 drive can be told to lie about or to lack; null of others.
  [[nodiscard]] virtual emulators::DriveObjects* objects() noexcept { return nullptr; }
};

/// The far end of what the controller's side says about its drives: left, right. Each place on the bus outlives its
/// drive; a Pioneer's board is at the left one alone.
[[nodiscard]] std::array<std::unique_ptr<WheelDrive>, 2> make_wheel_drives(const DriveWiring& wiring,
                                                                           const std::array<CanBus*, 2>& buses);

/// One of them, on side 0 (left) or 1; not of a Pioneer.
[[nodiscard]] std::unique_ptr<WheelDrive> make_wheel_drive(const DriveWiring& wiring, std::size_t side, CanBus& bus);

using FarWires = std::vector<std::unique_ptr<emulators::ByteServer>>;

/// The far end of a device's wire: a port of this machine, or a pseudo terminal in place of the serial device. Throws
/// StartupError where it cannot be.
[[nodiscard]] std::unique_ptr<emulators::ByteServer> make_far_wire(const ByteWiring& wiring);

/// One for each scanner of a robot. Those on a network listen at any port that is free where `any_port` says so.
[[nodiscard]] FarWires make_far_wires(const RobotFile& wiring, bool any_port = false);

/// The far end of what the controller's side says about its scanner.
[[nodiscard]] std::unique_ptr<emulators::ScannerServer> make_far_scanner(const LaserWiring& wiring,
                                                                         const LaserModel& model,
                                                                         std::unique_ptr<emulators::ByteServer> wire,
                                                                         emulators::ScannerServer::World world);

}  // namespace jaywalk::rig
