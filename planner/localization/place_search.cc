#include "planner/localization/place_search.h"

#include <array>

namespace jaywalk {
namespace {
// Lattice of poses and rules of visibility that both searches share.

constexpr std::int32_t kLatticeCells = 2;                        ///< from a place to the next
constexpr int kLatticeHeadings = 90;                             ///< in a turn
constexpr std::int32_t kNearCells = 3;                           ///< half a step moves points 8 m off so far
constexpr double kPlacesApart_m = 1.0, kPlacesApart_rad = 0.52;  ///< nearer poses are one place
constexpr double kBeforePoint_m = 0.3;                           ///< a wall this much nearer hides a point

bool are_places_apart(const Pose2& a, const Pose2& b) {
  return distance(a.position(), b.position()) > kPlacesApart_m ||
         std::fabs(wrap_angle(a.heading - b.heading)) > kPlacesApart_rad;
}

/// True where a wall hides `point` from the laser: a beam does not pass through one (Thrun, Burgard, Fox: Probabilistic
/// Robotics, 2005, 6.3). `is_wall(place)` is asked every `step_m`.
template <class IsWall>
bool is_hidden(Vec2 laser, Vec2 point, double step_m, const IsWall& is_wall) {
  const double range = distance(laser, point);
  const Vec2 along = (point - laser) * (1.0 / std::max(range, step_m));
  for (double gone = step_m; gone < range - kBeforePoint_m; gone += step_m)
    if (is_wall(laser + along * gone)) return true;
  return false;
}

constexpr std::size_t kLatticePoints = 80;  ///< of the sample
constexpr std::int32_t kRowsDrawn = 64;
constexpr double kLattice_m = 0.15, kLattice_rad = 0.06;  ///< standard deviations of a coarse pose

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

constexpr std::size_t kCoarsePoints = 60;              ///< of the sample
constexpr int kFineSteps = 6;                          ///< of 5 cm to each side
constexpr int kFineTurns = 5;                          ///< of a degree
constexpr std::size_t kKept = 400, kLookedAt = 40;     ///< coarse poses; of these, apart from each other, closely
constexpr double kStep_m = 0.05;                       ///< along a beam
constexpr std::uint8_t kOnWall = 10, kBesideWall = 9;  ///< tenths of a point's worth

struct Scored {
  Pose2 pose;
  double share = 0.0;
};

/// What a point is worth in each cell.
class Worth {
 public:
  /// Up to `beside` cells off counts as beside a wall.
  Worth(const KnownMap& map, std::int32_t beside) : map_(map), worth_(map.cells.size(), 0) {
    for (std::int32_t j = 0; j < map.height; ++j) {
      for (std::int32_t i = 0; i < map.width; ++i) {
        if (map.at({map.low.i + i, map.low.j + j}) == KnownCell::kWall) mark(i, j, beside);
      }
    }
  }
  [[nodiscard]] double share(const MatchSample& sample, std::size_t stride, const Pose2& pose) const {
    const Transform2 to_map(pose);
    std::uint32_t sum = 0, count = 0;
    for (std::size_t k = 0; k < sample.size(); k += stride, ++count) sum += at(to_map * sample[k]);
    return static_cast<double>(sum) / (kOnWall * std::max(count, 1U));
  }

  /// The same for points that no wall hides from the laser.
  [[nodiscard]] double share_seen(const MatchSample& sample, Vec2 laser_in_robot, const Pose2& pose) const {
    const Transform2 to_map(pose);
    const Vec2 laser = to_map * laser_in_robot;
    std::uint32_t sum = 0;
    const auto is_wall = [this](Vec2 place) { return at(place) == kOnWall; };
    for (const Vec2& point : sample)
      sum += is_hidden(laser, to_map * point, kStep_m, is_wall) ? 0U : at(to_map * point);
    return static_cast<double>(sum) / (kOnWall * std::max(static_cast<double>(sample.size()), 1.0));
  }

 private:
  void mark(std::int32_t i, std::int32_t j, std::int32_t beside) {
    for (std::int32_t y = std::max(j - beside, 0); y <= std::min(j + beside, map_.height - 1); ++y) {
      for (std::int32_t x = std::max(i - beside, 0); x <= std::min(i + beside, map_.width - 1); ++x) {
        std::uint8_t& worth = worth_[map_.index({map_.low.i + x, map_.low.j + y})];
        worth = std::max(worth, x == i && y == j ? kOnWall : kBesideWall);
      }
    }
  }
  [[nodiscard]] std::uint8_t at(Vec2 p) const {
    const double i = std::floor(p.x / map_.cell_m) - map_.low.i, j = std::floor(p.y / map_.cell_m) - map_.low.j;
    if (!(i >= 0.0 && j >= 0.0 && i < map_.width && j < map_.height)) return 0;
    return worth_[static_cast<std::size_t>(j) * static_cast<std::size_t>(map_.width) + static_cast<std::size_t>(i)];
  }

