#pragma once
// A robot file as text, changed and loaded.
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "firmware/robot/robot_file.h"
#include "hal/types/errors.h"
#include "tests/support/catch.h"

namespace jaywalk::tests {

inline constexpr const char* kGood = R"(model = "p3dx"
start = [1.0, 2.0, 0.5]
max_speed_mps = 0.5

[laser]
kind = "sick-cola-b"
host = "10.0.0.2"
range_m = 10.0

[drive]
kind = "cia402"
can = "can0"
counts_per_wheel_turn = 76600
right_reversed = true
)";

class File {
 public:
  explicit File(const std::string& text, const std::string& name = "robot")
      : path_(std::filesystem::temp_directory_path() / (name + std::to_string(::getpid()) + ".toml")) {
    std::ofstream(path_) << text;
  }
  ~File() { std::filesystem::remove(path_); }
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

inline RobotFile load(const std::string& text) {
  const File file(text);
  return load_robot_file(file.path());
}

/// kGood with the first `from` replaced.
inline std::string with(const std::string& from, const std::string& to) {
  std::string text = kGood;
  return text.replace(text.find(from), from.size(), to);
}

/// What is said about the file, from its line on.
inline std::string refusal(const std::string& text) {
  try {
    static_cast<void>(load(text));
  } catch (const StartupError& error) {
    const std::string said = error.what();
    return said.substr(said.find(".toml:") + 6);  // the stop zone's refusal has no line
  }
  return "loaded";
}

}  // namespace jaywalk::tests
