#include "planner/paper/path.h"

#include <algorithm>

#include "planner/paper/potential_stages.h"

namespace jaywalk::paper {
namespace {
/// Rounds of the band: enough for a corner to spread over its dozen neighbours.
constexpr std::int32_t kBandRounds = 60;
/// Rounds of tension alone between two looks at the band's length.
constexpr std::int32_t kTautRounds = 4;
/// Clearance (cells beyond inflation) below which things push the band: 0.5 m.
constexpr float kBandReach = 5.0F;
constexpr float kGive = 0.8F;

/// Rounded down without std::floor, which is a call on some processors.
std::int32_t cell_of(double x) {
  const auto towards_zero = static_cast<std::int32_t>(x);
  return x < towards_zero ? towards_zero - 1 : towards_zero;
}

Vec2 place_of(Point p) { return {static_cast<double>(p.x), static_cast<double>(p.y)}; }

/// Whether all cells of the box that two places span are free, and with them the chord between the places.
bool is_box_free(Grid grid, const float* clearance, Vec2 a, Vec2 b) {
  for (std::int32_t j = cell_of(std::min(a.y, b.y)); j <= cell_of(std::max(a.y, b.y)); ++j) {
    for (std::int32_t i = cell_of(std::min(a.x, b.x)); i <= cell_of(std::max(a.x, b.x)); ++i) {
      if (!grid.holds(i, j) || !(clearance[grid.at(i, j)] > 0.0F)) return false;
    }
  }
  return true;
}

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
    for (std::int32_t k = 0; k + 1 < count_; ++k) sum += distance(place_of(at(k)), place_of(at(k + 1)));
    return sum;
  }

 private:
  [[nodiscard]] Point& at(std::int32_t k) const noexcept { return p_[static_cast<std::size_t>(k)]; }

  /// Moves by its neighbours' tension and the clearance force: the whole way, half, a quarter of it, or not at all.
  void move(std::int32_t k, float reach) noexcept {
    const Point here = at(k);
    const Vec2 place = place_of(here);
    const Point force = clearance_force(clearance(cell_of(place.x), cell_of(place.y)), slope(here), reach);
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
    const Vec2 place = place_of(p);
    const std::int32_t i = cell_of(place.x), j = cell_of(place.y);
    return {0.5F * (clearance(i + 1, j) - clearance(i - 1, j)), 0.5F * (clearance(i, j + 1) - clearance(i, j - 1))};
  }
  [[nodiscard]] bool stays_free(std::int32_t k, Point there) const noexcept {
    const Vec2 place = place_of(there);
    return place.x >= 0.0 && place.y >= 0.0 && is_box_free(grid_, clearance_, place_of(at(k - 1)), place) &&
           is_box_free(grid_, clearance_, place, place_of(at(k + 1)));
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

constexpr double kSpacing = 0.1;     // m, as wide as a cell
constexpr double kMaxSpacing = 0.2;  // m

/// A place on the band: on the piece that begins at this point of it.
struct Place {
  std::int32_t piece = 0;
  Vec2 at;  ///< cells
};

/// The band's points as a polyline in cells, between exact ends.
class Line {
 public:
  Line(const Point* points, std::int32_t count, Vec2 from, Vec2 to)
      : points_(points), last_(count - 1), from_(from), to_(to) {}

  [[nodiscard]] Place begin() const { return {0, from_}; }
  [[nodiscard]] Place end() const { return {last_, to_}; }
  [[nodiscard]] bool is_end(Place p) const { return p.piece >= last_; }

  [[nodiscard]] double length() const {
    double sum = 0.0;
    for (std::int32_t k = 0; k < last_; ++k) sum += distance(point(k), point(k + 1));
    return sum;
  }

  /// `step` farther along; the end where that comes first.
  [[nodiscard]] Place ahead(Place p, double step) const {
    for (; !is_end(p); p = {p.piece + 1, point(p.piece + 1)}) {
      const Vec2 corner = point(p.piece + 1);
      const double left = distance(p.at, corner);
      if (step < left) return {p.piece, p.at + (corner - p.at) * (step / left)};
      step -= left;
    }
    return p;
  }

  /// The last corner before p, as a place on the piece that ends there.
  [[nodiscard]] Place back_to_corner(Place p) const { return {p.piece - 1, point(p.piece)}; }
  /// The same place; on the next piece where it is a piece's end.
  [[nodiscard]] Place past_corner(Place p) const {
    return !is_end(p) && p.at == point(p.piece + 1) ? Place{p.piece + 1, p.at} : p;
  }

 private:
  [[nodiscard]] Vec2 point(std::int32_t k) const {
    if (k == 0) return from_;
    return k == last_ ? to_ : place_of(points_[k]);
  }

  const Point* points_;
  std::int32_t last_;
  Vec2 from_, to_;
};

/// A cell's successor; itself where the index leads nowhere.
std::int32_t next_of(Grid grid, const std::uint8_t* index, std::int32_t c) {
  const Step s = step_of(index[c]);
  return c + grid.at(s.di, s.dj);
}

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

std::int32_t follow(Grid grid, const std::uint8_t* index, std::int32_t start, std::int32_t goal,
                    std::span<Point> points, std::int32_t count) noexcept {
  const auto capacity = static_cast<std::int32_t>(points.size());
  std::int32_t c = start;
  for (std::int32_t steps = 0; steps <= grid.cells() && count < capacity; ++steps) {
    const std::int32_t i = c % grid.side, j = c / grid.side;
    points[static_cast<std::size_t>(count++)] = {static_cast<float>(i) + 0.5F, static_cast<float>(j) + 0.5F};
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

void resample(const Window& window, const float* clearance, std::span<const Point> points, Vec2 from, Vec2 to,
              Path& path) noexcept {
  const Line line(points.data(), static_cast<std::int32_t>(points.size()), window.in_cells(from), window.in_cells(to));
  const double most = static_cast<double>(kMaxPathPoints - 1), length = line.length() * window.cell_m;
  const double pieces = std::clamp(std::ceil(length / kSpacing), 1.0, most);
  const double spacing = std::min(length / pieces, kMaxSpacing) / window.cell_m;
  const Grid grid = window.grid();
  path.clear();
  (void)path.push_back(from);
  for (Place last = line.begin(); !line.is_end(last) && !path.full();) {
    Place next = line.ahead(last, spacing);
    if (line.is_end(line.ahead(next, 0.5 * spacing))) next = line.end();
    while (next.piece > last.piece && !is_box_free(grid, clearance, last.at, next.at)) next = line.back_to_corner(next);
    last = line.past_corner(next);
    (void)path.push_back(line.is_end(last) ? to : window.in_map(last.at));
  }
}

}  // namespace jaywalk::paper
