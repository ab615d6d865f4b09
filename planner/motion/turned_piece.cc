#include "planner/motion/turned_piece.h"

#include <cmath>

#include "planner/motion/least_clearance.h"

namespace jaywalk {
namespace {

constexpr double kStep_rad = kPi / 24.0;

}  // namespace

void draw_turn(const BodyMap& map, const Pose2& from, double turn_rad, double margin_m, Manoeuvre& piece) noexcept {
  piece.clear();
  const double at_start = map.clearance(from), steps = std::floor(std::fabs(turn_rad) / kStep_rad);
  double room = at_start;
  for (double k = 0.0; k <= steps; k += 1.0) {
    const Pose2 pose{from.x, from.y, wrap_angle(from.heading + std::copysign(k * kStep_rad, turn_rad))};
    const double least = least_clearance_m(margin_m, at_start, room);
    room = map.clearance(pose);
    if (room < least || map.goes_unseen(pose.position(), direction(pose.heading))) break;
    (void)piece.push_back({pose, Gear::kTurn, room, 0.0});
  }
}

}  // namespace jaywalk
