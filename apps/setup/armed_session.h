#pragma once
// What commissioning and calibration share: the user's consent, the control socket, the devices, and arming. The
// command drives the wheels itself; the control loop does not run.
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "firmware/robot/control_socket.h"
#include "firmware/robot/realtime.h"
#include "firmware/robot/robot_devices.h"

namespace jaywalk {

struct SessionOptions {
  std::filesystem::path robot;           ///< ROBOT.toml
  std::filesystem::path control_socket;  ///< empty: the file's
  bool yes = false;                      ///< consent that the wheels may turn: the program does not ask for it
  bool allow_no_realtime = false;        ///< goes on where the kernel refuses what the file asks for
};

/// Armed while it lives. `jaywalk stop`, SIGINT and SIGTERM are told by stopped(). Once a process.
class ArmedSession {
 public:
  /// `name`: the command's; `motion`: what a person is asked to allow, "The wheels will turn ... Is ... free?" Throws
  /// StartupError where it may not begin.
  ArmedSession(const SessionOptions& options, const std::string& name, const std::string& motion);
  /// Disarms the drives, which are at rest already.
  ~ArmedSession();

  [[nodiscard]] const RobotFile& file() const { return file_; }
  [[nodiscard]] WiredDrive& drive() { return devices_->drive(); }
  /// In the file's order.
  [[nodiscard]] std::span<LaserScanner* const> lasers() { return lasers_; }
  [[nodiscard]] Clock& clock() { return clock_; }
  [[nodiscard]] static bool stopped();

 private:
  RobotFile file_;
  SteadyClock clock_;
  std::unique_ptr<ControlSocket> socket_;
  std::unique_ptr<RobotDevices> devices_;
  std::vector<LaserScanner*> lasers_;  ///< devices_'s
};

}  // namespace jaywalk
