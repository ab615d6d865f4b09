#include "apps/view/shown_stop_zone.h"

#include <algorithm>

#include "firmware/safety/reaction.h"
#include "firmware/safety/zone_check.h"

namespace jaywalk::view {
namespace {

constexpr double kStands_mps = 1e-3;

}  // namespace

ShownStopZone::ShownStopZone(const RobotModel& model, Duration tick)
    : model_(model), tick_(tick), zone_(stop_zone_for(model, tick)) {}

ShownStopZone::Outlines ShownStopZone::at(const TickRecord& t) const noexcept {
  const Twist2& twist = t.verdict.permitted;
  const double rim_mps = zone_.rim_speed_mps(twist), margin_m = zone_.margin_at(rim_mps);
  const double reaction = reaction_s(t.scans(), model_, t.now, tick_, t.latency);
  const bool stands = rim_mps < kStands_mps;
  const SweptPath way(stands ? Twist2{} : twist, std::max(rim_mps, kStands_mps),
                      stands ? 0.0 : zone_.stopping_distance_m(rim_mps, reaction));
  const Footprint& body = model_.footprint;
  const double front = body.front_m + margin_m, rear = -body.rear_m - margin_m, side = body.half_width_m + margin_m;
  const Transform2 map_from_robot(t.pose.map_from_robot);
  Outlines outlines;
  const std::size_t parts = stands ? 1 : outlines.capacity();
  for (std::size_t part = 1; part <= parts; ++part) {
    const std::size_t k = way.steps() * part / parts;
    const auto corner = [&](double x, double y) { return map_from_robot * way.place_of(k, {x, y}); };
    static_cast<void>(
        outlines.push_back({corner(front, side), corner(front, -side), corner(rear, -side), corner(rear, side)}));
  }
  return outlines;
}

}  // namespace jaywalk::view
