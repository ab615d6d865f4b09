#include <algorithm>
#include <cmath>

#include "apps/why/why.h"
#include "drivers/wired_drive.h"
#include "hal/shown_text.h"

namespace jaywalk {
namespace {

constexpr double kDegPerRad = 180.0 / kPi;
constexpr double kLookAhead_s = 5.0;

std::string side(double rad) {
  const double degrees = std::fabs(rad) * kDegPerRad;
  return degrees < 5.0 ? "straight ahead" : formatted("%.0f degrees to the %s", degrees, rad > 0.0 ? "left" : "right");
}

/// Where a track is nearest to the robot's outline if both go on as they do: a robot on a bend is stepped along it.
struct Meeting {
  double gap_m = 0.0, at_s = 0.0;
};
Meeting nearest(const Track& track, const Pose2& from, const Twist2& twist, const Footprint& footprint) {
  Meeting best{1e9, 0.0};
  for (double t = 0.0; t <= kLookAhead_s; t += 0.1) {
    const double turned = twist.w_radps * t;
    const Vec2 along = direction(from.heading + 0.5 * turned);
    const Vec2 robot = from.position() + along * (twist.v_mps * t);
    const Transform2 robot_from_map = Transform2(inverse(Pose2{robot.x, robot.y, from.heading + turned}));
    const Vec2 then = track.position_in_map + track.velocity_in_map * t;
    const double gap = footprint.distance_to(robot_from_map * then) - track.radius_m;
    if (gap < best.gap_m) best = {gap, t};
  }
  return best;
}

std::string doing(const TickRecord& t, const DriveModel& drive) {
  const Pose2& p = t.pose.map_from_robot;
  const double v = 0.5 * drive.wheel_radius_m * (t.wheels.left_radps + t.wheels.right_radps);
  return formatted("At %.2f s the robot is at %.2f, %.2f m, heading %.0f degrees, and drives %.2f m/s.\n",
                   to_seconds(t.now), p.x, p.y, p.heading * kDegPerRad, v);
}

std::string saw(const LaserScan& scan) {
  std::size_t hits = 0, nearest = 0;
  for (std::size_t k = 0; k < scan.beam_count; ++k) {
    if (!scan.is_hit(k)) continue;
    if (hits++ == 0 || scan.range_m[k] < scan.range_m[nearest]) nearest = k;
  }
  std::string words = formatted("%zu of %u beams hit something", hits, scan.beam_count);
  if (hits > 0)
    words += formatted(", the nearest %.2f m off, %s of the laser", static_cast<double>(scan.range_m[nearest]),
                       side(scan.angle_rad(nearest)).c_str());
  return words;
}

std::string saw(const TickRecord& t, std::span<const Track> tracks) {
  const auto moving = std::count_if(tracks.begin(), tracks.end(), [](const Track& track) { return track.moving; });
  std::string words = "It saw: " + saw(t.scan);
  for (const LaserScan& scan : t.other_scans) words += formatted("; by scanner %d ", scan.scanner + 1) + saw(scan);
  return words + formatted("; it followed %zu bodies, %d of them moving.\n", tracks.size(), static_cast<int>(moving));
}

/// The mover that comes nearest if everybody goes on at these speeds.
const Track* first_met(std::span<const Track> tracks, const Pose2& from, const Twist2& twist,
                       const Footprint& footprint) {
  const Track* met = nullptr;
  double least_m = 0.0;
  for (const Track& track : tracks) {
    if (!track.moving) continue;
    const double gap_m = nearest(track, from, twist, footprint).gap_m;
    if (met == nullptr || gap_m < least_m) met = &track, least_m = gap_m;
  }
  return met;
}

std::string in_words(const Meeting& meeting) {
  if (meeting.at_s == 0.0) return meeting.gap_m > 0.0 ? "comes no nearer" : "is beside the robot already";
  return (meeting.gap_m > 0.0 ? formatted("comes to %.1f m of the robot", meeting.gap_m) : "runs into the robot") +
         formatted(" in %.1f s", meeting.at_s);
}

std::string expected(const TickRecord& t, const BodiesAbout& around) {
  const Pose2& here = t.pose.map_from_robot;
  const Track* met = first_met(around.tracks, here, t.verdict.permitted, around.footprint);
  if (met == nullptr) return "It expected: nobody who walks.\n";
  const Vec2 off = met->position_in_map - here.position();
  return formatted("It expected: body %u, %.1f m off, %s, walks %.2f m/s; as both go now it %s.\n", met->id, norm(off),
                   side(wrap_angle(std::atan2(off.y, off.x) - here.heading)).c_str(), norm(met->velocity_in_map),
                   in_words(nearest(*met, here, t.verdict.permitted, around.footprint)).c_str());
}

std::string wanted(const TickRecord& t, const ControlLoop& loop, const Weighed& weighed, const BodiesAbout& around) {
  std::string words = formatted("It wanted: %.2f m/s and to turn %.2f rad/s", t.wanted.v_mps, t.wanted.w_radps);
  if (!t.input.has_goal) return words + "; it has no goal.\n";
  if (!weighed.alternatives.empty())
    words += ", " + chosen_in_words(*loop.motion().rollouts(), weighed.resolve, around);
  return words + ".\n";
}

std::string permitted(const TickRecord& t) {
  const Twist2& p = t.verdict.permitted;
  if (t.verdict.reasons == Reason::kNone) return "It was permitted: all of that.\n";
  return formatted("It was permitted: %.2f m/s and %.2f rad/s, because ", p.v_mps, p.w_radps) +
         in_words(t.verdict.reasons) + (t.wheels.fault.is_told() ? "; " + describe(t.wheels.fault) : "") + ".\n";
}

std::string otherwise(const TickRecord& t, const ControlLoop& loop, const RobotModel& model, const Weighed& weighed,
                      const BodiesAbout& around) {
  const double braking_m = t.wanted.v_mps * t.wanted.v_mps / (2.0 * model.limits.brake_mps2);
  if (has(t.verdict.reasons, Reason::kStopZone) && std::isfinite(t.verdict.gap_m))
    return formatted("Otherwise: at %.2f m/s it needs %.2f m to brake, and %.2f m are free.\n",
                     std::fabs(t.wanted.v_mps), braking_m, t.verdict.gap_m);
  const std::string next =
      t.input.has_goal && !weighed.alternatives.empty()
          ? next_best_in_words(*loop.motion().rollouts(), weighed.resolve, weighed.alternatives, around)
          : "";
  return "Otherwise: " + (next.empty() ? "nothing else was weighed" : next) + ".\n";
}

}  // namespace

std::string in_words(Reason reasons) {
  std::string words;
  for (const ReasonRow& row : kReasons)
    if (has(reasons, row.reason)) words += (words.empty() ? "" : "; ") + std::string(row.says);
  return words;
}

std::string why_words(const TickRecord& tick, const ControlLoop& loop, const RobotModel& model,
                      const Weighed& weighed) {
  const auto tracks = loop.tracker().tracks();
  const BodiesAbout around{{tracks.begin(), tracks.size()}, model.footprint};
  return doing(tick, model.drive) + saw(tick, around.tracks) + expected(tick, around) +
         wanted(tick, loop, weighed, around) + permitted(tick) + otherwise(tick, loop, model, weighed, around);
}

}  // namespace jaywalk
