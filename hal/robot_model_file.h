#pragma once
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "hal/comfort.h"
#include "hal/toml_file.h"
#include "hal/types/robot_model.h"

namespace jaywalk {

/// Its keys.
[[nodiscard]] const FileKeys& robot_model_keys();
/// Those of a table `section` that lies over a model's laser: none is needed, each is the model's without it.
[[nodiscard]] std::vector<SettingKey> laser_keys(const std::string& section);

/// A robot's model from a TOML file with the tables footprint, drive, limits and laser; every key is documented in
/// docs/reference/configuration.md. Throws StartupError "FILE:LINE: cause; remedy".
[[nodiscard]] RobotModel load_robot_model(const std::filesystem::path& file);

/// "p3dx", "wheelchair", or the file of that path.
[[nodiscard]] RobotModel robot_model(const std::string& choice);

/// The model that `key` of `table` names: "p3dx", "wheelchair", or a file's path relative to the table's own file.
[[nodiscard]] RobotModel read_model_choice(TomlTable& table, const std::string& key);

/// The row of the key `comfort`, and its value: normal where it is absent.
[[nodiscard]] SettingKey comfort_key();
[[nodiscard]] Comfort read_comfort(TomlTable& table);

/// A sector of the laser's frame: from_deg, and counter-clockwise from there to_deg. Both are needed.
[[nodiscard]] BlankedSector read_sector(TomlTable& table);

/// Reads `tables`, written as [laser] or [[laser]], each over the model's scanner in its place; one that the model
/// lacks is like its first and says its mount itself. Throws where there are more than kMostScanners, or fewer than the
/// model's. `read_more` reads the other keys of a table that belong to the scanner.
void read_lasers(std::vector<TomlTable> tables, RobotModel& model,
                 const std::function<void(TomlTable&, LaserModel&)>& read_more);

/// Lays the laser table's keys (fov_deg, beams, rate_hz, range_min_m, range_m, noise_m, drop_out, mount, blanked) over
/// `laser`; keys that are absent leave it as it is.
void read_laser(TomlTable& table, LaserModel& laser);

}  // namespace jaywalk
