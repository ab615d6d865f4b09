#include "planner/motion/near_returns.h"

#include <algorithm>
#include <cmath>

namespace jaywalk::motion {
namespace {

using Rules = StopZoneRules<float>;
constexpr float kEdgeM = 0.01F;  ///< a range's noise
constexpr float kNearerM =
    2e-4F;  ///< less is no approach: StopZone's, and single precision a kilometre from the origin

bool is_of_a_mover(Vec2 place, std::span<const MoverDisc> movers) {
  return std::any_of(movers.begin(), movers.end(),
                     [&](const MoverDisc& m) { return distance(place, m.centre_in_map) < m.radius_m + kOwnBody_m; });
}

/// The gap from the body at `robot` to a place in the map.
float gap_to(const RobotState& robot, const cell::Heading& along, const RobotBody& body, float x, float y) {
  const float dx = x - robot.x, dy = y - robot.y;
  return body.gap(dx * along.x + dy * along.y, dy * along.x - dx * along.y);
}

}  // namespace

void NearReturns::update(const OfEach<SeenFrom>& scans, const RobotState& robot, const RobotBody& body,
                         std::span<const MoverDisc> movers, std::span<const Vec2> unseen_walls) noexcept {
  const float reach_m = Rules::kMargin_m + kForS * (body.bounds.speed + body.bounds.turn * body.rim_m);
  const cell::Heading along = cell::heading_at(robot.heading);
  float nearest[kSectors];
  std::fill(nearest, nearest + kSectors, reach_m + body.rim_m);
  Vec2 hit[kSectors];
  const auto take = [&](Vec2 p) {
    const float dx = static_cast<float>(p.x) - robot.x, dy = static_cast<float>(p.y) - robot.y;
    const float away = std::sqrt(dx * dx + dy * dy);
    const float turns = 0.5F + cell::angle_of(dx, dy) / (2.0F * cell::kPiF);
    const auto sector = std::min(static_cast<std::size_t>(turns * static_cast<float>(kSectors)), kSectors - 1);
    if (away < nearest[sector] && !is_of_a_mover(p, movers)) nearest[sector] = away, hit[sector] = p;
  };
  for (const SeenFrom& seen : scans) {
    const LaserScan& scan = *seen.scan;
    const Transform2 map_from(seen.map_from_laser);
    for (std::size_t beam = 0; beam < scan.beam_count; ++beam) {
      if (!scan.is_hit(beam) || scan.range_m[beam] > 2.0F * (reach_m + body.rim_m)) continue;
      take(map_from * (direction(scan.angle_rad(beam)) * static_cast<double>(scan.range_m[beam])));
    }
  }
  for (const Vec2 p : unseen_walls) take(p);
  count_ = 0, nearest_ = Rules::kBeside_m;
  for (std::size_t k = 0; k < kSectors; ++k) {
    if (nearest[k] >= reach_m + body.rim_m) continue;
    x_[count_] = static_cast<float>(hit[k].x), y_[count_] = static_cast<float>(hit[k].y);
    gap_[count_] = gap_to(robot, along, body, x_[count_], y_[count_]) - kNearerM;
    nearest_ = std::min(nearest_, gap_[count_]);
    ++count_;
  }
}

float NearReturns::braked_share(const RobotState& robot, const RobotBody& body) const noexcept {
  const cell::Heading along = cell::heading_at(robot.heading);
  float least = Rules::kMargin_m + kEdgeM;
  for (std::size_t k = 0; k < count_; ++k) {
    const float gap = gap_to(robot, along, body, x_[k], y_[k]);
    least = gap < gap_[k] && gap < least ? gap : least;
  }
  if (least >= Rules::kMargin_m + kEdgeM) return 0.0F;
  const float rim = std::fabs(robot.v) + std::fabs(robot.w) * body.rim_m,
              creep = is_beside() && least > nearest_ - Rules::kSwing_m ? Rules::kCreep_mps : 0.0F,
              may = std::max(Rules::permitted_rim(least - kEdgeM), creep);
  return rim > may ? 1.0F - may / rim : 0.0F;
}

}  // namespace jaywalk::motion
