// What the rubber band promises, on 400 random maps, and what it makes of the raw path.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
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

/// What is measured of a line, in cells and degrees. Clearance is taken 40 times a segment.
struct Shape {
  double length = 0.0, turns = 0.0, sharpest = 0.0, mean_clearance = 0.0, least_clearance = 1e9;
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
      const double clear = clearance_at(grid, clearance, line[k - 1] + step * (q / static_cast<double>(kSamples)));
      s.mean_clearance += clear / (kSamples * static_cast<double>(line.size() - 1));
      s.least_clearance = std::min(s.least_clearance, clear);
    }
    if (k + 1 == line.size()) continue;
    const Vec2 next = line[k + 1] - line[k];
    const double turn = kDegrees * std::fabs(std::atan2(step.x * next.y - step.y * next.x, dot(step, next)));
    s.turns += turn;
    s.sharpest = std::max(s.sharpest, turn);
  }
  s.leaves_free = s.least_clearance <= 0.0;
  return s;
}

/// Sums over many lines.
struct Row {
  double length = 0.0, turns = 0.0, mean_clearance = 0.0, least_clearance = 0.0, sharpest = 0.0;
  int lines = 0, leaving = 0;

  void add(const Shape& s) {
    ++lines, leaving += s.leaves_free ? 1 : 0;
    length += s.length, turns += s.turns, mean_clearance += s.mean_clearance, least_clearance += s.least_clearance;
    sharpest = std::max(sharpest, s.sharpest);
  }
  void print(const char* map, const char* what) const {
    std::printf("| %s | %s | %d | %.2f | %.1f | %.1f | %.2f | %.2f | %d |\n", map, what, lines, 0.1 * length / lines,
                turns / (0.1 * length), sharpest, 0.1 * mean_clearance / lines, 0.1 * least_clearance / lines, leaving);
  }
};

/// A random map with random ways on it, drawn as the planner draws them.
class Ways {
 public:
  enum Kind : std::size_t { kRaw, kBand, kPath };

  /// The three shapes of a way from somewhere to somewhere; false where there is none.
  bool draw(std::array<Shape, 3>& shapes) {
    const paper::FieldArrays& a = rig_.arrays();
    const std::int32_t start = free_[static_cast<std::size_t>(random_.below(static_cast<std::int32_t>(free_.size())))];
    if (!cell::is_joined(rig_.psi()[start])) return false;
    const std::int32_t count = paper::follow(rig_.grid, a.index, start, goal_, points_, 0);
    if (count < 3) return false;
    points_[0] = within(start);
    points_[static_cast<std::size_t>(count - 1)] = within(goal_);
    const Line raw = line(count);
    const std::span<paper::Point> band_points(points_.data(), static_cast<std::size_t>(count));
    paper::pull(rig_.grid, a.clearance, band_points, raw_, 1);
    const Line band = line(count);
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
    goal_ = free_[static_cast<std::size_t>(random_.below(static_cast<std::int32_t>(free_.size())))];
    rig_.load(map, kInflations[seed % 4], goal_);
    return rig_.pass.solve(rig_.grid, goal_, paper::From::kNothing).certified;
  }

 private:
  paper::Point within(std::int32_t c) {
    const auto i = static_cast<double>(c % kSide), j = static_cast<double>(c / kSide);
    const double x = random_.unit(), y = random_.unit();
    return {static_cast<float>(i + 0.999 * x), static_cast<float>(j + 0.999 * y)};
  }
  [[nodiscard]] Line line(std::int32_t count) const {
    Line l;
    for (std::int32_t k = 0; k < count; ++k) {
      const paper::Point p = points_[static_cast<std::size_t>(k)];
      l.push_back({static_cast<double>(p.x), static_cast<double>(p.y)});
    }
    return l;
  }

  FieldRig<> rig_{kSide};
  std::vector<paper::Point> points_ = std::vector<paper::Point>(static_cast<std::size_t>(paper::kMaxBandPoints));
  std::vector<paper::Point> raw_ = points_;
  Random random_{1};
  std::vector<std::int32_t> free_;
  std::int32_t goal_ = 0;
  std::unique_ptr<Path> path_ = std::make_unique<Path>();
};

}  // namespace

TEST_CASE(
    "on 400 random maps band and path stay in free cells, the band turns by 60 degrees at most and is no longer than "
    "the raw path") {
  Ways ways;
  std::printf(
      "| map | line | ways | length m | turn deg/m | sharpest deg | clearance m | least m | leave free cells |\n");
  for (const MapKind kind : kMapKinds) {
    std::array<Row, 3> rows;
    for (std::uint64_t seed = 1; seed <= kMapsOfAKind; ++seed) {
      if (!ways.load(kind, seed)) continue;
      for (int k = 0; k < kWaysOnAMap; ++k) {
        std::array<Shape, 3> shapes;
        if (!ways.draw(shapes)) continue;
        for (std::size_t line = 0; line < 3; ++line) rows[line].add(shapes[line]);
        CHECK_FALSE(shapes[Ways::kBand].leaves_free);
        CHECK_FALSE(shapes[Ways::kPath].leaves_free);
        CHECK(shapes[Ways::kBand].sharpest < 60.0);
        CHECK(shapes[Ways::kBand].sharpest < std::max(45.01, shapes[Ways::kRaw].sharpest + 0.01));
        CHECK(shapes[Ways::kPath].sharpest < 75.0);
        CHECK(shapes[Ways::kBand].length <= shapes[Ways::kRaw].length * (1.0 + 1e-6));
      }
    }
    CHECK(rows[Ways::kRaw].lines > 300);
    rows[Ways::kRaw].print(name_of(kind), "raw");
    rows[Ways::kBand].print(name_of(kind), "band");
    rows[Ways::kPath].print(name_of(kind), "path");
  }
}

TEST_CASE("the cosine of a turn: none, a right angle, back, and none to be had where points coincide") {
  CHECK(paper::turn_cosine({0.0F, 0.0F}, {1.0F, 0.0F}, {3.0F, 0.0F}) == 1.0F);
  CHECK(paper::turn_cosine({0.0F, 0.0F}, {1.0F, 0.0F}, {1.0F, 2.0F}) == 0.0F);
  CHECK(paper::turn_cosine({0.0F, 0.0F}, {1.0F, 0.0F}, {0.0F, 0.0F}) == -1.0F);
  CHECK(std::isnan(paper::turn_cosine({0.0F, 0.0F}, {0.0F, 0.0F}, {1.0F, 0.0F})));
}
