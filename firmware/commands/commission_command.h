#pragma once
#include <filesystem>

namespace jaywalk {

struct CommissionOptions {
  std::filesystem::path robot;  ///< ROBOT.toml
  std::filesystem::path control_socket;
  bool yes = false;                ///< consent that the wheels may turn: the program does not ask for it
  bool allow_no_realtime = false;  ///< goes on where the kernel refuses what the file asks for
};

/// Turns each wheel a little and checks motors, encoders, sides, counts and the scanner against what the scans show;
/// prints a line a check and leaves ROBOT.commissioned.json. Returns 0 where all is well, else 1. Throws StartupError
/// where it may not begin: nothing is written then; or had to be broken off: then what was found before is withdrawn.
[[nodiscard]] int commission_robot(const CommissionOptions& options);

}  // namespace jaywalk
