#pragma once
// [drive] of ROBOT.toml: which drives turn the wheels, and on which bus.
#include <array>
#include <cstdint>
#include <string>

#include "drivers/arcos/arcos_base.h"
#include "drivers/canopen/drive_base.h"
#include "drivers/motor/odrive.h"
#include "drivers/motor/vesc.h"
#include "drivers/ros/ros_base.h"
#include "hal/toml_file.h"
#include "hal/types/robot_model.h"

namespace jaywalk {

// Serial line or TCP port of a device, as a robot file gives it.

struct ByteWiring {
  std::string host;  ///< empty: on a serial line
  std::uint16_t port = 0;
  std::string device;
  std::uint32_t baud = 0;
};

/// Reads host and port, or device and baud of a `what` ("scanner"); the maker's 0: none has that. Throws StartupError.
[[nodiscard]] ByteWiring read_byte_wiring(TomlTable& table, const std::string& what, std::uint16_t makers_port,
                                          std::uint32_t makers_baud);

/// "/dev/ttyUSB0", "192.168.0.1:8101".
[[nodiscard]] std::string name_of(const ByteWiring& wiring);

enum class DriveKind { kCia402, kOdrive, kVesc, kDds, kPioneer };

struct DriveWiring {
  DriveKind kind = DriveKind::kCia402;
  /// CAN interface; of a ROS 2 base the topic of its commands, of a Pioneer its line or address.
  std::string can;
  ByteWiring line;  ///< of a Pioneer
  /// Left, right (m). The drives' scales hold what differs from the model's radius: to all else both wheels have that.
  std::array<double, 2> wheel_radii_m{};
  canopen::DriveBaseSetup cia402;
  odrive::BaseSetup odrive;
  vesc::BaseSetup vesc;
  ros::BaseSetup ros;
  arcos::BaseSetup arcos;

  [[nodiscard]] bool is_on_can() const noexcept { return kind != DriveKind::kDds && kind != DriveKind::kPioneer; }
  /// Left, right; without numbers where the base has none, and of scale 1 where it has no wheels of its own.
  [[nodiscard]] std::array<CanAxis, 2> axes() const noexcept;
};

/// Reads the table to its end; a track width of its own goes into the model. `tick`: the loop's period, two of which
/// every drive's timeout outlasts, or one late tick would trip it. Throws StartupError.
[[nodiscard]] DriveWiring read_drive(TomlTable table, RobotModel& model, Duration tick);

}  // namespace jaywalk
