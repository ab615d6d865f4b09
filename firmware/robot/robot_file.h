#pragma once
// ROBOT.toml: which robot this is and how its devices are wired. docs/tutorial/first-real-robot.md has every key.
#include <algorithm>
#include <cctype>
#include <filesystem>
#include <initializer_list>
#include <optional>
#include <string>
#include <vector>

#include "drivers/laser/scanner_connection.h"
#include "drivers/panel/joystick.h"
#include "firmware/control_setup.h"
#include "firmware/robot/drive_wiring.h"
#include "firmware/robot/goal_order.h"
#include "firmware/robot/realtime.h"
#include "hal/toml_file.h"
#include "hal/types/operator_input.h"

namespace jaywalk {

struct LaserWiring : ByteWiring {
  ScannerKind kind = ScannerKind::kSickColaB;
  std::string topic;                                     ///< ROS 2 only
  bool reliable = false;                                 ///< ROS 2 only: lost scans are sent again
  bool infinity_is_free = false;                         ///< of a ROS 2 one
  Duration first_scan_limit = std::chrono::seconds(10);  ///< at start; a scanner may still be waking up
};

struct RobotFile {
  ControlSetup setup;        ///< start pose: where the robot stands when the program starts
  bool knows_start = false;  ///< the file says where; with a map and without it the first scan is looked for on the map
  double goal_heading_tolerance_rad = OperatorInput{}.goal_heading_tolerance_rad;
  LaserWiring laser;
  std::vector<LaserWiring> other_lasers;  ///< as many as the model has beside the first
  DriveWiring drive;
  RealtimeWishes realtime;
  std::optional<panel::JoystickSetup> panel;
  std::vector<NamedPlace> places;        ///< where `goto NAME` leads
  std::filesystem::path control_socket;  ///< empty: the default

  [[nodiscard]] OfEach<LaserWiring> lasers() const noexcept { return {laser, other_lasers}; }
};

/// Throws StartupError "FILE:LINE: cause; remedy" for anything wrong or unknown.
[[nodiscard]] RobotFile load_robot_file(const std::filesystem::path& file);

/// Refuses what no robot is, and what would blind it (SAFETY 28): each number is in its range, but they do not go
/// together. `nominal`: the drive as the model has it. Throws StartupError "PLACE: key: cause; remedy".
/// A wheel's radius, a gear or a mount that another robot of the kind might have passes: commissioning measures those.
void require_plausible(const RobotFile& robot, const DriveModel& nominal, const std::string& place);

/// The keys of ROBOT.toml.
[[nodiscard]] const FileKeys& robot_file_keys();

/// Those of CiA 402 drives that are members of their settings.
[[nodiscard]] const BoundKeys<canopen::DriveSettings>& canopen_keys();

/// Refuses the first key whose number (a node on a bus, a button) is that of a key before it.
inline void require_distinct(TomlTable& table, std::initializer_list<const char*> keys) {
  for (const char* const& key : keys) {
    for (const char* const* other = keys.begin(); other != &key; ++other)
      if (table.integer(key) == table.integer(*other))
        table.refuse(key, std::string("is ") + *other + " too", "give each its own");
  }
}

/// A topic's whole name as ROS 2 has it, "/robot/scan"; `otherwise` where `key` is absent. Throws StartupError.
[[nodiscard]] inline std::string read_topic(TomlTable& table, const std::string& key, const std::string& otherwise) {
  constexpr std::size_t kMostLetters = 64;  // some would do; a file is named after it
  std::string topic = table.text(key, otherwise);
  const bool has_letters = std::all_of(topic.begin(), topic.end(),
                                       [](unsigned char c) { return std::isalnum(c) != 0 || c == '_' || c == '/'; });
  if (topic.size() < 2 || topic.size() > kMostLetters || topic.front() != '/' || topic.back() == '/' || !has_letters ||
      topic.find("//") != std::string::npos)
    table.refuse(key, "is no topic's whole name", "write it as ros2 topic list shows it, /scan say");
  return topic;
}

}  // namespace jaywalk
