#pragma once
// The devices of a ROBOT.toml, opened.
#include <memory>
#include <string>
#include <vector>

#include "drivers/can/socketcan.h"
#include "drivers/canopen/quick_stopper.h"
#include "drivers/laser/scanner_connection.h"
#include "firmware/robot/robot_file.h"

namespace jaywalk {

/// Everything on wires. The constructor opens the bus; nothing moves before drive().arm().
class RobotDevices {
 public:
  /// `clock` outlives it. Throws StartupError.
  RobotDevices(const RobotFile& file, Clock& clock);

  [[nodiscard]] ScannerConnection& laser() noexcept { return *laser_; }
  [[nodiscard]] WiredDrive& drive() noexcept { return *drive_; }
  [[nodiscard]] EmergencyBrake& brake() noexcept { return *brake_; }
  [[nodiscard]] CanHealth bus_health() const noexcept { return bus_.health(); }

  /// Start-up only: starts the scanner and waits for its first scan. Throws StartupError where none comes in time, or
  /// where it is not the scanner that the file describes.
  void await_first_scan();

 private:
  const RobotFile& file_;
  Clock& clock_;
  SocketCan bus_;
  SocketCan brake_bus_;
  std::unique_ptr<ScannerConnection> laser_;
  std::unique_ptr<WiredDrive> drive_;
  std::unique_ptr<EmergencyBrake> brake_;
};

/// The frames that the drives send, and of CiA 402 drives no others.
[[nodiscard]] std::vector<CanFilter> filters_for(const DriveWiring& wiring);

}  // namespace jaywalk
