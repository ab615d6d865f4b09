#pragma once
#include <csignal>

namespace jaywalk {

/// Ctrl-C or a termination asks a simulation or a replay to end with its tables whole; a second one ends it at once.
/// The exit code says by which, as a shell has it: 130 after Ctrl-C. One at a time. Thread: the main one.
class Interruption {
 public:
  Interruption() {
    std::signal(SIGINT, take);
    std::signal(SIGTERM, take);
  }
  ~Interruption() {
    std::signal(SIGINT, SIG_DFL);
    std::signal(SIGTERM, SIG_DFL);
    came_ = 0;
  }
  Interruption(const Interruption&) = delete;
  Interruption& operator=(const Interruption&) = delete;

  [[nodiscard]] bool came() const { return came_ != 0; }
  /// 128 and the signal's number.
  [[nodiscard]] int exit_code() const { return 128 + came_; }

 private:
  static void take(int signal) {
    came_ = signal;
    std::signal(signal, SIG_DFL);
  }
  static inline volatile std::sig_atomic_t came_ = 0;
};

}  // namespace jaywalk
