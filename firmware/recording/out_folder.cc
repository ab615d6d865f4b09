#include "firmware/recording/out_folder.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <string>

#include "firmware/recording/run_parts.h"
#include "hal/types/errors.h"

namespace jaywalk {
namespace {

constexpr std::array kLeft{"recording.jwr", "robot.csv", "movers.csv", "tracks.csv",    "summary.json",
                           "run.png",       "run.svg",   "run.mcap",   "metadata.yaml", "arming.txt",
                           "devices.json",  "map.yaml",  "map.pgm"};  // docs/reference/outputs.md

}  // namespace

OutFolder::OutFolder(const std::filesystem::path& path) : path_(path) {
  std::error_code error;
  std::filesystem::create_directories(path, error);
  if (error) throw StartupError(path.string() + ": " + error.message(), "give --out a folder that can be written");
  held_ = ::open(path.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (held_ < 0 || ::flock(held_, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK) return;  // not every disk has locks
  ::close(held_);
  throw StartupError(path.string() + ": another run writes there", "wait for its end, or choose another --out");
}

OutFolder::~OutFolder() {
  if (held_ >= 0) ::close(held_);
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

void print_summary(const std::filesystem::path& out) {
  std::ifstream in(out / "summary.json");
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  std::fputs(text.c_str(), stdout);
}

void refuse_to_overwrite(std::span<const std::filesystem::path> inputs, const std::filesystem::path& out) {
  for (const std::filesystem::path& input : inputs) {
    for (const char* name : kLeft) {
      std::error_code missing;
      if (!std::filesystem::equivalent(input, out / name, missing)) continue;
      throw StartupError(input.string() + ": would be overwritten by what the run leaves", "choose another --out");
    }
  }
}

}  // namespace jaywalk
