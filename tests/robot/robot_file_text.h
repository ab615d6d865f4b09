#pragma once
// A robot file as text, changed and loaded.
#include <string>

#include "firmware/robot/robot_file.h"
#include "tests/recording/scratch.h"
#include "tests/support/catch.h"
#include "tests/support/text.h"

namespace jaywalk::tests {

inline const std::string kGood = R"(model = "p3dx"
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

inline RobotFile load(const std::string& text) { return load_robot_file(Scratch().write("robot.toml", text)); }

/// kGood with the first `from` replaced.
inline std::string with(const std::string& from, const std::string& to) {
  std::string text = kGood;
  return text.replace(text.find(from), from.size(), to);
}

/// What is said about the file, from its line on.
inline std::string refusal(const std::string& text) {
  const std::string said = refusal_of([&] { return load(text); });
  return said.empty() ? "loaded" : said.substr(said.find(".toml:") + 6);  // the stop zone's refusal has no line
}

}  // namespace jaywalk::tests
