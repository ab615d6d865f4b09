#include "planner/localization/global_search.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "planner/localization/place_search.h"

namespace jaywalk {
namespace {
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
        std::uint8_t& worth =
            worth_[static_cast<std::size_t>(y) * static_cast<std::size_t>(map_.width) + static_cast<std::size_t>(x)];
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
