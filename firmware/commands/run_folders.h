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

/// The folder of a run that starts at `now`, below `all`: "2026-11-24T20-15-00Z", with "-2" and so on where that is
/// there. Removes the oldest runs before, so that with this one at most `kept.runs` remain, and the others take at most
/// `kept.bytes`; anything below `all` that is not named so stays. Throws StartupError where it cannot be made.
[[nodiscard]] std::filesystem::path new_run_folder(const std::filesystem::path& all, const RunsKept& kept,
                                                   std::chrono::system_clock::time_point now);

}  // namespace jaywalk
