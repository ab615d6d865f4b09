#pragma once
// Ticks whose every field differs from every other's, and a comparison of all their bits.
#include <algorithm>
#include <bit>
#include <cstdint>
#include <limits>
#include <vector>

#include "firmware/recording/tick_record.h"

namespace jaywalk {

/// A NaN with a payload of its own: 0x7FC00000 is the plain one.
inline constexpr std::uint32_t kOddNan = 0x7FA5A5A5;

/// Tick `n` at 20 ms a tick; a new scan every third, a new fix every fifth tick.
inline void fill(TickRecord& r, std::uint32_t n) {
  const double x = 0.1 * (1 + static_cast<double>(n));
  r.scan.stamp = Time{Duration{1000 + n / 3}};
  r.scan.sequence = 1 + n / 3;
  r.scan.beam_count = 5;
  r.scan.first_angle_rad = -1.5F;
  r.scan.angle_step_rad = 0.25F;
  r.scan.range_min_m = 0.02F;
  r.scan.range_max_m = 25.0F;
  r.scan.sweep = Duration{7};
  r.scan.period = Duration{8};
  r.scan.range_m[0] = static_cast<float>(1 + n / 3);
  r.scan.range_m[1] = std::bit_cast<float>(kOddNan);
  r.scan.range_m[2] = std::numeric_limits<float>::infinity();
  r.scan.range_m[3] = -0.0F;
  r.scan.range_m[4] = std::numeric_limits<float>::denorm_min();
  r.wheels = {
      Time{Duration{11}}, n + 1, x, x * 2, x * 3, x * 4, DriveTrouble::kDriveSilent, {DriveFaultKind::kVesc, 23, n},
      StopStage::kSilent, false};
  r.input = {Time{Duration{12}}, true, {x * 5, x * 6},   x * 7, x * 18, x * 19, n % 2 == 1,
             n % 2 == 0,         true, {x * 20, -x * 21}};
  if (n % 7 == 3) r.input.goal_heading_rad = kAnyHeading;
  r.fix.stamp = Time{Duration{13}};
  r.fix.sequence = 1 + n / 5;
  r.fix.has_pose = true;
  r.fix.map_from_robot = {1.0, 2.0, 3.0};
  r.fix.position_std_m = 0.25;
  r.fix.heading_std_rad = 0.5;
  r.fix.mover_std_m = 0.75;
  for (std::uint32_t i = 0; i < n / 5 % 3; ++i) {
    static_cast<void>(r.fix.movers.push_back({i + n / 5, {1.5 * i, 2.5 * i}, 0.125}));
  }
  r.pose = {Time{Duration{14}}, {x * 8, x * 9, -x}, x * 10, x * 11};
  r.plan_asked = n % 3 == 0;
  r.plan_sequence = n + 2;
  r.plan_stamp = Time{Duration{15 + n}};
  r.plan_status = PlanStatus::kNoPath;
  if (n % 4 == 1) {  // a bend of a byte, of two, of five, and back
    r.path.stamp = Time{Duration{18 + n}};
    for (const PointMm p : {PointMm{1000, -2000},
                            {1100, -2000},
                            {1200 + static_cast<std::int32_t>(n), -1990},
                            {2'147'483'647, -2'147'483'647},
                            {-2'147'483'647, 5}})
      static_cast<void>(r.path.points.push_back(p));
  }
  r.wanted = {x * 12, x * 13};
  r.took = Duration{17 + n};
  r.latency = {x * 20, x * 21};
  r.verdict = {{x * 14, x * 15}, Reason::kStopZone | Reason::kNoGoal, std::numeric_limits<double>::infinity()};
  r.command = {Time{Duration{16 + n}}, x * 16, x * 17};
}

[[nodiscard]] inline bool same_scan(const LaserScan& a, const LaserScan& b) {
  bool same = a.stamp == b.stamp && a.sequence == b.sequence && a.beam_count == b.beam_count &&
              a.first_angle_rad == b.first_angle_rad && a.angle_step_rad == b.angle_step_rad &&
              a.range_min_m == b.range_min_m && a.range_max_m == b.range_max_m && a.sweep == b.sweep &&
              a.period == b.period;
  for (std::size_t i = 0; i < kMaxBeams; ++i) {
    same = same && std::bit_cast<std::uint32_t>(a.range_m[i]) == std::bit_cast<std::uint32_t>(b.range_m[i]);
  }
  return same;
}

[[nodiscard]] inline bool same_fix(const OutsideFix& a, const OutsideFix& b) {
  bool same = a.stamp == b.stamp && a.sequence == b.sequence && a.has_pose == b.has_pose &&
              a.map_from_robot == b.map_from_robot && a.position_std_m == b.position_std_m &&
              a.heading_std_rad == b.heading_std_rad && a.mover_std_m == b.mover_std_m &&
              a.movers.size() == b.movers.size();
  for (std::size_t i = 0; same && i < a.movers.size(); ++i) {
    same = a.movers[i].id == b.movers[i].id && a.movers[i].position_in_map == b.movers[i].position_in_map &&
           a.movers[i].radius_m == b.movers[i].radius_m;
  }
  return same;
}

[[nodiscard]] inline bool same_path(const PlannedPath& a, const PlannedPath& b) {
  return a.stamp == b.stamp && std::equal(a.points.begin(), a.points.end(), b.points.begin(), b.points.end());
}

[[nodiscard]] inline bool same_inputs(const TickRecord& a, const TickRecord& b) {
  return a.now == b.now && a.took == b.took && same_scan(a.scan, b.scan) && same_fix(a.fix, b.fix) &&
         a.wheels.stamp == b.wheels.stamp && a.wheels.sequence == b.wheels.sequence &&
         a.wheels.left_rad == b.wheels.left_rad && a.wheels.right_rad == b.wheels.right_rad &&
         a.wheels.left_radps == b.wheels.left_radps && a.wheels.right_radps == b.wheels.right_radps &&
         a.wheels.trouble == b.wheels.trouble && a.wheels.fault == b.wheels.fault && a.wheels.stop == b.wheels.stop &&
         a.wheels.ready == b.wheels.ready && a.input.stamp == b.input.stamp && a.input.has_goal == b.input.has_goal &&
         a.input.goal_in_map == b.input.goal_in_map && a.input.goal_tolerance_m == b.input.goal_tolerance_m &&
         std::bit_cast<std::uint64_t>(a.input.goal_heading_rad) ==
             std::bit_cast<std::uint64_t>(b.input.goal_heading_rad) &&
         a.input.goal_heading_tolerance_rad == b.input.goal_heading_tolerance_rad &&
         a.input.emergency_stop == b.input.emergency_stop && a.input.reset == b.input.reset;
}

[[nodiscard]] inline bool same_bits(const TickRecord& a, const TickRecord& b) {
  return same_inputs(a, b) && a.pose.stamp == b.pose.stamp && a.pose.map_from_robot == b.pose.map_from_robot &&
         a.pose.position_std_m == b.pose.position_std_m && a.pose.heading_std_rad == b.pose.heading_std_rad &&
         a.plan_asked == b.plan_asked && a.plan_sequence == b.plan_sequence && a.plan_stamp == b.plan_stamp &&
         a.plan_status == b.plan_status && same_path(a.path, b.path) && a.wanted == b.wanted &&
         a.latency.tick_s == b.latency.tick_s && a.latency.drive_s == b.latency.drive_s &&
         a.verdict.permitted == b.verdict.permitted && a.verdict.reasons == b.verdict.reasons &&
         a.verdict.gap_m == b.verdict.gap_m && a.command.stamp == b.command.stamp &&
         a.command.left_radps == b.command.left_radps && a.command.right_radps == b.command.right_radps;
}

}  // namespace jaywalk
