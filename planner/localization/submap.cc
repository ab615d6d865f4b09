#include "planner/localization/submap.h"

#include <algorithm>
#include <cmath>

namespace jaywalk {
namespace {

constexpr std::int32_t kSideCells = 512;
constexpr double kCellM = 0.1;
constexpr double kKeyframeM = 0.4, kKeyframeRad = 0.3;
constexpr int kPointEvidence = 48;  // a wall to the search; two points are a certain one

}  // namespace

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
