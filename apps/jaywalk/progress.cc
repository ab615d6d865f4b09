#include "apps/jaywalk/progress.h"

#include <unistd.h>

#include <algorithm>

namespace jaywalk {
namespace {

constexpr int kBarCells = 30;
/// With "[", "] " and the bar 76 cells: narrower than any terminal, whose line would break otherwise.
constexpr int kWordCells = 43, kLineCells = kBarCells + 3 + kWordCells;

}  // namespace

Progress::Progress(std::FILE* to, std::chrono::milliseconds between)
    : to_(to), between_(between), seen_(isatty(fileno(to)) == 1) {}

bool Progress::is_due() const { return seen_ && std::chrono::steady_clock::now() >= due_; }

void Progress::show(double share, const std::string& what) {
  if (!is_due()) return;
  const double held = share > 0.0 ? std::min(share, 1.0) : 0.0;
  const std::string full(static_cast<std::size_t>(held * kBarCells), '#');
  const std::string line = what.substr(0, kWordCells);
  std::fprintf(to_, "\r[%-*s] %-*s", kBarCells, full.c_str(), kWordCells, line.c_str());
  std::fflush(to_);
  standing_ = true;
  due_ = std::chrono::steady_clock::now() + between_;
}

void Progress::make_way() {
  if (!standing_) return;
  std::fprintf(to_, "\r%*s\r", kLineCells, "");
  std::fflush(to_);
  standing_ = false;
}

}  // namespace jaywalk
