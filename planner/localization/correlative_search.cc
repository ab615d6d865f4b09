#include "planner/localization/correlative_search.h"

#include <algorithm>
#include <cmath>

namespace jaywalk {
namespace {
constexpr double kCoarseRad = 0.035;      // two degrees: a cell at 3 m; then half of it
constexpr std::size_t kCoarseStride = 3;  // of the points that are asked there
constexpr int kMostCells = 4;             // to each side; then half a cell
constexpr double kMostWindowRad = 0.42;
constexpr int kWallWorth = 48;  // of a point on a wall hit once, in EvidenceMap::kMax; on a certain one it is that
constexpr double kWindowSigmas = 3.0;
constexpr double kThreeSigmaPrice = 0.10;  // a pose three sigma out must put this share more on walls

int worth_of(const ScanReference& reference, CellIndex cell) {
  const int evidence = reference.map.evidence(cell);
  if (evidence == 0) return reference.unknown_worth;
  return evidence < 0 ? 0 : kWallWorth + evidence * (EvidenceMap::kMax - kWallWorth) / EvidenceMap::kMax;
}

/// What the coarse lattice's poses of one heading are worth: whole cells apart, so that each point is turned and put
/// into its cell once, and then looked up in the cells about it.
class WorthOfShifts {
 public:
  void add_up(const MatchSample& sample, const ScanReference& reference, const Pose2& pose, int reach) {
    sum_.fill(0);
    count_ = 0;
    const Transform2 to_map(pose);
    for (std::size_t k = 0; k < sample.size(); k += kCoarseStride, ++count_)
      add(reference, reference.map.cell_at(to_map * sample[k]), reach);
  }
  /// Of the pose moved by (x, y) cells: 0 to 1.
  [[nodiscard]] double share(int x, int y) const {
    return static_cast<double>(sum_[place(x, y)]) / (EvidenceMap::kMax * std::max(1, count_));
  }

 private:
  static constexpr int kSide = 2 * kMostCells + 1;
  static std::size_t place(int x, int y) { return static_cast<std::size_t>((y + kMostCells) * kSide + x + kMostCells); }
  void add(const ScanReference& reference, CellIndex cell, int reach) {
    for (int y = -reach; y <= reach; ++y) {
      for (int x = -reach; x <= reach; ++x) sum_[place(x, y)] += worth_of(reference, {cell.i + x, cell.j + y});
    }
  }

  std::array<int, static_cast<std::size_t>(kSide* kSide)> sum_{};
  int count_ = 0;
};

/// The search about one prediction. Offsets from it are in m and rad.
struct Search {
  const Pose2& predicted;
  const Eigen::Matrix3d& information;
  const MatchSample& sample;
  const ScanReference& reference;

  [[nodiscard]] double price(const Eigen::Vector3d& by) const {
    return kThreeSigmaPrice / 9.0 * by.dot(information * by);
  }

  /// Share of the points that lies on walls, each weighed by how sure the map is of the wall.
  [[nodiscard]] double share_on_walls(const Eigen::Vector3d& by) const {
    const Transform2 to_map(moved(predicted, by));
    int sum = 0;
    for (const Vec2& point : sample) sum += worth_of(reference, reference.map.cell_at(to_map * point));
    return static_cast<double>(sum) / (EvidenceMap::kMax * std::max(1, static_cast<int>(sample.size())));
  }

  /// The best offset of so many cells and headings (kCoarseRad) to each side.
  [[nodiscard]] Eigen::Vector3d best_cell(int cells, int headings) const {
    WorthOfShifts worth_of_shifts;
    Eigen::Vector3d best;
    double best_worth = -1e9;
    const double cell_m = reference.map.cell_m();
    for (int h = -headings; h <= headings; ++h) {
      worth_of_shifts.add_up(sample, reference, moved(predicted, {0.0, 0.0, h * kCoarseRad}), cells);
      for (int y = -cells; y <= cells; ++y) {
        for (int x = -cells; x <= cells; ++x) {
          const Eigen::Vector3d by(x * cell_m, y * cell_m, h * kCoarseRad);
          const double worth = worth_of_shifts.share(x, y) - price(by);
          if (worth > best_worth) best_worth = worth, best = by;
        }
      }
    }
    return best;
  }

