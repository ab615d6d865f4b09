#include "firmware/recording/run_parts.h"

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <string>
#include <string_view>
#include <utility>

#include "hal/types/errors.h"

namespace jaywalk {
namespace {

constexpr std::string_view kPrefix = "part-";
/// What comes between two looks at a part's size, with room to spare: a tick has 10 kB at most but for the first.
constexpr std::uintmax_t kRoomBytes = 50'000;

std::filesystem::path part(const std::filesystem::path& run, int number) {
  char name[32];
  std::snprintf(name, sizeof name, "part-%06d", number);
  return run / name;
}

/// Oldest first.
std::vector<std::filesystem::path> all_parts(const std::filesystem::path& run) {
  std::vector<std::filesystem::path> parts;
  std::error_code ignored;
  for (const auto& entry : std::filesystem::directory_iterator(run, ignored)) {
    if (entry.is_directory(ignored) && part_number(entry.path()) > 0) parts.push_back(entry.path());
  }
  std::sort(parts.begin(), parts.end(), [](const auto& a, const auto& b) { return part_number(a) < part_number(b); });
  return parts;
}

void remove_whole(const std::filesystem::path& what) {
  std::error_code error;
  std::filesystem::remove_all(what, error);
  if (error) throw StartupError(what.string() + ": " + error.message(), "choose another --out folder");
}

/// A part has its recording from the first byte on, or was made just before the program was killed.
void remove_part(const std::filesystem::path& folder) {
  std::error_code ignored;
  if (!std::filesystem::exists(folder / "recording.jwr") && !std::filesystem::is_empty(folder, ignored))
    throw StartupError(folder.string() + ": is called like a part of a run and holds no recording",
                       "choose another --out folder, or move it away");
  remove_whole(folder);
}

}  // namespace

int part_number(const std::filesystem::path& folder) {
  const std::string name = folder.filename().string();
  int number = 0;
  if (!name.starts_with(kPrefix)) return 0;
  const auto [end, error] = std::from_chars(name.data() + kPrefix.size(), name.data() + name.size(), number);
  return error == std::errc{} && end == name.data() + name.size() ? std::max(number, 0) : 0;
}

std::vector<std::filesystem::path> parts_of(const std::filesystem::path& run) {
  std::vector<std::filesystem::path> parts = all_parts(run);
  std::size_t first = parts.empty() ? 0 : parts.size() - 1;
  while (first > 0 && part_number(parts[first - 1]) + 1 == part_number(parts[first])) --first;
  parts.erase(parts.begin(), parts.begin() + static_cast<std::ptrdiff_t>(first));
  return parts;
}

bool has_nothing(const std::filesystem::path& file) {
  std::error_code missing;
  return std::filesystem::file_size(file, missing) == 0 || missing;
}

RunParts::RunParts(std::filesystem::path run, const PartsKept& kept)
    : run_(std::move(run)), place_(run_), kept_(kept), number_(any() ? 0 : 1) {
  for (const std::filesystem::path& old : all_parts(run_)) remove_part(old);
  if (!any()) return;
  for (const char* const old : {"recording.jwr", "robot.csv", "movers.csv", "tracks.csv"}) remove_whole(run_ / old);
  next();
}

bool RunParts::is_full(std::uintmax_t bytes) const noexcept { return any() && bytes + kRoomBytes >= kept_.bytes; }

void RunParts::next() {
  remove_whole(part(run_, number_ + 1 - kept_.parts));
  const std::filesystem::path made = part(run_, number_ + 1);
  std::error_code error;
  std::filesystem::create_directories(made, error);
  if (error) throw StartupError(made.string() + ": " + error.message(), "give a folder that can be written");
  place_ = made;
  ++number_;
}

}  // namespace jaywalk
