// The rubber band on random maps, against the raw path.
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <vector>

#include "bench/field/random_maps.h"
#include "planner/paper/path.h"
#include "tests/planner/field_rig.h"
#include "tests/support/catch.h"

using namespace jaywalk;
using namespace jaywalk::test;

namespace {

constexpr std::int32_t kSide = 128, kMapsOfAKind = 100, kWaysOnAMap = 10;
constexpr double kDegrees = 57.29577951308232;

using Line = std::vector<Vec2>;

/// A line, in cells and degrees. Clearance is taken 40 times a segment.
struct Shape {
  double length = 0.0, sharpest = 0.0;
  bool leaves_free = false;
};

/// Clearance of the cell that holds p.
double clearance_at(paper::Grid grid, const float* clearance, Vec2 p) {
  const auto i = static_cast<std::int32_t>(std::floor(p.x)), j = static_cast<std::int32_t>(std::floor(p.y));
  return grid.holds(i, j) ? static_cast<double>(clearance[grid.at(i, j)]) : 0.0;
}

Shape shape_of(const Line& line, paper::Grid grid, const float* clearance) {
  constexpr int kSamples = 40;
  Shape s;
  for (std::size_t k = 1; k < line.size(); ++k) {
    const Vec2 step = line[k] - line[k - 1];
    s.length += norm(step);
    for (int q = 0; q < kSamples; ++q) {
      const Vec2 p = line[k - 1] + step * (q / static_cast<double>(kSamples));
      s.leaves_free = s.leaves_free || clearance_at(grid, clearance, p) <= 0.0;
    }
    if (k + 1 == line.size()) continue;
    const Vec2 next = line[k + 1] - line[k];
    s.sharpest = std::max(s.sharpest, kDegrees * std::fabs(std::atan2(cross(step, next), dot(step, next))));
  }
  return s;
}

Line line_of(std::span<const paper::Point> points) {
  Line line;
  for (const paper::Point& p : points) line.push_back({static_cast<double>(p.x), static_cast<double>(p.y)});
  return line;
}

/// A random map with random ways on it, drawn as the planner draws them.
class Ways {
 public:
  enum Kind : std::size_t { kRaw, kBand, kPath };

  /// The three shapes of a way from somewhere to somewhere; false where there is none.
  bool draw(std::array<Shape, 3>& shapes) {
    const paper::FieldArrays& a = rig_.arrays();
    const std::int32_t start = any_free();
    if (!cell::is_joined(rig_.psi()[start])) return false;
    const std::int32_t count = paper::follow(rig_.grid, a.index, start, rig_.goal, points_, 0);
    if (count < 3) return false;
    points_[0] = within(start);
    points_[static_cast<std::size_t>(count - 1)] = within(rig_.goal);
    const std::span<paper::Point> band_points(points_.data(), static_cast<std::size_t>(count));
    const Line raw = line_of(band_points);
    paper::pull(rig_.grid, a.clearance, band_points, raw_, 1);
    const Line band = line_of(band_points);
    CHECK(band.front() == raw.front());
    CHECK(band.back() == raw.back());
    const field::Window window{{0, 0}, kSide, 0.1};
    paper::resample(window, a.clearance, band_points, window.in_map(band.front()), window.in_map(band.back()), *path_);
    Line path;
    for (const Vec2& p : *path_) path.push_back(window.in_cells(p));
    shapes = {shape_of(raw, rig_.grid, a.clearance), shape_of(band, rig_.grid, a.clearance),
              shape_of(path, rig_.grid, a.clearance)};
    return true;
  }

  /// Free cells, a goal among them, and its potential.
  bool load(MapKind kind, std::uint64_t seed) {
    constexpr float kInflations[] = {0.0F, 1.5F, 3.0F, 4.6F};
    MapRandom walls(seed);
    random_ = Random(seed);
    TestMap map(name_of(kind), kSide);
    map.wall = random_map(kind, kSide, walls).wall;
    rig_.load(map, kInflations[seed % 4], 0);
    free_.clear();
    for (std::int32_t c = 0; c < rig_.grid.cells(); ++c) {
      if (rig_.arrays().clearance[c] > 0.0F) free_.push_back(c);
    }
    if (free_.empty()) return false;
    rig_.load(map, kInflations[seed % 4], any_free());
    return rig_.solve().certified;
  }

