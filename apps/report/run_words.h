#pragma once
#include <filesystem>
#include <string>

namespace jaywalk {
/// What happened in the run whose tables lie in `folder`, in plain words: distance, how long it drove and stood and
/// why, faults. A run that was killed has no summary.json: its tables are told all the same. Throws StartupError where
/// there is no robot.csv, or a row of it is not one of ours.
[[nodiscard]] std::string run_words(const std::filesystem::path& folder);

}  // namespace jaywalk
