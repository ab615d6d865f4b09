#include "hal/sim/free_grid.h"

#include <algorithm>
#include <queue>
#include <utility>

namespace jaywalk::sim {
namespace {

constexpr double kMargin = 1.0;  // m
constexpr double kMostCellsASide = 4000;
constexpr double kRoot2 = 1.4142135623730951;
constexpr int kPulls = 8;  // pulled from both ends in turn; the length settles after about four

double length(const std::vector<Vec2>& path) {
  double sum = 0.0;
  for (std::size_t k = 1; k < path.size(); ++k) sum += distance(path[k - 1], path[k]);
  return sum;
}

/// The same way with points at most `step` apart.
std::vector<Vec2> refined(const std::vector<Vec2>& path, double step) {
  std::vector<Vec2> fine{path.front()};
  for (std::size_t k = 1; k < path.size(); ++k) {
    const Vec2 along = path[k] - path[k - 1];
    const auto parts = static_cast<int>(norm(along) / step) + 1;
    for (int i = 1; i <= parts; ++i) fine.push_back(path[k - 1] + along * (static_cast<double>(i) / parts));
  }
  return fine;
}

constexpr double kHalfRoot2 = 0.70710678118654757;

/// The point in a frame whose axes are the zone's two borders: the zone is there the quarter disc x, y >= 0.
Vec2 in_border_axes(const Zone& zone, Vec2 p) {
  const Vec2 offset = p - zone.apex;
  const double forward = dot(zone.ahead, offset) * kHalfRoot2;
  const double left = cross(zone.ahead, offset) * kHalfRoot2;
  return {forward - left, forward + left};
}

/// Narrows [begin, end] of a parameter to where from + share (to - from) is not negative.
void keep_positive(double from, double to, double& begin, double& end) {
  if (from < 0.0 && to < 0.0) end = -1.0;
  if (from < 0.0 && to >= 0.0) begin = std::max(begin, from / (from - to));
  if (from >= 0.0 && to < 0.0) end = std::min(end, from / (from - to));
}

}  // namespace

FreeGrid::FreeGrid(const Walls& walls, double radius_m, Vec2 start, Vec2 goal) : start_(start), goal_(goal) {
  const Box2& box = walls.bounds();
  low_ = {std::min({box.low.x, start.x, goal.x}) - kMargin, std::min({box.low.y, start.y, goal.y}) - kMargin};
  const Vec2 high{std::max({box.high.x, start.x, goal.x}) + kMargin, std::max({box.high.y, start.y, goal.y}) + kMargin};
  const Vec2 size = high - low_;
  cell_m_ = std::max(cell_m_, std::max(size.x, size.y) / kMostCellsASide);
  columns_ = static_cast<std::int32_t>(size.x / cell_m_) + 1;
  rows_ = static_cast<std::int32_t>(size.y / cell_m_) + 1;
  state_.resize(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_));
  for (std::int32_t index = 0; index < columns_ * rows_; ++index)
    state_[static_cast<std::size_t>(index)] = walls.distance(centre_of(index), radius_m) >= radius_m ? kFree : 0;
  flood_from_start();
}

/// Visits the free cells round `index` with the step's length in cells; a diagonal needs both cells beside it free.
template <class Visit>
void FreeGrid::for_each_neighbour(std::int32_t index, Visit&& visit) const {
  const std::int32_t column = index % columns_, row = index / columns_;
  const auto is_free = [&](std::int32_t c, std::int32_t r) {
    return c >= 0 && r >= 0 && c < columns_ && r < rows_ && state(r * columns_ + c) != 0;
  };
  for (std::int32_t dr = -1; dr <= 1; ++dr) {
    for (std::int32_t dc = -1; dc <= 1; ++dc) {
      if ((dr == 0 && dc == 0) || !is_free(column + dc, row + dr)) continue;
      if (!is_free(column + dc, row) || !is_free(column, row + dr)) continue;
      visit((row + dr) * columns_ + column + dc, dr != 0 && dc != 0 ? kRoot2 : 1.0);
    }
  }
}

