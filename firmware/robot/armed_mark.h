#pragma once
#include <filesystem>

namespace jaywalk {

/// A file that exists while the drives are armed. Where it is there at start, the last run ended without disarming
/// them: it was killed or it crashed. Start-up and end only, not for the loop.
class ArmedMark {
 public:
  /// The mark of the run with that control socket lies beside the socket.
  explicit ArmedMark(const std::filesystem::path& control_socket);
  /// An orderly end takes the file away.
  ~ArmedMark();
  ArmedMark(const ArmedMark&) = delete;
  ArmedMark& operator=(const ArmedMark&) = delete;

  /// Whether the run before this one left it.
  [[nodiscard]] bool was_left() const noexcept { return was_left_; }
  /// Throws StartupError where the file cannot be written.
  void set();

 private:
  std::filesystem::path file_;
  bool was_left_, set_ = false;
};

}  // namespace jaywalk
