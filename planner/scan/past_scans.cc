#include "planner/scan/past_scans.h"

#include <algorithm>
#include <chrono>

#include "planner/scan/line_of_sight.h"

namespace jaywalk {
namespace {

constexpr Duration kSince = std::chrono::milliseconds(1000), kUntil = std::chrono::milliseconds(400);
constexpr Duration kApart = std::chrono::milliseconds(45);
constexpr double kNoise_m = 0.05, kNoiseShare = 0.012;  // of a range, as wide as poses and ranges are unsure

}  // namespace

void PastScans::keep(const LaserScan& scan, const Pose2& map_from_robot, const Pose2& robot_from_laser,
                     const Twist2& twist) noexcept {
  if (count_ > 0) {
    const LaserScan& last = (*kept_)[(count_ - 1) % kMost].scan;
    if (last.scanner == scan.scanner && scan.stamp >= last.stamp && scan.stamp - last.stamp < kApart) return;
  }
  (*kept_)[count_++ % kMost] = {scan, map_from_robot, robot_from_laser, twist};
}

std::optional<double> PastScans::seen_through(std::span<const Vec2> places, Time now) const noexcept {
  int through = 0, told = 0;
  for (std::size_t k = 0; k < std::min(count_, kMost); ++k) {
    const Kept& kept = (*kept_)[k];
    if (kept.scan.stamp > now - kUntil || kept.scan.stamp < now - kSince) continue;
    const LineOfSight sight(kept.scan, kept.map_from_robot, kept.robot_from_laser, kept.twist);
    const Vec2 laser = (kept.map_from_robot * kept.robot_from_laser).position();
    for (const Vec2& place : places) {
      const Sight seen = sight.at(place, kNoise_m + kNoiseShare * distance(laser, place));
      told += seen != Sight::kUnseen ? 1 : 0;
      through += seen == Sight::kThrough || seen == Sight::kEmpty ? 1 : 0;
    }
  }
  if (told == 0) return std::nullopt;
  return static_cast<double>(through) / told;
}

}  // namespace jaywalk
