#pragma once
#include <chrono>
#include <cstdint>
#include <filesystem>

namespace jaywalk {

/// How much of past runs is kept.
struct RunsKept {
  int runs = 20;
  std::uintmax_t bytes = 8'000'000'000;
};

/// The folder of a run below a folder for all of them, named after its start: "2026-11-24T20-15-00Z", with "-2" and so
/// on where that is there. A start that fails leaves no folder, so that a robot which is started again and again
/// without its scanner does not push the recordings of real runs out.
class RunFolder {
 public:
  /// Throws StartupError where it cannot be made.
  RunFolder(const std::filesystem::path& all, std::chrono::system_clock::time_point now);
  /// Removes it, unless it is kept.
  ~RunFolder();
  RunFolder(const RunFolder&) = delete;
  RunFolder& operator=(const RunFolder&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const noexcept { return path_; }
  /// The run has begun: its folder stays. Removes the oldest runs, so that with this one at most `kept.runs` remain and
  /// the others take at most `kept.bytes`; anything that is not named as runs are stays.
  void keep(const RunsKept& kept) noexcept;

 private:
  std::filesystem::path path_;
  bool kept_ = false;
};

}  // namespace jaywalk
