#include "planner/field/path.h"

#include <algorithm>
#include <cmath>

namespace jaywalk::field {
namespace {

constexpr double kSpacing = 0.1;     // m, as wide as a cell
constexpr double kMaxSpacing = 0.2;  // m

Vec2 in_map(const Window& window, cell::Point p) {
  return window.in_map({static_cast<double>(p.x), static_cast<double>(p.y)});
}

/// A cell's successor; itself where the index leads nowhere.
std::int32_t next_of(Grid grid, const std::uint8_t* index, std::int32_t c) {
  const Step s = step_of(index[c]);
  return c + grid.at(s.di, s.dj);
}

}  // namespace

std::int32_t follow(Grid grid, const std::uint8_t* index, std::int32_t start, std::int32_t goal, cell::Point* points,
                    std::int32_t count, std::int32_t capacity) noexcept {
  std::int32_t c = start;
  for (std::int32_t steps = 0; steps <= grid.cells() && count < capacity; ++steps) {
    const std::int32_t i = c % grid.side, j = c / grid.side;
    points[count++] = {static_cast<float>(i) + 0.5F, static_cast<float>(j) + 0.5F};
    if (c == goal || count == capacity) return count;
    const std::int32_t next = next_of(grid, index, c);
    if (next == c) return 0;
    c = next;
  }
  return 0;
}

float share_arriving(Grid grid, const float* psi, const std::uint8_t* index, std::int32_t goal,
                     std::uint8_t* seen) noexcept {
  enum : std::uint8_t { kUnknown, kArrives, kStrays };
  std::fill_n(seen, grid.cells(), std::uint8_t{kUnknown});
  seen[goal] = kArrives;
  std::int64_t joined = 0, arriving = 0;
  for (std::int32_t first = 0; first < grid.cells(); ++first) {
    if (!cell::is_joined(psi[first])) continue;
    std::int32_t c = first;  // psi falls with every step, so there are no rings
    while (seen[c] == kUnknown && next_of(grid, index, c) != c) c = next_of(grid, index, c);
    const std::uint8_t fate = seen[c] == kUnknown ? std::uint8_t{kStrays} : seen[c];
    for (c = first; seen[c] == kUnknown; c = next_of(grid, index, c)) seen[c] = fate;
    ++joined;
    if (fate == kArrives) ++arriving;
  }
  return joined == 0 ? 0.0F : static_cast<float>(arriving) / static_cast<float>(joined);
}

void resample(const Window& window, const cell::Point* points, std::int32_t count, Vec2 from, Vec2 to,
              Path& path) noexcept {
  const auto point = [&](std::int32_t k) { return k == 0 ? from : (k == count - 1 ? to : in_map(window, points[k])); };
  double length = 0.0;
  for (std::int32_t k = 1; k < count; ++k) length += distance(point(k - 1), point(k));
  const double most = static_cast<double>(kMaxPathPoints - 1);
  const double pieces = std::clamp(std::ceil(length / kSpacing), 1.0, most);
  const double spacing = std::min(length / pieces, kMaxSpacing);
  path.clear();
  double walked = 0.0;  // along the band to its point k - 1
  for (std::int32_t k = 1; k < count && !path.full(); ++k) {
    const Vec2 a = point(k - 1), b = point(k);
    const double step = distance(a, b);
    for (double next = spacing * static_cast<double>(path.size()); next < walked + step && !path.full();
         next = spacing * static_cast<double>(path.size())) {
      (void)path.push_back(a + (b - a) * ((next - walked) / step));
    }
    walked += step;
  }
  const bool whole = length <= most * kMaxSpacing;
  if (!whole) return;
  // The last sample may have fallen just short of the end: it becomes the end.
  const bool is_close = path.size() > 1 && distance(path.back(), to) < 0.5 * spacing;
  if (is_close || !path.push_back(to)) path.back() = to;
}

}  // namespace jaywalk::field
