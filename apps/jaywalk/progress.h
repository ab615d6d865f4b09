#pragma once
// How far a long command is, for a person at a terminal.
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <string>

namespace jaywalk {

/// A bar on a line of its own, drawn over at most once in `between` and gone at the end. Where `to` is no terminal
/// nothing is written.
class Progress {
 public:
  explicit Progress(std::FILE* to = stderr, std::chrono::milliseconds between = std::chrono::milliseconds(100))
      : to_(to), between_(between), seen_(isatty(fileno(to)) == 1) {}
  ~Progress() { make_way(); }
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// Whether there is a terminal: elsewhere lines may be printed in place of the bar.
  [[nodiscard]] bool is_seen() const { return seen_; }
  /// Whether anybody sees it: what show() is to say need not be made otherwise.
  [[nodiscard]] bool is_due() const { return seen_ && std::chrono::steady_clock::now() >= due_; }
  /// `share`: of the whole, held to 0 to 1 (NaN: 0); `what`: a few words beside the bar.
  void show(double share, const std::string& what) {
    if (!is_due()) return;
    const double held = share > 0.0 ? std::min(share, 1.0) : 0.0;
    const std::string full(static_cast<std::size_t>(held * kBarCells), '#');
    const std::string line = what.substr(0, kWordCells);
    std::fprintf(to_, "\r[%-*s] %-*s", kBarCells, full.c_str(), kWordCells, line.c_str());
    std::fflush(to_);
    standing_ = true;
    due_ = std::chrono::steady_clock::now() + between_;
  }
  /// Takes the bar off the terminal, so that something else can be printed.
  void make_way() {
    if (!standing_) return;
    std::fprintf(to_, "\r%*s\r", kLineCells, "");
    std::fflush(to_);
    standing_ = false;
  }

 private:
  static constexpr int kBarCells = 30;
  /// Width in characters. The whole line has 76, so that it fits a terminal of 80 without a break.
  static constexpr int kWordCells = 43, kLineCells = kBarCells + 3 + kWordCells;

  std::FILE* to_;
  std::chrono::milliseconds between_;
  bool seen_;              ///< `to` is a terminal
  bool standing_ = false;  ///< a bar is on it
  std::chrono::steady_clock::time_point due_{};
};

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
