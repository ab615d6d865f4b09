#pragma once
// What a run on a robot leaves behind beside what every run leaves (docs/reference/outputs.md).
#include <filesystem>
#include <string>
#include <vector>

#include "firmware/robot/drive_wiring.h"
#include "firmware/robot/run_status.h"

namespace jaywalk {

/// arming.txt: what each drive said to each setting. Throws StartupError where the folder cannot be written to.
void write_arming(const std::filesystem::path& folder, const std::vector<std::string>& proof);

/// "66 settings proved", "64 settings proved, 2 NOT PROVED".
[[nodiscard]] std::string in_short(const std::vector<std::string>& proof);

/// devices.json: wheel radii as the drives' scales have them, frames, scans, ticks that were lost or bad, and what the
/// kernel did not permit. Throws likewise.
void write_devices(const std::filesystem::path& folder, const DriveWiring& drive, const RunStatus& last,
                   const std::vector<std::string>& not_permitted);

}  // namespace jaywalk
