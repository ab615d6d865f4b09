#pragma once
#include <vector>

#include "hal/setting_keys.h"

namespace jaywalk {

/// The keys of ROBOT.toml.
[[nodiscard]] const FileKeys& robot_file_keys();
/// Those of its table [drive].
[[nodiscard]] std::vector<SettingKey> drive_keys();

}  // namespace jaywalk
