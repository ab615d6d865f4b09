#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "planner/cost_to_go/guide_field.h"

namespace jaywalk::field {
namespace {

constexpr std::int32_t kLeastSide = 512;
constexpr double kMost_m = 500.0;
constexpr std::int32_t kMargin = 25;  ///< cells about a known map
constexpr Duration kUpdateEvery = std::chrono::seconds(1);
/// Of cells beside a wall, and of those that were never seen: a person keeps to the middle of a corridor that is known.
constexpr std::uint32_t kBesideWall = kRateOfOpenGround * 3 / 2, kUnseen = kRateOfOpenGround * 5 / 2;

/// Calls visit(i, j) for a cell and the eight about it.
template <class Visit>
void for_each_about(CellIndex cell, const Visit& visit) {
  for (std::int32_t j = cell.j - 1; j <= cell.j + 1; ++j)
    for (std::int32_t i = cell.i - 1; i <= cell.i + 1; ++i) visit(i, j);
}

std::int32_t floor_of(double cells) noexcept {
  return static_cast<std::int32_t>(std::floor(std::clamp(cells, -5e8, 5e8)));
}

std::int32_t side_for(const KnownMap* known, std::int32_t fine, double cell_m) {
  const std::int32_t needed = known == nullptr ? 0 : std::max(known->width, known->height) / fine + 2 * kMargin;
  return std::min(std::max(needed, kLeastSide), floor_of(kMost_m / cell_m));
}

}  // namespace

FarGuide::FarGuide(double cell_m, std::shared_ptr<const KnownMap> known)
    : cell_m_(cell_m * kFine),
      known_(std::move(known)),
      grid_{side_for(known_.get(), kFine, cell_m_)},
      kinds_(static_cast<std::size_t>(grid_.cells())),
      graph_(grid_.side),
      repair_(CellGraph::size_for(grid_.side), 2 * CellGraph::size_for(grid_.side)) {
  changed_.resize(kinds_.size());  // touched, not only reserved: no page is to be fetched later
  graph_.take_grid(grid_);
  if (known_)
    lay_about(Vec2{known_->low.i + known_->width / 2.0, known_->low.j + known_->height / 2.0} * known_->cell_m);
}

CellIndex FarGuide::cell_at(Vec2 p) const noexcept {
  return {floor_of(p.x / cell_m_) - low_.i, floor_of(p.y / cell_m_) - low_.j};
}

std::uint32_t FarGuide::rate(std::int32_t i, std::int32_t j) const noexcept {
  const KnownCell here = kind(i, j);
  if (here == KnownCell::kWall) return 0;
  if (here == KnownCell::kUnknown) return kUnseen;
  bool beside_wall = false;
  for_each_about({i, j}, [&](std::int32_t x, std::int32_t y) { beside_wall |= kind(x, y) == KnownCell::kWall; });
  return beside_wall ? kBesideWall : kRateOfOpenGround;
}

/// What was remembered of elsewhere is forgotten; the known map is not.
void FarGuide::lay_about(Vec2 middle) noexcept {
  low_ = {floor_of(middle.x / cell_m_) - grid_.side / 2, floor_of(middle.y / cell_m_) - grid_.side / 2};
  laid_ = true, settled_ = false;
  std::fill(kinds_.begin(), kinds_.end(), KnownCell::kUnknown);
  if (!known_) return;
  for (std::int32_t j = 0; j < known_->height; ++j)
    for (std::int32_t i = 0; i < known_->width; ++i) {
      const CellIndex fine{known_->low.i + i, known_->low.j + j};
      note(fine, known_->at(fine));
    }
}

/// The worst of a coarse cell's fine ones: a wall before free ground, that before nothing.
void FarGuide::note(CellIndex fine, KnownCell as) noexcept {
  const std::int32_t i = (fine.i >= 0 ? fine.i : fine.i - kFine + 1) / kFine - low_.i,
                     j = (fine.j >= 0 ? fine.j : fine.j - kFine + 1) / kFine - low_.j;
  if (!grid_.holds(i, j)) return;
  KnownCell& kind = kinds_[static_cast<std::size_t>(grid_.at(i, j))];
  kind = std::max(kind, as);
}

void FarGuide::set(CellIndex cell, KnownCell as) noexcept {
  KnownCell& kind = kinds_[static_cast<std::size_t>(grid_.at(cell.i, cell.j))];
  if (std::exchange(kind, as) == as || !settled_) return;
  for_each_about(cell, [&](std::int32_t i, std::int32_t j) {
    if (!grid_.holds(i, j)) return;
    const std::int32_t n = graph_.at(i, j);
    const std::uint32_t now = rate(i, j);
    if (graph_.rate(n) == now) return;
    graph_.set_rate(n, now);
    if (changed_.size() == changed_.capacity())
      settled_ = false;
    else
      changed_.push_back(n);
  });
}

/// Cells of which the evidence map holds all and has seen any.
void FarGuide::take_over(const EvidenceMap& still) noexcept {
  const std::int32_t side = still.side() / kFine - 1;
  const CellIndex first{(still.low().i + kFine - 1 - low_.i * kFine) / kFine,
                        (still.low().j + kFine - 1 - low_.j * kFine) / kFine};
  for (std::int32_t j = std::max(first.j, 0); j < std::min(first.j + side, grid_.side); ++j) {
    for (std::int32_t i = std::max(first.i, 0); i < std::min(first.i + side, grid_.side); ++i) {
      KnownCell seen = KnownCell::kUnknown;
      std::array<std::int8_t, kFine> row{};
      for (std::int32_t k = 0; k < kFine; ++k) {
        still.copy_row({(i + low_.i) * kFine, (j + low_.j) * kFine + k}, kFine, row.data());
        for (const std::int8_t evidence : row)
          if (evidence != 0)
            seen = std::max(seen, evidence > EvidenceMap::kOccupied ? KnownCell::kWall : KnownCell::kFree);
      }
      if (seen != KnownCell::kUnknown) set({i, j}, seen);
    }
  }
}

/// The cell of the goal, or of those beside it the nearest without a wall; kNone where there is none.
std::int32_t FarGuide::goal_node(Vec2 goal) const noexcept {
  const CellIndex at = cell_at(goal);
  const std::int32_t last = grid_.side - 1, i = std::clamp(at.i, 0, last), j = std::clamp(at.j, 0, last);
  std::int32_t best = CellGraph::kNone;
  double least = std::numeric_limits<double>::infinity();
  for_each_about({i, j}, [&](std::int32_t x, std::int32_t y) {
    if (!grid_.holds(x, y) || kind(x, y) == KnownCell::kWall) return;
    const double away = x == i && y == j ? 0.0 : distance(middle_of({x, y}), goal);
    if (away < least) least = away, best = graph_.at(x, y);
  });
  return best;
}

void FarGuide::settle_anew() noexcept {
  graph_.clear();
  for (std::int32_t j = 0; j < grid_.side; ++j)
    for (std::int32_t i = 0; i < grid_.side; ++i) graph_.set_rate(graph_.at(i, j), rate(i, j));
  graph_.seed(goal_);
  repair_.clear();
  if (goal_ != CellGraph::kNone) repair_.offer(graph_, goal_, 0);
  settled_ = repair_.settle(graph_);
}

void FarGuide::settle(Time now, const EvidenceMap* still, Vec2 robot, Vec2 goal) noexcept {
  const auto holds = [this](Vec2 p) { return grid_.holds(cell_at(p).i, cell_at(p).j); };
  if (!laid_ || !holds(robot)) lay_about((robot + goal) * 0.5);
  if (!holds(robot)) lay_about(robot);
  const std::int32_t goal_now = goal_node(goal);
  const bool is_due = updated_ == kNever || age(updated_, now) >= kUpdateEvery;
  if (settled_ && goal_now == goal_ && !is_due) return;
  updated_ = now;
  changed_.clear();
  if (still != nullptr) take_over(*still);
  const std::int32_t before = std::exchange(goal_, goal_node(goal));
  if (settled_ && goal_ == before && (changed_.empty() || repair_.repair(graph_, changed_))) return;
  settle_anew();
}

double FarGuide::to_go_m(Vec2 p) const noexcept {
  const CellIndex at = cell_at(p);
  double least = std::numeric_limits<double>::infinity();
  if (!settled_ || !grid_.holds(at.i, at.j) || kind(at.i, at.j) == KnownCell::kWall) return least;
  for_each_about(at, [&](std::int32_t i, std::int32_t j) {
    const std::int32_t n = graph_.at(i, j);
    if (graph_.has_way(n))
      least = std::min(least, graph_.cost(n) * cell_m_ / kCostsPerCell + distance(p, middle_of({i, j})));
  });
  return least;
}

bool FarGuide::has_way_near(Vec2 p) const noexcept {
  const CellIndex at = cell_at(p);
  bool any = false;
  if (settled_ && grid_.holds(at.i, at.j))
    for_each_about(at, [&](std::int32_t i, std::int32_t j) { any |= graph_.has_way(graph_.at(i, j)); });
  return any;
}

}  // namespace jaywalk::field
