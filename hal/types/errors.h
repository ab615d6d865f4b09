#pragma once
#include <cstdint>
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
    for (char& c : text)
      if ((c >= 0 && c < ' ') || c == 127) c = '?';
    return text;
  }
};

/// Kind of number by which a drive says what is wrong with it, or that says what is wrong with it.
enum class DriveFaultKind : std::uint8_t {
  kNone,
  kEmergency,  ///< CANopen: error code of an emergency message
  kMode,       ///< CiA 402: mode shown (6061h) where it is not the one wanted
  kOdrive,     ///< active errors, a bit each
  kVesc,       ///< fault code
  kVescStill,  ///< electrical turns a minute that a VESC was told, and its motor did not turn
  kArcos       ///< stalls and flags of a Pioneer's board, a bit each
};
/// The last of them, for checks of what is read.
inline constexpr DriveFaultKind kLastDriveFaultKind = DriveFaultKind::kArcos;

/// First fault that a drive told since its drive base was proved.
struct DriveFault {
  DriveFaultKind kind = DriveFaultKind::kNone;
  std::uint8_t node = 0;   ///< its number on the bus
  std::uint32_t code = 0;  ///< as `kind` says

  [[nodiscard]] bool is_told() const noexcept { return kind != DriveFaultKind::kNone; }
  bool operator==(const DriveFault&) const = default;
};

}  // namespace jaywalk
