#include "apps/formats/laser_mount.h"

#include <cmath>
#include <vector>

namespace jaywalk::exchange {
namespace {

constexpr double kSame = 1e-3;        // m, and of a direction's cosines
constexpr double kLevel = 0.985;      // cosine of 10 degrees
constexpr std::size_t kDeepest = 64;  // frames in one another: more is a circle

}  // namespace

void FrameTree::add(const TransformMessage& transform) {
  if (!transform.parent_from_child.matrix().allFinite()) return;
  const Edge edge{bare(transform.parent), transform.parent_from_child};
  const auto [known, is_new] = parents_.emplace(bare(transform.child), edge);
  if (is_new) return;
  const bool same = known->second.parent == edge.parent &&
                    known->second.parent_from_child.matrix().isApprox(edge.parent_from_child.matrix(), kSame);
  known->second.moves = known->second.moves || !same;
}

std::optional<SpatialFrame> FrameTree::find(const std::string& base, const std::string& frame) const {
  std::map<std::string, SpatialFrame> above_frame;  // ancestor_from_frame, and of the frame itself
  std::string at = bare(frame);
  SpatialFrame here_from_frame = SpatialFrame::Identity();
  for (std::size_t depth = 0; depth < kDeepest; ++depth) {
    above_frame.emplace(at, here_from_frame);
    const auto up = parents_.find(at);
    if (up == parents_.end() || up->second.moves) break;
    here_from_frame = up->second.parent_from_child * here_from_frame;
    at = up->second.parent;
  }
  at = bare(base);
  SpatialFrame here_from_base = SpatialFrame::Identity();
  for (std::size_t depth = 0; depth < kDeepest; ++depth) {
    if (const auto met = above_frame.find(at); met != above_frame.end()) return here_from_base.inverse() * met->second;
    const auto up = parents_.find(at);
    if (up == parents_.end() || up->second.moves) return std::nullopt;
    here_from_base = up->second.parent_from_child * here_from_base;
    at = up->second.parent;
  }
  return std::nullopt;
}

std::optional<LaserMount> level_mount(const SpatialFrame& base_from_laser) {
  const double up = base_from_laser.linear()(2, 2);
  if (!(std::fabs(up) >= kLevel)) return std::nullopt;
  const Eigen::Vector3d at = base_from_laser.translation();
  return LaserMount{{at.x(), at.y(), heading_of(base_from_laser)}, up < 0.0};
}

}  // namespace jaywalk::exchange
