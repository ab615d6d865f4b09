#include "firmware/recording/run_folders.h"

#include <sys/file.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <ctime>
#include <regex>
#include <string_view>
#include <utility>

#include "hal/shown_text.h"
#include "hal/text_file.h"
#include "hal/types/errors.h"

namespace jaywalk {
namespace {

std::uintmax_t bytes_in(const std::filesystem::path& folder) {
  std::uintmax_t bytes = 0;
  std::error_code ignored;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder, ignored)) {
    const std::uintmax_t size = entry.is_regular_file(ignored) ? entry.file_size(ignored) : 0;
    if (!ignored) bytes += size;
  }
  return bytes;
}

/// Folders right below `all` for which `counts` is true.
template <class Counts>
std::vector<std::filesystem::path> folders_in(const std::filesystem::path& all, const Counts& counts) {
  std::vector<std::filesystem::path> found;
  std::error_code ignored;
  for (const auto& entry : std::filesystem::directory_iterator(all, ignored))
    if (entry.is_directory(ignored) && counts(entry.path())) found.push_back(entry.path());
  return found;
}

/// Oldest first: their names are their times.
std::vector<std::filesystem::path> past_runs(const std::filesystem::path& all) {
  static const std::regex kName(R"(\d{4}-\d\d-\d\dT\d\d-\d\d-\d\dZ(-\d+)?)");
  auto runs = folders_in(all, [](const auto& path) { return std::regex_match(path.filename().string(), kName); });
  std::sort(runs.begin(), runs.end());
  return runs;
}

void make_folder(const std::filesystem::path& folder, const std::string& remedy) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw StartupError(folder.string() + ": " + error.message(), remedy);
}

/// Of `runs`, oldest first, how many of the newest may stay beside a new one.
std::size_t number_kept(const std::vector<std::filesystem::path>& runs, const RunsKept& kept) {
  std::uintmax_t bytes = 0;
  std::size_t newest = 0;
  for (auto run = runs.rbegin(); run != runs.rend(); ++run, ++newest) {
    bytes += bytes_in(*run);
    if (bytes > kept.bytes || static_cast<int>(newest) + 1 >= kept.runs) break;
  }
  return newest;
}

constexpr std::array kLeft{"recording.jwr", "robot.csv", "movers.csv", "tracks.csv",    "summary.json",
                           "run.png",       "run.svg",   "run.mcap",   "metadata.yaml", "arming.txt",
                           "devices.json",  "map.yaml",  "map.pgm"};  // docs/reference/outputs.md

constexpr std::string_view kPrefix = "part-";
/// What comes between two looks at a part's size, with room to spare: a tick has 10 kB at most but for the first.
constexpr std::uintmax_t kRoomBytes = 50'000;

std::filesystem::path part(const std::filesystem::path& run, int number) {
  return run / formatted("part-%06d", number);
}

/// Oldest first.
std::vector<std::filesystem::path> all_parts(const std::filesystem::path& run) {
  auto parts = folders_in(run, [](const auto& path) { return part_number(path) > 0; });
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

std::string utc_text(std::chrono::system_clock::time_point when, const char* format) {
  const std::time_t seconds = std::chrono::system_clock::to_time_t(when);
  std::tm utc{};
  ::gmtime_r(&seconds, &utc);
  char text[32];
  std::strftime(text, sizeof text, format, &utc);
  return text;
}

RunFolder::RunFolder(const std::filesystem::path& all, std::chrono::system_clock::time_point now) {
  const std::string name = utc_text(now, "%Y-%m-%dT%H-%M-%SZ");
  std::error_code error;
  for (int k = 1; path_.empty(); ++k) {
    const std::filesystem::path folder = all / (k == 1 ? name : name + "-" + std::to_string(k));
    if (std::filesystem::create_directories(folder, error)) path_ = folder;
    if (error) throw StartupError(folder.string() + ": " + error.message(), "give --runs a folder that can be written");
  }
}

RunFolder::~RunFolder() {
  std::error_code ignored;
  if (!kept_) std::filesystem::remove_all(path_, ignored);
}

void RunFolder::keep(const RunsKept& kept) noexcept {
  kept_ = true;
  std::vector<std::filesystem::path> others = past_runs(path_.parent_path());
  std::erase(others, path_);
  const std::size_t too_many = others.size() - number_kept(others, kept);
  std::error_code ignored;
  for (std::size_t k = 0; k < too_many; ++k) std::filesystem::remove_all(others[k], ignored);
}

OutFolder::OutFolder(const std::filesystem::path& path) : path_(path) {
  make_folder(path, "give --out a folder that can be written");
  held_ = wire::FileDescriptor(::open(path.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  const bool is_locked = held_.get() >= 0 && ::flock(held_.get(), LOCK_EX | LOCK_NB) != 0;
  if (is_locked && errno == EWOULDBLOCK)  // not every disk has locks
    throw StartupError(path.string() + ": another run writes there", "wait for its end, or choose another --out");
}

std::filesystem::path set_aside(const std::filesystem::path& out) {
  if (!std::filesystem::exists(out / "recording.jwr") && parts_of(out).empty()) return {};
  static_cast<void>(OutFolder(out));
  std::filesystem::path from = std::filesystem::absolute(out).lexically_normal(), to;
  if (!from.has_filename()) from = from.parent_path();  // "out/"
  for (int k = 1; to.empty() || std::filesystem::exists(to); ++k) to = from.string() + "." + std::to_string(k);
  std::error_code error;
  std::filesystem::rename(from, to, error);
  if (error) throw StartupError(out.string() + ": holds a run's recording: " + error.message(), "choose another --out");
  return to;
}

void print_summary(const std::filesystem::path& out) { std::fputs(text_in(out / "summary.json").c_str(), stdout); }

void refuse_to_overwrite(std::span<const std::filesystem::path> inputs, const std::filesystem::path& out) {
  for (const std::filesystem::path& input : inputs) {
    for (const char* name : kLeft) {
      std::error_code missing;
      if (!std::filesystem::equivalent(input, out / name, missing)) continue;
      throw StartupError(input.string() + ": would be overwritten by what the run leaves", "choose another --out");
    }
  }
}

int part_number(const std::filesystem::path& folder) {
  const std::string name = folder.filename().string();
  if (!name.starts_with(kPrefix)) return 0;
  return std::max(number_in<int>(std::string_view(name).substr(kPrefix.size())).value_or(0), 0);
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
  make_folder(made, "give a folder that can be written");
  place_ = made;
  ++number_;
}

}  // namespace jaywalk
