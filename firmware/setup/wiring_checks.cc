#include "firmware/setup/wiring_checks.h"

#include <array>
#include <cmath>
#include <cstdio>
#include <optional>

#include "firmware/setup/scan_shift.h"

namespace jaywalk {
namespace {

constexpr double kTolerance = 0.1;     ///< of counts a turn
constexpr double kOffMount_rad = 0.2;  ///< 11 degrees: matched scans are good to five
constexpr double kLeastShare = 0.3;    ///< of the motion felt, or the robot did not move

const char* side_name(std::size_t side) { return side == 0 ? "left" : "right"; }

/// The motion of one wheel's nudges, felt and seen, as if it were forward.
struct SideMotion {
  double felt_m = 0.0;    ///< way of the rim
  double seen_rad = 0.0;  ///< turn, positive where the wheel's side should go forward
  Vec2 seen_way;          ///< of the middle, in the direction of half the turn
  bool matched = true;
};

SideMotion motion_of(const std::vector<Nudge>& nudges, std::size_t side, const RobotModel& model) {
  SideMotion sum;
  const Pose2& mount = model.laser.robot_from_laser;
  for (const Nudge& nudge : nudges) {
    if (nudge.side != side) continue;
    const double left = nudge.after.left_rad - nudge.before.left_rad;
    const double right = nudge.after.right_rad - nudge.before.right_rad;
    sum.felt_m += nudge.sign * model.drive.wheel_radius_m * (side == 0 ? left : right);
    const std::optional<ScanShift> shift = match_scans(nudge.scan_before, nudge.scan_after);
    sum.matched = sum.matched && shift.has_value();
    if (!shift) continue;
    const Pose2 moved = mount * shift->before_from_after * inverse(mount);
    sum.seen_rad += nudge.sign * (side == 0 ? -moved.heading : moved.heading);
    sum.seen_way = sum.seen_way + Transform2({0.0, 0.0, -0.5 * moved.heading}).rotate(moved.position()) * nudge.sign;
  }
  return sum;
}

WiringCheck check_feedback(const std::vector<Nudge>& nudges, std::size_t side, const DriveModel& drive) {
  const std::string part = std::string(side_name(side)) + " drive";
  bool tried = false;
  for (const Nudge& nudge : nudges) {
    if (nudge.side != side) continue;
    tried = true;
    const double left = nudge.sign * (nudge.after.left_rad - nudge.before.left_rad) * drive.wheel_radius_m;
    const double right = nudge.sign * (nudge.after.right_rad - nudge.before.right_rad) * drive.wheel_radius_m;
    const double own = side == 0 ? left : right, other = side == 0 ? right : left;
    if (std::fabs(other) > 0.02)
      return {part, false,
              "the other wheel's encoder turns as well; see that each drive has its own motor and encoder"};
    if (own < -0.005)
      return {part, false, "its encoder counts backwards; change two of the motor's wires or the encoder's direction"};
    if (nudge.disobeyed || own < 0.02)
      return {part, false, "its wheel does not turn as commanded; see to brake, motor, encoder and counts a turn"};
  }
  if (!tried) return {part, false, "not tried, after the first fault"};
  return {part, true, "turns as commanded, forward and back"};
}

/// Forward turn and forward way as they should be: +1, the other way round: -1, neither: 0.
struct Signs {
  int turn = 0, way = 0;
  constexpr bool operator==(const Signs&) const = default;
};

Signs signs_of(const SideMotion& seen, double track_m) {
  const auto sign = [](double is, double should) {
    return std::fabs(is) < kLeastShare * std::fabs(should) ? 0 : (is > 0.0) == (should > 0.0) ? 1 : -1;
  };
  return {sign(seen.seen_rad, seen.felt_m / track_m), sign(seen.seen_way.x, 0.5 * seen.felt_m)};
}

WiringCheck check_sides(const Signs& left, const Signs& right) {
  const std::string part = "wheels, scanner";
  constexpr Signs kWell{1, 1}, kMirrored{-1, 1}, kBackward{1, -1}, kReversed{-1, -1};
  if (left == kWell && right == kWell) return {part, true, "each wheel is on its side and turns as it says"};
  if (left == kReversed && right == kWell)
    return {part, false, "the left wheel goes backward when it says forward; change [drive] left_reversed"};
  if (left == kWell && right == kReversed)
    return {part, false, "the right wheel goes backward when it says forward; change [drive] right_reversed"};
  if (left == kMirrored && right == kMirrored)
    return {part, false,
            "left and right are exchanged: either the drives ([drive] left_node, right_node) or the scanner is upside "
            "down or counts its beams the other way round"};
  if (left == kReversed && right == kReversed)
    return {part, false,
            "forward is backward on both sides: either both wheels (change left_reversed and right_reversed), or the "
            "scanner is upside down and looks backward"};
  if (left == kBackward && right == kBackward)
    return {part, false,
            "it drives backward and turns as it should: either the scanner looks backward ([laser] mount), or the "
            "drives are exchanged and both reversed"};
  if (left.turn == 0 || right.turn == 0)
    return {part, false, "a wheel turns and the robot does not; see to grip, coupling and counts a turn"};
  return {part, false,
          "what the scans show fits no one mistake; see to left_reversed, right_reversed, nodes and mount"};
}

WiringCheck check_counts(const SideMotion& seen, std::size_t side, double track_m) {
  const double share = seen.seen_rad * track_m / seen.felt_m;
  char said[160];
  const bool well = std::fabs(share - 1.0) <= kTolerance;
  std::snprintf(said, sizeof said, "the scans show %.2f of the way that its encoder counts%s", share,
                well ? "" : "; correct its counts or turns a wheel turn, wheel_radius_m or track_width_m");
  return {std::string(side_name(side)) + " counts", well, said};
}

WiringCheck check_mount(const std::array<SideMotion, 2>& seen) {
  const Vec2 way = seen[0].seen_way + seen[1].seen_way;
  const double off = atan2(way.y, way.x);
  char said[120];
  const bool well = std::fabs(off) <= kOffMount_rad;
  std::snprintf(said, sizeof said, "the robot drives %.0f degrees beside where the scanner looks%s", off * 180.0 / kPi,
                well ? "" : "; correct [laser] mount");
  return {"scanner's mount", well, said};
}

}  // namespace

std::vector<WiringCheck> judge_nudges(const std::vector<Nudge>& nudges, const RobotModel& model) {
  std::vector<WiringCheck> checks{check_feedback(nudges, 0, model.drive), check_feedback(nudges, 1, model.drive)};
  if (!checks[0].is_well || !checks[1].is_well) return checks;
  const std::array seen{motion_of(nudges, 0, model), motion_of(nudges, 1, model)};
  if (!seen[0].matched || !seen[1].matched) {
    checks.push_back(
        {"scans", false, "do not tell the motion; go to where walls stand on two sides, and nothing moves"});
    return checks;
  }
  const double track_m = model.drive.track_width_m;
  checks.push_back(check_sides(signs_of(seen[0], track_m), signs_of(seen[1], track_m)));
  if (!checks.back().is_well) return checks;
  for (const std::size_t side : {0U, 1U}) checks.push_back(check_counts(seen[side], side, track_m));
  checks.push_back(check_mount(seen));
  return checks;
}

}  // namespace jaywalk