 private:
  std::int32_t any_free() {
    return free_[static_cast<std::size_t>(random_.below(static_cast<std::int32_t>(free_.size())))];
  }
  paper::Point within(std::int32_t c) {
    const auto i = static_cast<double>(c % kSide), j = static_cast<double>(c / kSide);
    const double x = random_.unit(), y = random_.unit();
    return {static_cast<float>(i + 0.999 * x), static_cast<float>(j + 0.999 * y)};
  }

  FieldRig<> rig_{kSide};
  std::vector<paper::Point> points_ = std::vector<paper::Point>(static_cast<std::size_t>(paper::kMaxBandPoints));
  std::vector<paper::Point> raw_ = points_;
  Random random_{1};
  std::vector<std::int32_t> free_;
  std::unique_ptr<Path> path_ = std::make_unique<Path>();
};

}  // namespace

TEST_CASE(
    "on 400 random maps band and path stay in free cells, the band turns by 60 degrees at most and is no longer than "
    "the raw path") {
  Ways ways;
  for (const MapKind kind : kMapKinds) {
    int drawn = 0;
    for (std::uint64_t seed = 1; seed <= kMapsOfAKind; ++seed) {
      if (!ways.load(kind, seed)) continue;
      for (int k = 0; k < kWaysOnAMap; ++k) {
        std::array<Shape, 3> shapes;
        if (!ways.draw(shapes)) continue;
        ++drawn;
        CHECK_FALSE(shapes[Ways::kBand].leaves_free);
        CHECK_FALSE(shapes[Ways::kPath].leaves_free);
        CHECK(shapes[Ways::kBand].sharpest < 60.0);
        CHECK(shapes[Ways::kBand].sharpest < std::max(45.01, shapes[Ways::kRaw].sharpest + 0.01));
        CHECK(shapes[Ways::kPath].sharpest < 75.0);
        CHECK(shapes[Ways::kBand].length <= shapes[Ways::kRaw].length * (1.0 + 1e-6));
      }
    }
    CHECK(drawn > 300);
  }
}

TEST_CASE("the band shortens the raw path, turns less, and never leaves free cells") {
  FieldRig<> rig(256);
  rig.load(clutter(11), 3.0F, rig.grid.at(240, 240));
  REQUIRE(rig.solve().certified);
  const paper::FieldArrays& a = rig.arrays();
  std::vector<paper::Point> points(static_cast<std::size_t>(paper::kMaxBandPoints));
  const std::int32_t count = paper::follow(rig.grid, a.index, rig.grid.at(10, 12), rig.goal, points, 0);
  REQUIRE(count > 200);
  points.resize(static_cast<std::size_t>(count));
  const Line raw = line_of(points);
  std::vector<paper::Point> room(points.size());
  paper::pull(rig.grid, a.clearance, points, room, 1);
  const Shape band = shape_of(line_of(points), rig.grid, a.clearance);
  CHECK(band.length < 0.98 * shape_of(raw, rig.grid, a.clearance).length);
  CHECK_FALSE(band.leaves_free);
  CHECK(band.sharpest < 30.68);  // the raw path turns by 45
}

TEST_CASE("the cosine of a turn: none, a right angle, back, and none to be had where points coincide") {
  CHECK(paper::turn_cosine({0.0F, 0.0F}, {1.0F, 0.0F}, {3.0F, 0.0F}) == 1.0F);
  CHECK(paper::turn_cosine({0.0F, 0.0F}, {1.0F, 0.0F}, {1.0F, 2.0F}) == 0.0F);
  CHECK(paper::turn_cosine({0.0F, 0.0F}, {1.0F, 0.0F}, {0.0F, 0.0F}) == -1.0F);
  CHECK(std::isnan(paper::turn_cosine({0.0F, 0.0F}, {0.0F, 0.0F}, {1.0F, 0.0F})));
}
