#pragma once
#include <stdexcept>
#include <string>

namespace jaywalk {

/// Why the program cannot start, and what to do about it. Thrown only before the loop runs, caught
/// once in main: one line and exit code 2. `cause` begins with the place ("office.toml:12: ...").
class StartupError : public std::runtime_error {
 public:
  StartupError(const std::string& cause, const std::string& remedy) : std::runtime_error(cause + "; " + remedy) {}
};

}  // namespace jaywalk
