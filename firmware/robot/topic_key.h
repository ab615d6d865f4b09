#pragma once
#include <algorithm>
#include <cctype>
#include <string>

#include "hal/toml_file.h"

namespace jaywalk {

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
