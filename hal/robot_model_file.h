#pragma once
// Robot model files, and the comfort that a ride has.
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "hal/toml_file.h"
#include "hal/types/robot_model.h"

namespace jaywalk {

/// One word in place of several limits: how a ride is to feel.
enum class Comfort { kGentle, kNormal, kBrisk };

/// In the order of the enumeration: "gentle", "normal", "brisk".
[[nodiscard]] const std::vector<std::string>& comfort_names();

/// What a profile makes of a robot's own limits, which are those of `normal`.
struct ComfortProfile {
  double speed = 1.0, accel = 1.0, jerk = 1.0;  ///< shares; turning alike, but no quicker. None is faster.
  double comfort_distance_m = 1.0;              ///< m; a pedestrian nearer than this to the robot costs
};
[[nodiscard]] ComfortProfile profile_of(Comfort comfort) noexcept;

/// SAFETY 10: no profile plans more, whatever the model has, unless the model itself has more.
inline constexpr double kMostComfortAccel_mps2 = 1.0, kMostComfortJerk_mps3 = 2.0;

/// The limits of a ride that feels so. Braking stays: it is what the drives were proved to do.
[[nodiscard]] MotionLimits limits_for(Comfort comfort, const RobotModel& model) noexcept;

[[nodiscard]] const FileKeys& robot_model_keys();
/// Those of a table `section` that lies over a model's laser: none is needed, each is the model's without it. A model's
/// own file has other defaults, `of_noise` of the simulated noise.
[[nodiscard]] std::vector<SettingKey> laser_keys(const std::string& section, const Otherwise& otherwise = "the model's",
                                                 const Otherwise& of_noise = "the model's");

/// A robot's model from a TOML file with the tables footprint, drive, limits and laser; every key is documented in
/// docs/reference/configuration.md. Throws StartupError "FILE:LINE: cause; remedy".
[[nodiscard]] RobotModel load_robot_model(const std::filesystem::path& file);

/// "p3dx", "wheelchair", or the file of that path.
[[nodiscard]] inline RobotModel robot_model(const std::string& choice) {
  if (choice == "p3dx") return p3dx();
  if (choice == "wheelchair") return wheelchair();
  return load_robot_model(choice);
}

/// The model that `key` of `table` names: "p3dx", "wheelchair", or a file's path relative to the table's own file.
[[nodiscard]] RobotModel read_model_choice(TomlTable& table, const std::string& key);

/// The row of the key `comfort`, and its value: normal where it is absent.
[[nodiscard]] inline SettingKey comfort_key() {
  return choice_row("comfort", "\"normal\"",
                    "speed, acceleration, jerk and distance from people, from the model's limits (scenarios.md)",
                    comfort_names());
}
[[nodiscard]] inline Comfort read_comfort(TomlTable& table) {
  return table.has("comfort") ? static_cast<Comfort>(table.choice("comfort")) : Comfort::kNormal;
}

/// A sector of the laser's frame: from_deg, and counter-clockwise from there to_deg. Both are needed.
[[nodiscard]] BlankedSector read_sector(TomlTable& table);

/// Reads `tables`, written as [laser] or [[laser]], each over the model's scanner in its place; one that the model
/// lacks is like its first and says its mount itself. Throws where there are more than kMostScanners, or fewer than the
/// model's. `read_more` reads the other keys of a table that belong to the scanner.
void read_lasers(std::vector<TomlTable> tables, RobotModel& model,
                 const std::function<void(TomlTable&, LaserModel&)>& read_more);

/// Lays a laser table's keys over `laser`; keys that are absent leave it as it is.
void read_laser(TomlTable& table, LaserModel& laser);

}  // namespace jaywalk
