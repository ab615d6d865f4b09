#pragma once
#include <filesystem>
#include <string>

namespace jaywalk {

/// `given` itself where there is such a file, or it has a folder; else the scenario of that name that comes with the
/// program: installed beside it, or in the sources that it was built from. Throws StartupError for a name that is none
/// of theirs, with the nearest.
[[nodiscard]] std::filesystem::path scenario_named(const std::filesystem::path& given);

}  // namespace jaywalk
