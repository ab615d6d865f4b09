#pragma once
// How far a long command is, for a person at a terminal.
#include <chrono>
#include <cstdio>
#include <string>

namespace jaywalk {

/// A bar on a line of its own, drawn over at most once in `between` and gone at the end. Where `to` is no terminal
/// nothing is written.
class Progress {
 public:
  explicit Progress(std::FILE* to = stderr, std::chrono::milliseconds between = std::chrono::milliseconds(100));
  ~Progress() { make_way(); }
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// Whether there is a terminal: elsewhere lines may be printed in place of the bar.
  [[nodiscard]] bool is_seen() const { return seen_; }
  /// Whether anybody sees it: what show() is to say need not be made otherwise.
  [[nodiscard]] bool is_due() const;
  /// `share`: of the whole, held to 0 to 1 (NaN: 0); `what`: a few words beside the bar.
  void show(double share, const std::string& what);
  /// Takes the bar off the terminal, so that something else can be printed.
  void make_way();

 private:
  std::FILE* to_;
  std::chrono::milliseconds between_;
  bool seen_;              ///< `to` is a terminal
  bool standing_ = false;  ///< a bar is on it
  std::chrono::steady_clock::time_point due_{};
};

}  // namespace jaywalk
