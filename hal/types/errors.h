#pragma once
#include <algorithm>
#include <cstdint>
#include <stdexcept>
#include <string>

namespace jaywalk {

/// `text` with '?' for each control character; letters of other alphabets stay.
[[nodiscard]] inline std::string printable(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](char c) { return (c >= '\0' && c < ' ') || c == '\x7F'; }, '?');
  return text;
}

/// Why the program cannot start, and what to do about it: one line. Thrown only before the loop runs, caught once in
/// main: exit code 2. `cause` begins with the place ("office.toml:12: ...").
class StartupError : public std::runtime_error {
 public:
  StartupError(const std::string& cause, const std::string& remedy)
      : std::runtime_error(printable(cause + "; " + remedy)) {}  // names of files may hold line ends
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
