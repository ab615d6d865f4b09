#pragma once
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <span>

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

/// The folder in which a run leaves its files, held against any other run for as long as this lives: their tables would
/// be one another's.
class OutFolder {
 public:
  /// Makes it where it is missing. Throws StartupError where it cannot be made, or another run writes there.
  explicit OutFolder(const std::filesystem::path& path);
  ~OutFolder();
  OutFolder(const OutFolder&) = delete;
  OutFolder& operator=(const OutFolder&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
  int held_;
};

/// Where a run left its recording in `out` that folder is renamed, "out.1" for "out" and so on: no run writes over
/// another's, which may have crashed. Returns the new name; empty where there was nothing to keep. Throws StartupError
/// where another run writes there, or it cannot be renamed.
std::filesystem::path set_aside(const std::filesystem::path& out);

/// What summary.json in `out` says, on standard output.
void print_summary(const std::filesystem::path& out);

/// Throws StartupError where one of `inputs`, which may be missing, is a file that a run leaves in `out`.
void refuse_to_overwrite(std::span<const std::filesystem::path> inputs, const std::filesystem::path& out);

}  // namespace jaywalk
