#pragma once
#include <algorithm>
#include <cctype>
#include <cstdint>
#include <initializer_list>
#include <string>
#include <vector>

#include "firmware/robot/robot_file.h"
#include "hal/toml_file.h"

namespace jaywalk {

/// The keys of ROBOT.toml.
[[nodiscard]] const FileKeys& robot_file_keys();

// Those of its keys that are a struct's members.

[[nodiscard]] const BoundKeys<LaserWiring>& dds_laser_keys();
[[nodiscard]] const BoundKeys<panel::JoystickSetup>& button_keys();
[[nodiscard]] const BoundKeys<RealtimeWishes>& realtime_keys();
[[nodiscard]] const BoundKeys<canopen::DriveSettings>& canopen_keys();

// Numbers of ROBOT.toml that may not be one: nodes on a bus, buttons.

/// What a key of a table says.
struct Numbered {
  const char* key;
  std::uint16_t value;
};

/// Refuses the first that repeats one before it.
inline void require_distinct(const TomlTable& table, std::initializer_list<Numbered> all) {
  for (const Numbered& one : all) {
    for (const Numbered* other = all.begin(); other != &one; ++other)
      if (one.value == other->value)
        table.refuse(one.key, std::string("is ") + other->key + " too", "give each its own");
  }
}

/// A topic's whole name as ROS 2 has it, "/robot/scan"; `otherwise` where `key` is absent. Throws StartupError where it
/// holds none.
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