void FreeGrid::flood_from_start() {
  const std::int32_t start = index_of(start_);
  if (state(start) == 0) return;
  std::vector<std::int32_t> open{start};
  state_[static_cast<std::size_t>(start)] |= kReached;
  while (!open.empty()) {
    const std::int32_t index = open.back();
    open.pop_back();
    for_each_neighbour(index, [&](std::int32_t next, double) {
      if ((state(next) & kReached) != 0) return;
      state_[static_cast<std::size_t>(next)] |= kReached;
      open.push_back(next);
    });
  }
}

/// Dijkstra (1959) from the goal, so that following the parents leads from the start.
std::vector<Vec2> FreeGrid::cell_path() const {
  using Entry = std::pair<double, std::int32_t>;
  std::vector<double> cost(state_.size(), kInfinity);
  std::vector<std::int32_t> parent(state_.size(), kOutside);
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
  const std::int32_t start = index_of(start_), goal = index_of(goal_);
  cost[static_cast<std::size_t>(goal)] = 0.0;
  open.push({0.0, goal});
  while (!open.empty() && open.top().second != start) {
    const auto [so_far, index] = open.top();
    open.pop();
    if (so_far > cost[static_cast<std::size_t>(index)]) continue;
    for_each_neighbour(index, [&, from = index, here = so_far](std::int32_t next, double step) {
      const auto n = static_cast<std::size_t>(next);
      if (here + step >= cost[n]) return;
      cost[n] = here + step;
      parent[n] = from;
      open.push({cost[n], next});
    });
  }
  std::vector<Vec2> path{start_};
  for (std::int32_t k = parent[static_cast<std::size_t>(start)]; k != kOutside; k = parent[static_cast<std::size_t>(k)])
    path.push_back(centre_of(k));
  path.push_back(goal_);
  return path;
}

double FreeGrid::shortest_path_m() const {
  if (!reachable(start_) || !reachable(goal_)) return kInfinity;
  std::vector<Vec2> path = cell_path();
  for (int k = 0; k < kPulls; ++k) {
    path = pulled(refined(path, cell_m_));
    std::reverse(path.begin(), path.end());
  }
  return length(path);
}

bool Zone::meets(const WallSegment& segment) const noexcept {
  const Vec2 from = in_border_axes(*this, segment.from), to = in_border_axes(*this, segment.to);
  double begin = 0.0, end = 1.0;
  keep_positive(from.x, to.x, begin, end);
  keep_positive(from.y, to.y, begin, end);
  if (begin > end) return false;
  const Vec2 along = to - from;
  return distance(Vec2{}, WallSegment{from + along * begin, from + along * end}) <= reach_m;
}

bool Zone::meets(const Disc& disc) const noexcept {
  const Vec2 centre = in_border_axes(*this, disc.centre);
  if (centre.x >= 0.0 && centre.y >= 0.0) return norm(centre) <= reach_m + disc.radius_m;
  const double to_borders =
      std::min(distance(centre, WallSegment{{}, {reach_m, 0.0}}), distance(centre, WallSegment{{}, {0.0, reach_m}}));
  return to_borders <= disc.radius_m;
}

std::array<WallSegment, 4> RobotBody::edges() const noexcept {
  const Transform2 map_from_body(map_from_robot);
  const Footprint& f = footprint;
  const Vec2 front_left = map_from_body * Vec2{f.front_m, f.half_width_m};
  const Vec2 rear_left = map_from_body * Vec2{-f.rear_m, f.half_width_m};
  const Vec2 rear_right = map_from_body * Vec2{-f.rear_m, -f.half_width_m};
  const Vec2 front_right = map_from_body * Vec2{f.front_m, -f.half_width_m};
  return {{{front_left, rear_left}, {rear_left, rear_right}, {rear_right, front_right}, {front_right, front_left}}};
}

}  // namespace jaywalk::sim
