#pragma once
// A run's folder, and the parts that it grows by.
#include <chrono>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "drivers/wire/file_descriptor.h"

namespace jaywalk {

/// Universal time, as strftime() formats it.
[[nodiscard]] std::string utc_text(std::chrono::system_clock::time_point when, const char* format);

/// How much of past runs is kept.
struct RunsKept {
  int runs = 20;
  std::uintmax_t bytes = 8'000'000'000;
};

/// The folder of a run below a folder for all of them, named after its start: "2026-11-24T20-15-00Z", with "-2" and so
/// on where that is there. A start that fails leaves none: it would push the recordings of real runs out.
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

/// The folder in which a run leaves its files, held against any other run for as long as this lives.
class OutFolder {
 public:
  /// Makes it where it is missing. Throws StartupError where it cannot be made, or another run writes there.
  explicit OutFolder(const std::filesystem::path& path);

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
  wire::FileDescriptor held_;
};

/// Where a run left its recording in `out` that folder is renamed, "out.1" for "out" and so on: no run writes over
/// another's, which may have crashed. Returns the new name; empty where there was nothing to keep. Throws StartupError
/// where another run writes there, or it cannot be renamed.
std::filesystem::path set_aside(const std::filesystem::path& out);

/// What summary.json in `out` says, on standard output.
void print_summary(const std::filesystem::path& out);

/// Throws StartupError where one of `inputs`, which may be missing, is a file that a run leaves in `out`.
void refuse_to_overwrite(std::span<const std::filesystem::path> inputs, const std::filesystem::path& out);

// A run's recording and tables in parts of bounded size, each in a folder that is laid out as a run's own:
// "part-000001" and so on below it. The oldest go.

/// How much of a run is kept. A part holds kLeastPartBytes at least.
struct PartsKept {
  std::uintmax_t bytes = 0;  ///< of a part's recording and tables; 0: all of the run, in its folder itself
  int parts = 8;             ///< that stay, the one that is written among them; 2 at least
};
inline constexpr std::uintmax_t kLeastPartBytes = 200'000;

/// Where a run under way leaves recording and tables.
class RunParts {
 public:
  /// Removes from `run` what another run left there and this one will not write over: its parts, or its files where
  /// this one has parts. Makes the first part. Throws StartupError, also for a folder called like a part that is none.
  RunParts(std::filesystem::path run, const PartsKept& kept);

  /// A folder: that of the part, or the run's own.
  [[nodiscard]] const std::filesystem::path& place() const noexcept { return place_; }
  [[nodiscard]] bool any() const noexcept { return kept_.bytes > 0; }
  /// From 1 on.
  [[nodiscard]] int number() const noexcept { return number_; }
  /// Whether a part of so many bytes ends: a tick more may not fit in.
  [[nodiscard]] bool is_full(std::uintmax_t bytes) const noexcept;
  /// Makes the folder of the next part, after the oldest have gone for it. Throws StartupError.
  void next();

 private:
  std::filesystem::path run_, place_;
  PartsKept kept_;
  int number_ = 1;
};

/// The parts that are left of a run after the last gap, oldest first. Empty for a run without parts.
[[nodiscard]] std::vector<std::filesystem::path> parts_of(const std::filesystem::path& run);
/// Not there, or without a byte: so a file of the last part may be where the run was killed as it began.
[[nodiscard]] bool has_nothing(const std::filesystem::path& file);
/// Which part of a run a folder is, from 1 on; 0: none.
[[nodiscard]] int part_number(const std::filesystem::path& folder);

}  // namespace jaywalk
