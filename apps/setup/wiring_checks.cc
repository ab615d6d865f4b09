#include <array>
#include <cmath>
#include <cstdlib>
#include <optional>

#include "apps/setup/scan_surfels.h"
#include "apps/setup/watched_drive.h"
#include "hal/shown_text.h"

namespace jaywalk {
namespace {

constexpr double kTolerance = 0.1;   ///< of counts a turn
constexpr double kLeastShare = 0.3;  ///< of the turn felt, or the robot did not move
constexpr double kClearly = 0.9;     ///< a misfit that is less than this of another
constexpr int kOffMountSteps = 3;    ///< of 5 degrees
constexpr int kOffAxleSteps = 3;     ///< of 5 cm

const char* side_name(std::size_t side) { return side == 0 ? "left" : "right"; }

/// The motion of one wheel's nudges, felt and seen, as if it were forward.
struct SideMotion {
  double felt_m = 0.0;    ///< way of the rim
  double seen_rad = 0.0;  ///< turn, positive where the wheel's side should go forward
  bool matched = true;
  double forward_misfit_m = 0.0, backward_misfit_m = 0.0;  ///< of the scans, had the middle gone so with that turn
};

/// The way that the wheel on `side` rolled forward.
double felt_m(const Nudge& nudge, std::size_t side, const DriveModel& drive) {
  const double left = nudge.after.left_rad - nudge.before.left_rad;
  const double right = nudge.after.right_rad - nudge.before.right_rad;
  return drive.wheel_radius_m * (side == 0 ? left : right);
}

/// The middle goes half of the wheel's way, in the direction of half the turn.
double misfit_with(const Nudge& nudge, std::size_t scanner, double turn_rad, double way_m, const Pose2& mount) {
  const Vec2 way = direction(0.5 * turn_rad) * way_m;
  return misfit_m(nudge.scans_before[scanner], nudge.scans_after[scanner],
                  inverse(mount) * Pose2{way.x, way.y, turn_rad} * mount);
}

SideMotion motion_of(const std::vector<Nudge>& nudges, std::size_t side, const RobotModel& model, std::size_t scanner) {
  SideMotion sum;
  const Pose2& mount = model.lasers()[scanner].robot_from_laser;
  for (const Nudge& nudge : nudges) {
    if (nudge.side != side) continue;
    const double felt = felt_m(nudge, side, model.drive);
    sum.felt_m += nudge.sign * felt;
    const std::optional<Pose2> shift = match_scans(nudge.scans_before[scanner], nudge.scans_after[scanner]);
    sum.matched = sum.matched && shift.has_value();
    if (!shift) continue;
    const double turn = shift->heading;
    sum.seen_rad += nudge.sign * (side == 0 ? -turn : turn);
    sum.forward_misfit_m += misfit_with(nudge, scanner, turn, 0.5 * felt, mount);
    sum.backward_misfit_m += misfit_with(nudge, scanner, turn, -0.5 * felt, mount);
  }
  return sum;
}

CheckedPart check_feedback(const std::vector<Nudge>& nudges, std::size_t side, const DriveModel& drive) {
  const std::string part = std::string(side_name(side)) + " drive";
  bool tried = false;
  for (const Nudge& nudge : nudges) {
    if (nudge.side != side) continue;
    tried = true;
    const double own = nudge.sign * felt_m(nudge, side, drive);
    if (std::fabs(felt_m(nudge, 1 - side, drive)) > 0.02)
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

/// Against what staleness, obedience and stop zone reckon with.
CheckedPart check_response(double measured_s, const DriveTimes& times) {
  const bool well = measured_s <= times.obeyed_within_s();
  const std::string said =
      formatted("the feedback follows commands by %.2f s", measured_s) +
      (well
           ? ""
           : formatted(", more than %.2f; write response_ms = %.0f in [drive], or have the drives ramp and filter less",
                       times.obeyed_within_s(), 1e3 * measured_s));
  return {"response", well, said};
}

/// Forward turn and forward way as they should be: +1, the other way round: -1, neither: 0.
struct Signs {
  int turn = 0, way = 0;
  constexpr bool operator==(const Signs&) const = default;
};

Signs signs_of(const SideMotion& seen, double track_m) {
  Signs signs;
  if (std::fabs(seen.seen_rad) >= kLeastShare * std::fabs(seen.felt_m) / track_m)
    signs.turn = (seen.seen_rad > 0.0) == (seen.felt_m > 0.0) ? 1 : -1;
  if (seen.forward_misfit_m < kClearly * seen.backward_misfit_m) signs.way = 1;
  if (seen.backward_misfit_m < kClearly * seen.forward_misfit_m) signs.way = -1;
  return signs;
}

constexpr Signs kWell{1, 1}, kMirrored{-1, 1}, kBackward{1, -1}, kReversed{-1, -1};

struct Miswiring {
  Signs left, right;
  const char* said;
};
constexpr Miswiring kMiswirings[] = {
    {kReversed, kWell, "the left wheel goes backward when it says forward; change [drive] left_reversed"},
    {kWell, kReversed, "the right wheel goes backward when it says forward; change [drive] right_reversed"},
    {kMirrored, kMirrored,
     "left and right are exchanged: either the drives ([drive] left_node, right_node) or the scanner is upside "
     "down or counts its beams the other way round"},
    {kReversed, kReversed,
     "forward is backward on both sides: either both wheels (change left_reversed and right_reversed), or the "
     "scanner is upside down and looks backward"},
    {kBackward, kBackward,
     "it drives backward and turns as it should: either the scanner looks backward ([laser] mount), or the "
     "drives are exchanged and both reversed"},
};

CheckedPart check_sides(const Signs& left, const Signs& right) {
  const std::string part = "wheels, scanner";
  if (left == kWell && right == kWell) return {part, true, "each wheel is on its side and turns as it says"};
  for (const Miswiring& each : kMiswirings)
    if (left == each.left && right == each.right) return {part, false, each.said};
  if (left.turn == 0 || right.turn == 0)
    return {part, false, "a wheel turns and the robot does not; see to grip, coupling and counts a turn"};
  if (left.way == 0 || right.way == 0)
    return {
        part, false,
        "the scans show the turns, but not which way it went; go to where walls stand ahead and beside, then again"};
  return {part, false,
          "what the scans show fits no one mistake; see to left_reversed, right_reversed, nodes and mount"};
}

CheckedPart check_counts(const SideMotion& seen, std::size_t side, double track_m) {
  const double share = seen.seen_rad * track_m / seen.felt_m;
  const bool well = std::fabs(share - 1.0) <= kTolerance;
  const std::string said =
      formatted("the scans show %.2f of the way that its encoder counts%s", share,
                well ? "" : "; correct its counts or turns a wheel turn, wheel_radius_m or track_width_m");
  return {std::string(side_name(side)) + " counts", well, said};
}

/// Misfit of all nudges, m, as the wheels have them, with the scanner at `mount`.
double misfit_at(const std::vector<Nudge>& nudges, const DriveModel& drive, std::size_t scanner, const Pose2& mount) {
  double sum_m = 0.0;
  for (const Nudge& nudge : nudges) {
    const double felt = felt_m(nudge, nudge.side, drive);
    const double turn = (nudge.side == 0 ? -felt : felt) / drive.track_width_m;
    sum_m += misfit_with(nudge, scanner, turn, 0.5 * felt, mount);
  }
  return sum_m;
}

/// A step off the file's mount, and the misfit there.
struct MountStep {
  int step = 0;
  double misfit_m = 0.0;
};

/// The step from -`steps` to `steps` that explains the scans best; 0 where none does so clearly.
template <class MountAt>
MountStep best_step(int steps, const std::vector<Nudge>& nudges, const DriveModel& drive, std::size_t scanner,
                    const MountAt& mount_at) {
  const MountStep at_file{0, misfit_at(nudges, drive, scanner, mount_at(0))};
  MountStep best = at_file;
  for (int k = -steps; k <= steps; ++k) {
    const double sum_m = misfit_at(nudges, drive, scanner, mount_at(k));
    if (sum_m < best.misfit_m) best = {k, sum_m};
  }
  return best.misfit_m > kClearly * at_file.misfit_m ? at_file : best;
}

/// The scanner's heading, or its place ahead of the axle, that explains the scans better than the file's. The robot
/// turns about the axle's middle: a frame elsewhere shows as a scanner elsewhere. Returns that it lies elsewhere, too.
std::pair<CheckedPart, bool> check_mount(const std::vector<Nudge>& nudges, const RobotModel& model,
                                         std::size_t scanner) {
  const Pose2& file = model.lasers()[scanner].robot_from_laser;
  const MountStep turned = best_step(9, nudges, model.drive, scanner, [&](int k) {  // to 45 degrees either way
    return Pose2{file.x, file.y, wrap_angle(file.heading + k * 5.0 * kPi / 180.0)};
  });
  const MountStep ahead = best_step(12, nudges, model.drive, scanner, [&](int k) {  // to 0.6 m
    return Pose2{file.x + 0.05 * k, file.y, file.heading};
  });
  const bool is_turned = std::abs(turned.step) >= kOffMountSteps && turned.misfit_m <= ahead.misfit_m;
  const bool is_off = !is_turned && std::abs(ahead.step) >= kOffAxleSteps;
  const std::string said =
      is_turned ? formatted("it is turned by about %d degrees more than the file says; correct [laser] mount",
                            5 * turned.step)
      : is_off  ? formatted(
                      "it lies about %.2f m farther %s the drive axle than the file says; correct [laser] mount, "
                       "whose x begins at the axle",
                      0.05 * std::abs(ahead.step), ahead.step > 0 ? "ahead of" : "behind")
               : formatted("it is where the file says, as far as %d degrees and %.2f m can be told", 5 * kOffMountSteps,
                           0.05 * kOffAxleSteps);
  return {{"scanner's mount", !is_turned && !is_off, said}, is_off};
}

/// What one scanner's scans show.
std::vector<CheckedPart> judge_scans(const std::vector<Nudge>& nudges, const RobotModel& model, std::size_t scanner) {
  const std::array seen{motion_of(nudges, 0, model, scanner), motion_of(nudges, 1, model, scanner)};
  if (!seen[0].matched || !seen[1].matched)
    return {{"scans", false, "do not tell the motion; go to where walls stand on two sides, and nothing moves"}};
  const double track_m = model.drive.track_width_m;
  const Signs left = signs_of(seen[0], track_m), right = signs_of(seen[1], track_m);
  std::vector<CheckedPart> checks{check_sides(left, right)};
  if (!checks.back().is_well) {
    const bool way_alone = left.turn == 1 && right.turn == 1 && left.way + right.way > -2;  // a wrong place hides it
    const auto [mount, is_off_axle] = check_mount(nudges, model, scanner);
    return way_alone && is_off_axle ? std::vector{mount} : checks;
  }
  for (const std::size_t side : {0U, 1U}) checks.push_back(check_counts(seen[side], side, track_m));
  checks.push_back(check_mount(nudges, model, scanner).first);
  return checks;
}

}  // namespace

std::vector<CheckedPart> judge_nudges(const std::vector<Nudge>& nudges, const RobotModel& model) {
  std::vector<CheckedPart> checks{check_feedback(nudges, 0, model.drive), check_feedback(nudges, 1, model.drive)};
  if (!checks[0].is_well || !checks[1].is_well) return checks;
  checks.push_back(check_response(nudges.back().response_s, model.drive.times));
  for (std::size_t k = 0; k < model.lasers().size(); ++k) {
    const std::string name = scanner_name(model, k), before = name.empty() ? "" : name + " scanner: ";
    for (CheckedPart& check : judge_scans(nudges, model, k))
      checks.push_back({before + check.part, check.is_well, check.said});
  }
  return checks;
}

}  // namespace jaywalk
