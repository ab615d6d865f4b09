#include "apps/why/why_words.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "apps/why/why_decision.h"
#include "drivers/drive_fault_words.h"
#include "hal/shown_text.h"

namespace jaywalk {
namespace {

constexpr double kDegPerRad = 180.0 / kPi;
constexpr double kLookAhead_s = 5.0;

std::string side(double rad) {
  const double degrees = std::fabs(rad) * kDegPerRad;
  return degrees < 5.0 ? "straight ahead" : formatted("%.0f degrees to the %s", degrees, rad > 0.0 ? "left" : "right");
}

/// Where a track is nearest to the robot's middle if both go on as they do: a robot on a bend is stepped along it.
struct Meeting {
  double gap_m = 0.0, at_s = 0.0;
};
Meeting nearest(const Track& track, const Pose2& from, const Twist2& twist) {
  Meeting best{1e9, 0.0};
  for (double t = 0.0; t <= kLookAhead_s; t += 0.1) {
    const double turned = twist.w_radps * t;
    const Vec2 along = direction(from.heading + 0.5 * turned);
    const Vec2 robot = from.position() + along * (twist.v_mps * t);
    const double gap = distance(robot, track.position_in_map + track.velocity_in_map * t) - track.radius_m;
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
const Track* first_met(std::span<const Track> tracks, const Pose2& from, const Twist2& twist) {
  const Track* met = nullptr;
  for (const Track& track : tracks) {
    if (!track.moving) continue;
    if (met == nullptr || nearest(track, from, twist).gap_m < nearest(*met, from, twist).gap_m) met = &track;
  }
  return met;
}

std::string expected(const TickRecord& t, std::span<const Track> tracks) {
  const Pose2& here = t.pose.map_from_robot;
  const Track* met = first_met(tracks, here, t.verdict.permitted);
  if (met == nullptr) return "It expected: nobody who walks.\n";
  const Meeting meeting = nearest(*met, here, t.verdict.permitted);
  const Vec2 off = met->position_in_map - here.position();
  return formatted(
      "It expected: body %u, %.1f m off, %s, walks %.2f m/s; as both go now it comes to %.2f m of the robot's middle "
      "in %.1f s.\n",
      met->id, norm(off), side(wrap_angle(std::atan2(off.y, off.x) - here.heading)).c_str(), norm(met->velocity_in_map),
      meeting.gap_m, meeting.at_s);
}

std::string wanted(const TickRecord& t, const ControlLoop& loop) {
  std::string words = formatted("It wanted: %.2f m/s and to turn %.2f rad/s", t.wanted.v_mps, t.wanted.w_radps);
  if (!t.input.has_goal) return words + "; it has no goal.\n";
  if (const motion::GoalRollouts* motion = loop.motion().rollouts(); motion && motion->decision().at != kNever) {
    const motion::Decision& decision = motion->decision();
    words += std::string(", to ") + name_of(decision.trajectory.proposal) + "; it counted " + in_words(decision.cost);
  }
  return words + ".\n";
}

std::string permitted(const TickRecord& t) {
  const Twist2& p = t.verdict.permitted;
  if (t.verdict.reasons == Reason::kNone) return "It was permitted: all of that.\n";
  return formatted("It was permitted: %.2f m/s and %.2f rad/s, because ", p.v_mps, p.w_radps) +
         in_words(t.verdict.reasons) + (t.wheels.fault.is_told() ? "; " + describe(t.wheels.fault) : "") + ".\n";
}

std::string otherwise(const TickRecord& t, std::span<const Track> tracks, const RobotModel& model) {
  const double braking_m = t.wanted.v_mps * t.wanted.v_mps / (2.0 * model.limits.brake_mps2);
  if (has(t.verdict.reasons, Reason::kStopZone) && std::isfinite(t.verdict.gap_m))
    return formatted("Otherwise: at %.2f m/s it needs %.2f m to brake, and %.2f m are free.\n",
                     std::fabs(t.wanted.v_mps), braking_m, t.verdict.gap_m);
  const Twist2 on{model.limits.max_speed_mps, 0.0};
  const Track* met = first_met(tracks, t.pose.map_from_robot, on);
  if (met == nullptr) return "Otherwise: nobody would have been met.\n";
  const Meeting meeting = nearest(*met, t.pose.map_from_robot, on);
  return formatted("Otherwise: straight on at %.2f m/s body %u would have come to %.2f m of its middle in %.1f s.\n",
                   on.v_mps, met->id, meeting.gap_m, meeting.at_s);
}

}  // namespace

std::string in_words(Reason reasons) {
  std::string words;
  for (const ReasonRow& row : kReasons)
    if (has(reasons, row.reason)) words += (words.empty() ? "" : "; ") + std::string(row.says);
  return words;
}

std::string why_words(const TickRecord& tick, const ControlLoop& loop, const RobotModel& model) {
  const auto tracks = loop.tracker().tracks();
  const std::span<const Track> all(tracks.begin(), tracks.size());
  return doing(tick, model.drive) + saw(tick, all) + expected(tick, all) + wanted(tick, loop) + permitted(tick) +
         otherwise(tick, all, model);
}

}  // namespace jaywalk
