#include "planner/localization/track_mask.h"

#include <algorithm>

namespace jaywalk {
namespace {

constexpr double kBesideM = 0.2;         // a swinging arm or leg, and where the track may be off
constexpr double kLongestAheadS = 0.25;  // a track that is older than two scans says little of where it is

void leave_out(Vec2 centre_in_robot, double radius_m, ScanPoints& points) {
  std::size_t kept = 0;
  for (std::size_t k = 0; k < points.size(); ++k) {
    const Vec2 off = points[k].in_robot - centre_in_robot;
    if (dot(off, off) > radius_m * radius_m) points[kept++] = points[k];
  }
  points.truncate(kept);
}

}  // namespace

void mask_moving_tracks(std::span<const Track> moving, const Pose2& map_from_robot, Time stamp,
                        ScanPoints& points) noexcept {
  const Pose2 robot_from_map = inverse(map_from_robot);
  for (const Track& walker : moving) {
    const double ahead_s = std::clamp(to_seconds(stamp - walker.stamp), 0.0, kLongestAheadS);
    leave_out(robot_from_map * (walker.position_in_map + walker.velocity_in_map * ahead_s), walker.radius_m + kBesideM,
              points);
  }
}

}  // namespace jaywalk