  const KnownMap& map_;
  std::vector<std::uint8_t> worth_;
};

bool is_better(const Scored& a, const Scored& b) { return a.share > b.share; }

/// The best of `poses`, best first, that are apart from each other.
std::vector<Scored> best_apart(const std::vector<Scored>& poses) {
  std::vector<Scored> chosen;
  for (const Scored& one : poses) {
    const auto is_near = [&one](const Scored& better) { return !are_places_apart(one.pose, better.pose); };
    if (std::none_of(chosen.begin(), chosen.end(), is_near)) chosen.push_back(one);
    if (chosen.size() == kLookedAt) break;
  }
  return chosen;
}

/// Coarse poses, the best ones among them, best first.
std::vector<Scored> look_everywhere(const KnownMap& map, const Worth& worth, const MatchSample& sample) {
  const std::size_t stride = sample.size() / kCoarsePoints + 1;
  std::vector<Scored> kept;
  for (std::int32_t j = 0; j < map.height; j += kLatticeCells) {
    for (std::int32_t i = 0; i < map.width; i += kLatticeCells) {
      if (map.at({map.low.i + i, map.low.j + j}) != KnownCell::kFree) continue;
      const Vec2 p{(map.low.i + i + 0.5) * map.cell_m, (map.low.j + j + 0.5) * map.cell_m};
      Scored best, other;  // of each place: the best heading, and the best that is another
      std::array<Scored, kLatticeHeadings> all;
      for (int k = 0; k < kLatticeHeadings; ++k) {
        const Pose2 pose{p.x, p.y, wrap_angle(2.0 * kPi * k / kLatticeHeadings)};
        all[static_cast<std::size_t>(k)] = {pose, worth.share(sample, stride, pose)};
      }
      for (const Scored& one : all)
        if (one.share > best.share) best = one;
      for (const Scored& one : all)
        if (one.share > other.share && are_places_apart(one.pose, best.pose)) other = one;
      kept.push_back(best);
      kept.push_back(other);
      if (kept.size() < 16 * kKept) continue;
      std::partial_sort(kept.begin(), kept.begin() + kKept, kept.end(), is_better);
      kept.resize(kKept);
    }
  }
  std::sort(kept.begin(), kept.end(), is_better);
  return kept;
}

Scored looked_at_closely(const Worth& worth, const MatchSample& sample, const Scored& coarse) {
  Scored best = coarse;
  best.share = 0.0;
  for (int h = -kFineTurns; h <= kFineTurns; ++h) {
    for (int y = -kFineSteps; y <= kFineSteps; ++y) {
      for (int x = -kFineSteps; x <= kFineSteps; ++x) {
        const Pose2 pose{coarse.pose.x + 0.05 * x, coarse.pose.y + 0.05 * y,
                         wrap_angle(coarse.pose.heading + h * kPi / 180.0)};
        const double share = worth.share(sample, 1, pose);
        if (share > best.share) best = {pose, share};
      }
    }
  }
  return best;
}

}  // namespace

void add_sample(const ScanPoints& scan, Vec2 laser_in_robot, std::size_t scanners, SeenSample& to) noexcept {
  for (const Vec2& point : sample_of(scan, kMostMatchPoints / scanners)) {
    if (!to.points.push_back(point)) return;
    static_cast<void>(to.lasers.push_back(laser_in_robot));
  }
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

GlobalMatch search_everywhere(const KnownMap& map, const MatchSample& sample, Vec2 laser_in_robot) {
  const Worth roughly(map, kNearCells), worth(map, 1);
  std::vector<Scored> found;
  for (const Scored& coarse : best_apart(look_everywhere(map, roughly, sample)))
    found.push_back(looked_at_closely(worth, sample, coarse));
  for (Scored& one : found) one.share = worth.share_seen(sample, laser_in_robot, one.pose);
  if (found.empty()) return {};
  const Scored best = *std::min_element(found.begin(), found.end(), is_better);
  GlobalMatch match{best.pose, best.share, std::nullopt, 0.0};
  for (const Scored& other : found) {
    if (are_places_apart(other.pose, best.pose) && other.share > match.other_share)
      match.other = other.pose, match.other_share = other.share;
  }
  return match;
}

}  // namespace jaywalk
