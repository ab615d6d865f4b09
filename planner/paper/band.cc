#include "planner/paper/band.h"

#include <algorithm>
#include <cmath>

namespace jaywalk::paper {
namespace {

/// Rounds of the band: enough for a corner to spread over its dozen neighbours.
constexpr std::int32_t kBandRounds = 60;
/// Rounds of tension alone between two looks at the band's length.
constexpr std::int32_t kTautRounds = 4;
/// Clearance (cells beyond inflation) below which things push the band: 0.5 m.
constexpr float kBandReach = 5.0F;
constexpr float kGive = 0.8F;

std::int32_t cell_of(float x) { return static_cast<std::int32_t>(x); }

/// Turns at a point's neighbours reach two points to either side: every third point may move in any order.
class Band {
 public:
  Band(Grid grid, const float* clearance, std::span<Point> points, std::int32_t first)
      : grid_(grid),
        clearance_(clearance),
        p_(points),
        first_(first),
        count_(static_cast<std::int32_t>(points.size())) {}

  void drag(float reach, std::int32_t rounds) noexcept {
    for (std::int32_t step = 0; step < 3 * rounds; ++step) {
      for (std::int32_t k = first_ + step % 3; k < count_ - 1; k += 3) move(k, reach);
    }
  }
  [[nodiscard]] double length() const noexcept {
    double sum = 0.0;
    for (std::int32_t k = 0; k + 1 < count_; ++k) {
      const double x = static_cast<double>(at(k + 1).x) - static_cast<double>(at(k).x);
      const double y = static_cast<double>(at(k + 1).y) - static_cast<double>(at(k).y);
      sum += std::sqrt(x * x + y * y);
    }
    return sum;
  }

 private:
  [[nodiscard]] Point& at(std::int32_t k) const noexcept { return p_[static_cast<std::size_t>(k)]; }

  /// Moves by its neighbours' tension and the clearance force: the whole way, half, a quarter of it, or not at all.
  void move(std::int32_t k, float reach) noexcept {
    const Point here = at(k);
    const Point force = clearance_force(clearance(cell_of(here.x), cell_of(here.y)), slope(here), reach);
    const Point pull = tension(at(k - 1), here, at(k + 1));
    for (float give = kGive; give > 0.15F * kGive; give *= 0.5F) {
      const Point there = dragged(here, pull, force, give);
      if (stays_free(k, there) && stays_gentle(k, there)) return void(at(k) = there);
    }
  }
  [[nodiscard]] float clearance(std::int32_t i, std::int32_t j) const noexcept {
    return grid_.holds(i, j) ? clearance_[grid_.at(i, j)] : 0.0F;
  }
  [[nodiscard]] Point slope(Point p) const noexcept {
    const std::int32_t i = cell_of(p.x), j = cell_of(p.y);
    return {0.5F * (clearance(i + 1, j) - clearance(i - 1, j)), 0.5F * (clearance(i, j + 1) - clearance(i, j - 1))};
  }
  [[nodiscard]] bool stays_free(std::int32_t k, Point there) const noexcept {
    return there.x >= 0.0F && there.y >= 0.0F && is_box_free(at(k - 1), there) && is_box_free(there, at(k + 1));
  }
  [[nodiscard]] bool is_box_free(Point a, Point b) const noexcept {
    const auto [i0, i1] = std::minmax({cell_of(a.x), cell_of(b.x)});
    const auto [j0, j1] = std::minmax({cell_of(a.y), cell_of(b.y)});
    for (std::int32_t j = j0; j <= j1; ++j)
      for (std::int32_t i = i0; i <= i1; ++i)
        if (!(clearance(i, j) > 0.0F)) return false;
    return true;
  }
  /// The sharpest turn's cosine at point k and beside it, were k `there`.
  [[nodiscard]] float sharpest_with(std::int32_t k, Point there) const noexcept {
    // NaN, where points coincide, comes first and stays: such a move is refused.
    const auto sharper = [](float a, float b) { return b < a ? b : a; };
    float cosine = turn_cosine(at(k - 1), there, at(k + 1));
    if (k >= 2) cosine = sharper(cosine, turn_cosine(at(k - 2), at(k - 1), there));
    if (k + 2 < count_) cosine = sharper(cosine, turn_cosine(there, at(k + 1), at(k + 2)));
    return cosine;
  }
  [[nodiscard]] bool stays_gentle(std::int32_t k, Point there) const noexcept {
    const float cosine = sharpest_with(k, there);
    return cosine >= kSharpest || cosine >= sharpest_with(k, at(k));
  }

  Grid grid_;
  const float* clearance_;
  std::span<Point> p_;
  std::int32_t first_, count_;
};

}  // namespace

void pull(Grid grid, const float* clearance, std::span<Point> points, std::span<Point> raw,
          std::int32_t first) noexcept {
  std::copy(points.begin(), points.end(), raw.begin());
  Band band(grid, clearance, points, first);
  const double raw_length = band.length();
  band.drag(kBandReach, kBandRounds);
  for (std::int32_t r = 0; r < kBandRounds && band.length() > raw_length; r += kTautRounds)
    band.drag(0.0F, kTautRounds);
  if (band.length() <= raw_length) return;
  std::copy_n(raw.begin(), points.size(), points.begin());
  band.drag(0.0F, kBandRounds);
}

}  // namespace jaywalk::paper
