#pragma once
#include <stdexcept>
#include <string>

namespace jaywalk {

/// Why the program cannot start, and what to do about it. Thrown only before the loop runs, caught
/// once in main: one line and exit code 2. `cause` begins with the place ("office.toml:12: ...").
class StartupError : public std::runtime_error {
 public:
  StartupError(const std::string& cause, const std::string& remedy)
      : std::runtime_error(in_a_line(cause + "; " + remedy)) {}

 private:
  /// Names of files and words of strangers may hold line ends, and what a terminal obeys.
  static std::string in_a_line(std::string text) {
    for (char& c : text) {
      if ((c >= 0 && c < ' ') || c == 127) c = '?';
    }
    return text;
  }
};

}  // namespace jaywalk
