#pragma once
// [drive] of ROBOT.toml: which drives turn the wheels, and on which bus.
#include <string>

#include "drivers/canopen/drive_base.h"
#include "drivers/motor/odrive_base.h"
#include "drivers/motor/vesc_base.h"
#include "hal/toml_file.h"
#include "hal/types/robot_model.h"

namespace jaywalk {

enum class DriveKind { kCia402, kOdrive, kVesc };

struct DriveWiring {
  DriveKind kind = DriveKind::kCia402;
  std::string can;  ///< interface
  canopen::DriveBaseSetup cia402;
  odrive::BaseSetup odrive;
  vesc::BaseSetup vesc;
};

/// Reads the table to its end; `period` is the loop's. Throws StartupError "FILE:LINE: cause; remedy" for anything
/// wrong or unknown.
[[nodiscard]] DriveWiring read_drive(TomlTable table, const RobotModel& model, Duration period);

}  // namespace jaywalk
