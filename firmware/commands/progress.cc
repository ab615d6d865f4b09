#include "firmware/commands/progress.h"

#include <unistd.h>

#include <algorithm>

namespace jaywalk {
namespace {

constexpr std::chrono::milliseconds kBetween{100};
constexpr int kBarCells = 30;
/// Bar and words: narrower than any terminal, whose line would break otherwise.
constexpr int kLineCells = 76;

}  // namespace

Progress::Progress(std::FILE* to) : to_(to), seen_(isatty(fileno(to)) == 1) {}

bool Progress::is_due() const { return seen_ && std::chrono::steady_clock::now() >= due_; }

void Progress::show(double share, const std::string& what) {
  if (!is_due()) return;
  const double held = share > 0.0 ? std::min(share, 1.0) : 0.0;
  const std::string full(static_cast<std::size_t>(held * kBarCells), '#');
  const std::string line = what.substr(0, kLineCells - kBarCells - 3);
  std::fprintf(to_, "\r[%-*s] %-*s", kBarCells, full.c_str(), kLineCells - kBarCells - 3, line.c_str());
  std::fflush(to_);
  standing_ = true;
  due_ = std::chrono::steady_clock::now() + kBetween;
}

void Progress::make_way() {
  if (!standing_) return;
  std::fprintf(to_, "\r%*s\r", kLineCells, "");
  std::fflush(to_);
  standing_ = false;
}

}  // namespace jaywalk
