#pragma once
#include <filesystem>
#include <span>

namespace jaywalk {

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
