#include "apps/formats/logs/log_times.h"

#include <algorithm>
#include <cmath>

namespace jaywalk::sim {
namespace {

constexpr Duration kLeap = std::chrono::seconds(1);  // a stamp so far ahead of a later one is the wrong one of the two

struct Span {
  Time first, last;
};

/// Of the largest group of stamps without such a gap; of equal ones the earliest.
Span largest_group(std::span<const Time> stamps) {
  std::vector<Time> sorted(stamps.begin(), stamps.end());
  std::sort(sorted.begin(), sorted.end());
  std::size_t begin = 0, best = 0, most = 0;
  for (std::size_t k = 1; k <= sorted.size(); ++k) {
    if (k < sorted.size() && sorted[k] - sorted[k - 1] <= kOtherClockFrom) continue;
    if (k - begin > most) most = k - begin, best = begin;
    begin = k;
  }
  return {sorted[best], sorted[best + most - 1]};
}

/// The longest sequence of `stamps[of[...]]` that rises strictly, by patience sorting: places in `stamps`. Of several
/// one that ends within a second of the earliest end, recorded first, and spans the least.
std::vector<std::size_t> longest_rising(std::span<const Time> stamps, const std::vector<std::size_t>& of) {
  std::vector<std::vector<std::size_t>> ends;  // what a longest sequence of each length ends with; stamps fall
  for (const std::size_t k : of) {
    const auto place = std::lower_bound(ends.begin(), ends.end(), stamps[k],
                                        [&](const auto& end, Time stamp) { return stamps[end.back()] < stamp; });
    if (place == ends.end())
      ends.push_back({k});
    else
      place->push_back(k);
  }
  std::vector<std::size_t> rising;
  for (auto end = ends.rbegin(); end != ends.rend(); ++end) {
    const Time before = rising.empty() ? stamps[end->back()] + kLeap + Duration{1} : stamps[rising.back()];
    rising.push_back(*std::find_if(end->begin(), end->end(), [&](std::size_t k) { return stamps[k] < before; }));
  }
  std::reverse(rising.begin(), rising.end());
  return rising;
}

constexpr double kDrivesM = 0.02, kDrivesRad = 0.02;  // more than a standing robot's wheels make up
// No laser turns faster than the one; recorded ones turn ten times a second more often than not.
constexpr Duration kShortestStep = std::chrono::milliseconds(1), kOtherwise = std::chrono::milliseconds(100);

bool drives(const Pose2& moved) { return norm(moved.position()) > kDrivesM || std::fabs(moved.heading) > kDrivesRad; }

}  // namespace

std::vector<const char*> judge_times(std::span<const Time> stamps) {
  std::vector<const char*> causes(stamps.size(), kOtherClock);
  if (stamps.empty()) return causes;
  const Span group = largest_group(stamps);
  std::vector<std::size_t> inside;
  for (std::size_t k = 0; k < stamps.size(); ++k) {
    if (stamps[k] < group.first || stamps[k] > group.last) continue;
    inside.push_back(k);
    causes[k] = kTimeStands;
  }
  const std::vector<std::size_t> rising = longest_rising(stamps, inside);
  std::size_t next = 0;  // the first kept one that is not before k
  for (const std::size_t k : inside) {
    while (next < rising.size() && rising[next] < k) ++next;
    if (next == rising.size()) continue;
    if (rising[next] == k)
      causes[k] = nullptr;
    else if (stamps[k] > stamps[rising[next]])
      causes[k] = kTimeLeapt;
  }
  return causes;
}

void LineClock::see(Time said, const Pose2& moved) noexcept {
  if (lines_++ == 0)
    first_ = last_ = said;
  else if (said <= last_ && drives(moved))
    ++stood_;
  last_ = std::max(last_, said);
}

Time LineClock::even(std::size_t k) const {
  const auto steps = static_cast<Duration::rep>(std::max<std::size_t>(lines_, 2) - 1);
  const auto at = static_cast<Duration::rep>(k);
  const Duration span = last_ - first_;
  return span / steps >= kShortestStep ? first_ + Duration{span.count() / steps * at} : first_ + kOtherwise * at;
}

}  // namespace jaywalk::sim
