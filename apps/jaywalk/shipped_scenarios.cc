#include "apps/jaywalk/shipped_scenarios.h"

#include <algorithm>
#include <vector>

#include "hal/shown_text.h"
#include "hal/types/errors.h"

namespace jaywalk {
namespace {

/// PREFIX/bin/jaywalk has PREFIX/share/jaywalk/scenarios; a build lies in its sources, or a folder or two below.
std::filesystem::path shipped_folder() {
  std::error_code failed;
  std::filesystem::path above = std::filesystem::read_symlink("/proc/self/exe", failed).parent_path();
  for (int depth = 0; depth < 4 && above.has_relative_path(); ++depth, above = above.parent_path()) {
    for (const char* const place : {"share/jaywalk/scenarios", "hal/sim/scenarios"})
      if (std::filesystem::is_directory(above / place, failed)) return above / place;
  }
  return {};
}

std::vector<std::string> names_in(const std::filesystem::path& folder) {
  std::vector<std::string> names;
  std::error_code failed;
  for (const auto& entry : std::filesystem::directory_iterator(folder, failed))
    if (entry.path().extension() == ".toml") names.push_back(entry.path().stem().string());
  std::sort(names.begin(), names.end());
  return names;
}

}  // namespace

std::filesystem::path scenario_named(const std::filesystem::path& given) {
  if (std::filesystem::exists(given) || given.has_parent_path()) return given;
  const std::filesystem::path folder = shipped_folder();
  const std::string name = given.extension() == ".toml" ? given.stem().string() : given.string();
  if (std::filesystem::exists(folder / (name + ".toml"))) return folder / (name + ".toml");
  const std::vector<std::string> names = names_in(folder);
  if (given.extension() == ".toml" || names.empty()) return given;
  std::string all;
  for (const std::string& one : names) all += (all.empty() ? "" : ", ") + one;
  throw StartupError(name + ": no such file, and no scenario of that name",
                     did_you_mean(name, names, "give a file, or one of " + all));
}

}  // namespace jaywalk