  /// The best of the offsets half a step to each side of `centre`.
  [[nodiscard]] Eigen::Vector3d best_half_step(const Eigen::Vector3d& centre) const {
    Eigen::Vector3d best = centre;
    double best_worth = -1e9;
    const double half_m = 0.5 * reference.map.cell_m(), half_rad = 0.5 * kCoarseRad;
    for (int k = 0; k < 27; ++k) {
      const Eigen::Vector3d by(centre.x() + (k % 3 - 1) * half_m, centre.y() + (k / 3 % 3 - 1) * half_m,
                               centre.z() + (k / 9 - 1) * half_rad);
      const double worth = share_on_walls(by) - price(by);
      if (worth > best_worth) best_worth = worth, best = by;
    }
    return best;
  }
};

int steps(double variance, double most, double step) {
  return static_cast<int>(std::ceil(std::min(kWindowSigmas * std::sqrt(variance), most) / step));
}

constexpr std::int32_t kSideCells = 512;
constexpr double kCellM = 0.1;
constexpr double kKeyframeM = 0.4, kKeyframeRad = 0.3;
constexpr int kPointEvidence = 48;  // a wall to the search; two points are a certain one

}  // namespace

Pose2 correlative_search(const PoseBelief& predicted, const Eigen::Matrix3d& information, const MatchSample& sample,
                         const ScanReference& reference) noexcept {
  const Eigen::Matrix3d& p = predicted.covariance;
  const double cell_m = reference.map.cell_m();
  const Search search{predicted.map_from_robot, information, sample, reference};
  const Eigen::Vector3d valley = search.best_cell(steps(std::max(p(0, 0), p(1, 1)), kMostCells * cell_m, cell_m),
                                                  steps(p(2, 2), kMostWindowRad, kCoarseRad));
  return moved(predicted.map_from_robot, search.best_half_step(valley));
}

Submap::Submap() : map_(kSideCells, kCellM, {}), sum_at_(static_cast<std::size_t>(kSideCells) * kSideCells, 0) {}

void Submap::add(const MatchSample& in_robot, const Pose2& map_from_robot) noexcept {
  if (count_ > 0) {
    const Pose2& last = keyframes_[(count_ - 1) % kKeyframes].map_from_robot;
    const bool near = distance(last.position(), map_from_robot.position()) < kKeyframeM;
    if (near && std::fabs(wrap_angle(map_from_robot.heading - last.heading)) < kKeyframeRad) return;
  }
  keyframes_[count_++ % kKeyframes] = {map_from_robot, in_robot};
}

Submap::CellSum* Submap::sum_of(CellIndex cell) noexcept {
  if (!map_.contains(cell)) return nullptr;
  std::uint16_t& at = sum_at_[map_.slot(cell)];
  if (at == 0) {
    if (!sums_.push_back({.cell = cell})) return nullptr;  // there is room for all points of all keyframes
    at = static_cast<std::uint16_t>(sums_.size());
  }
  return &sums_[at - 1U];
}

void Submap::add_up(const Keyframe& keyframe) noexcept {
  const Vec2 laser = keyframe.map_from_robot.position();
  const Transform2 to_map(keyframe.map_from_robot);
  for (const Vec2& p : keyframe.in_robot) {
    const Vec2 at = to_map * p;
    CellSum* sum = sum_of(map_.cell_at(at));
    if (sum == nullptr) continue;
    sum->count += 1;
    sum->from_centre = sum->from_centre + (at - map_.centre_of(sum->cell));
    sum->to_laser = sum->to_laser + (laser - at) * (1.0 / std::max(kCellM, distance(laser, at)));
  }
}

const EvidenceMap& Submap::about(Vec2 centre) noexcept {
  for (const CellSum& sum : sums_) {
    sum_at_[map_.slot(sum.cell)] = 0;
    map_.forget(sum.cell);
  }
  sums_.clear();
  map_.roll_to(centre);
  for (std::size_t k = 0; k < std::min(count_, kKeyframes); ++k) add_up(keyframes_[k]);
  for (const CellSum& sum : sums_) {
    const double share = 1.0 / sum.count;
    map_.add_hit(map_.centre_of(sum.cell) + sum.from_centre * share, sum.count * kPointEvidence, 0.0,
                 sum.to_laser * share);
  }
  return map_;
}

}  // namespace jaywalk
