#include "planner/motion/straight_piece.h"

#include <algorithm>
#include <cmath>

#include "planner/motion/least_clearance.h"

namespace jaywalk {
namespace {

constexpr double kStep_m = 0.1;

}  // namespace

void draw_straight(const BodyMap& map, const Pose2& from, double length_m, double margin_m, Manoeuvre& piece) noexcept {
  piece.clear();
  const double sign = length_m < 0.0 ? -1.0 : 1.0;
  const double room = map.clearance(from);
  for (double gone = 0.0; gone < std::fabs(length_m); gone += kStep_m) {
    const Vec2 place = from * Vec2{sign * gone, 0.0};
    const Pose2 pose{place.x, place.y, from.heading};
    if (map.clearance(pose) < least_clearance_m(margin_m, room, room)) break;
    (void)piece.push_back({pose, sign < 0.0 ? Gear::kBackward : Gear::kForward, room, 0.0});
  }
}

}  // namespace jaywalk
