#pragma once
// A run's recording and tables in parts of bounded size, each in a folder that is laid out as a run's own:
// "part-000001" and so on below it. The oldest go.
#include <cstdint>
#include <filesystem>
#include <vector>

namespace jaywalk {

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
  /// this one has parts. With parts, makes the first. Throws StartupError, for a folder too that is called like a part
  /// and is none.
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

/// The parts that are left of a run, oldest first and none missing between: what lies before a gap does not count.
/// Empty for a run without parts.
[[nodiscard]] std::vector<std::filesystem::path> parts_of(const std::filesystem::path& run);
/// Not there, or without a byte: so a file of the last part may be where the run was killed as it began.
[[nodiscard]] bool has_nothing(const std::filesystem::path& file);
/// Which part of a run a folder is, from 1 on; 0: none.
[[nodiscard]] int part_number(const std::filesystem::path& folder);

}  // namespace jaywalk
