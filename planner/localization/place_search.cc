#include "planner/localization/place_search.h"

#include <array>

namespace jaywalk {
namespace {
constexpr std::size_t kLatticePoints = 80;  ///< of the sample
constexpr std::int32_t kRowsDrawn = 64;
constexpr double kLattice_m = 0.15, kLattice_rad = 0.06;  ///< standard deviations of a coarse pose
/// A good place: of the points known, and of these on walls; people stand before the others. Better by kClearly: the
/// map contradicts a smaller share of the points (robot_tests "[carried]"). Places that it knows little of contradict
/// nothing.
constexpr double kPlaceKnown = 0.5, kPlaceFits = 0.7, kSaysNothing = 0.3, kClearly = 0.1;

double worth_of_place(const PlaceFit& place) { return 2.0 * place.on_walls - place.known; }

bool is_near_wall(const EvidenceMap& map, CellIndex cell) {
  for (std::int32_t j = -1; j <= 1; ++j)
    for (std::int32_t i = -1; i <= 1; ++i)
      if (map.occupied({cell.i + i, cell.j + j})) return true;
  return false;
}

PlaceFit fit_at(const SeenSample& sample, const EvidenceMap& map, const Pose2& pose) {
  const Transform2 to_map(pose);
  const auto is_wall = [&map](Vec2 place) { return map.occupied(map.cell_at(place)); };
  std::size_t on_walls = 0, known = 0;
  for (std::size_t k = 0; k < sample.points.size(); ++k) {
    const Vec2 point = to_map * sample.points[k];
    const CellIndex cell = map.cell_at(point);
    const bool hidden = is_hidden(to_map * sample.lasers[k], point, map.cell_m(), is_wall),
               on = !hidden && is_near_wall(map, cell);
    on_walls += on ? 1U : 0U;
    known += on || hidden || map.seen_free(cell) ? 1U : 0U;
  }
  const double all = std::max(static_cast<double>(sample.points.size()), 1.0);
  return {pose, static_cast<double>(on_walls) / all, static_cast<double>(known) / all};
}

}  // namespace

void add_sample(const ScanPoints& scan, Vec2 laser_in_robot, std::size_t scanners, SeenSample& to) noexcept {
  const std::size_t most = kMostMatchPoints / scanners, stride = (scan.size() + most - 1) / most;
  for (std::size_t k = 0; k < scan.size(); k += stride) {
    if (!to.points.push_back(scan[k].in_robot)) return;
    static_cast<void>(to.lasers.push_back(laser_in_robot));
  }
}

bool PlaceFit::fits() const noexcept { return fit() >= kPlaceFits; }
bool PlaceFit::is_good() const noexcept { return known >= kPlaceKnown && fits(); }
bool PlaceFit::says_nothing() const noexcept { return known < kSaysNothing; }
bool PlaceFit::is_clearly_better_than(const PlaceFit& other) const noexcept {
  return on_walls > other.on_walls && known - on_walls + kClearly < other.known - other.on_walls;
}

PlaceSearch::PlaceSearch() : near_wall_(static_cast<std::size_t>(kSide) * kSide) {
  free_.reserve(static_cast<std::size_t>(kSide / 4 / kLatticeCells + 1) * (kSide / 4 / kLatticeCells + 1));
}

void PlaceSearch::begin(const SeenSample& sample, Vec2 about) noexcept {
  stage_ = Stage::kDraw;
  sample_ = sample;
  about_ = about;
  row_ = heading_ = 0;
  candidate_ = 0;
  free_.clear();
  candidates_.clear();
  best_ = {};
  best_.known = 1.0;
}

bool PlaceSearch::step(const EvidenceMap& map) noexcept {
  if (stage_ == Stage::kDraw) {
    draw(map);
  } else if (stage_ == Stage::kLook) {
    look(map);
  } else if (stage_ == Stage::kMatch) {
    return match(map);
  }
  return false;
}

void PlaceSearch::draw(const EvidenceMap& map) noexcept {
  if (row_ == 0) {
    std::fill(near_wall_.begin(), near_wall_.end(), std::uint8_t{0});
    const CellIndex middle = map.cell_at(about_);
    low_ = {middle.i - kSide / 2, middle.j - kSide / 2};
  }
  std::array<std::int8_t, kSide> evidence{};
  for (const std::int32_t end = row_ + kRowsDrawn; row_ < end; ++row_) {
    map.copy_row({low_.i, low_.j + row_}, kSide, evidence.data());
    const bool in_reach = std::abs(row_ - kSide / 2) <= kSide / 8 && row_ % kLatticeCells == 0;
    for (std::int32_t i = 0; i < kSide; ++i) {
      const int seen = evidence[static_cast<std::size_t>(i)];
      if (seen > EvidenceMap::kOccupied) draw_wall(i, row_);
      if (in_reach && seen < EvidenceMap::kFree && std::abs(i - kSide / 2) <= kSide / 8 && i % kLatticeCells == 0)
        free_.push_back(static_cast<std::uint32_t>(row_ * kSide + i));
    }
  }
  if (row_ == kSide) stage_ = Stage::kLook;
}

void PlaceSearch::draw_wall(std::int32_t i, std::int32_t j) noexcept {
  const std::int32_t from = std::max(i - kNearCells, 0), to = std::min(i + kNearCells, kSide - 1);
  for (std::int32_t y = std::max(j - kNearCells, 0); y <= std::min(j + kNearCells, kSide - 1); ++y)
    std::fill(near_wall_.begin() + y * kSide + from, near_wall_.begin() + y * kSide + to + 1, std::uint8_t{1});
}

/// One heading at all places: each point is turned once, and lies as many cells off at each of them.
void PlaceSearch::look(const EvidenceMap& map) noexcept {
  const double heading = wrap_angle(2.0 * kPi * heading_ / kLatticeHeadings), cell_m = map.cell_m();
  const Transform2 turned({0.0, 0.0, heading});
  const std::size_t stride = sample_.points.size() / kLatticePoints + 1;
  constexpr double kDrawnAbout = 3.0 / 8.0 * kSide - 1.0;  // cells: what lies no farther off is drawn for every place
  FixedVector<std::int32_t, kMostMatchPoints> offsets;
  for (std::size_t k = 0; k < sample_.points.size(); k += stride) {
    const Vec2 cells = turned.rotate(sample_.points[k]) * (1.0 / cell_m) + Vec2{0.5, 0.5};
    if (std::fabs(cells.x) > kDrawnAbout || std::fabs(cells.y) > kDrawnAbout) continue;
    const auto i = static_cast<std::int32_t>(std::floor(cells.x)), j = static_cast<std::int32_t>(std::floor(cells.y));
    static_cast<void>(offsets.push_back(j * kSide + i));
  }
  for (const std::uint32_t place : free_) {
    const std::uint8_t* const at = near_wall_.data() + place;
    int sum = 0;
    for (const std::int32_t offset : offsets) sum += at[offset];
    if (candidates_.full() && sum <= candidates_.back().worth) continue;
    const auto side = static_cast<std::uint32_t>(kSide);
    const Vec2 centre = map.centre_of(
        {low_.i + static_cast<std::int32_t>(place % side), low_.j + static_cast<std::int32_t>(place / side)});
    note({{centre.x, centre.y, heading}, sum});
  }
  if (++heading_ == kLatticeHeadings) stage_ = Stage::kMatch;
}

/// The best first, apart from each other.
void PlaceSearch::note(const Candidate& seen) noexcept {
  std::size_t place = candidates_.size();
  for (std::size_t k = 0; k < candidates_.size(); ++k) {
    if (are_places_apart(candidates_[k].pose, seen.pose)) continue;
    if (candidates_[k].worth >= seen.worth) return;
    place = k;
    break;
  }
  if (place == candidates_.size() && !candidates_.push_back(seen)) place = candidates_.size() - 1;
  candidates_[place] = seen;
  for (; place > 0 && candidates_[place - 1].worth < candidates_[place].worth; --place)
    std::swap(candidates_[place - 1], candidates_[place]);
}

bool PlaceSearch::match(const EvidenceMap& map) noexcept {
  if (candidate_ < candidates_.size()) {
    const PlaceFit place = matched(sample_, map, candidates_[candidate_++].pose, kLattice_m, kLattice_rad);
    if (worth_of_place(place) > worth_of_place(best_)) best_ = place;
    return false;
  }
  stage_ = Stage::kIdle;
  return true;
}

PlaceFit PlaceSearch::matched(const SeenSample& sample, const EvidenceMap& map, const Pose2& about,
                              double position_std_m, double heading_std_rad) noexcept {
  const double var = position_std_m * position_std_m;
  const MatchResult found =
      match_sample(sample.points, {map}, {about, diagonal(var, var, heading_std_rad * heading_std_rad)});
  const bool moved = found.matched && finite(found.belief.map_from_robot);
  return fit_at(sample, map, moved ? found.belief.map_from_robot : about);
}

}  // namespace jaywalk
