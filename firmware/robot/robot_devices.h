#pragma once
// The devices of a ROBOT.toml, opened.
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "drivers/can/can_bus.h"
#include "drivers/can/socketcan.h"
#include "drivers/laser/scanner_connection.h"
#include "firmware/robot/robot_file.h"

namespace jaywalk {

/// Everything on wires. The constructor opens the bus, deaf still; nothing moves before drive().arm().
class RobotDevices {
 public:
  /// `clock` outlives it. Throws StartupError; also where another process has the bus.
  RobotDevices(const RobotFile& file, Clock& clock);

  [[nodiscard]] ScannerConnection& laser() noexcept { return *lasers_.front(); }
  [[nodiscard]] OfOthers<LaserScanner*> other_lasers() noexcept;
  /// Of each scanner.
  [[nodiscard]] std::span<const std::unique_ptr<ScannerConnection>> lasers() const noexcept { return lasers_; }
  [[nodiscard]] WiredDrive& drive() noexcept { return *drive_; }
  [[nodiscard]] const EmergencyBrake& brake() const noexcept { return brake_; }
  [[nodiscard]] const CanBus& bus() const noexcept { return *bus_; }

  /// Start-up only, when all else is ready: await_first_scan() of each scanner, then listens to the drives, which are
  /// to be armed at once: some speak without being asked, and nobody would fetch it. Throws StartupError.
  void start();

 private:
  const RobotFile& file_;
  Clock& clock_;
  BusLock lock_;
  std::unique_ptr<CanBus> bus_;
  SocketCan* can_;                     ///< the same bus; null: not on CAN
  std::unique_ptr<CanBus> brake_can_;  ///< the same kernel socket: what the guard sends is not another master's
  std::vector<std::unique_ptr<ScannerConnection>> lasers_;
  std::unique_ptr<WiredDrive> drive_;
  EmergencyBrake brake_;
};

/// Not started, not armed. `bus` and `clock` outlive them; a `deaf` CAN bus hears nothing yet. Throw StartupError.
[[nodiscard]] std::unique_ptr<ScannerConnection> make_laser(const RobotFile& file, Clock& clock,
                                                            std::size_t scanner = 0);
[[nodiscard]] std::unique_ptr<CanBus> make_bus(const DriveWiring& wiring, Clock& clock, bool deaf = false);
[[nodiscard]] std::unique_ptr<WiredDrive> make_drive(const DriveWiring& wiring, CanBus& bus, Clock& clock);

/// Start-up only: starts the scanner and awaits its first scan. Throws StartupError: none in time, or not the file's.
void await_first_scan(ScannerConnection& laser, const RobotFile& file, Clock& clock, std::size_t scanner = 0);

/// The ring in this user's runtime folder through which jaywalk_dds and this program share a ROS 2 topic.
[[nodiscard]] std::filesystem::path ring_path(const std::string& topic);

/// The frames that the drives send, and those that another master would. Of CiA 402 drives no others.
[[nodiscard]] std::vector<CanFilter> filters_for(const DriveWiring& wiring);

}  // namespace jaywalk
