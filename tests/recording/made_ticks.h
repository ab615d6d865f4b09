#pragma once
// Ticks whose every field differs from every other's, and a comparison of all their bits.
#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>
#include <limits>
#include <memory>
#include <tuple>
#include <vector>

#include "firmware/recording/recorder.h"

namespace jaywalk {

/// A NaN with a payload of its own: 0x7FC00000 is the plain one.
inline constexpr std::uint32_t kOddNan = 0x7FA5A5A5;

/// Tick `n` at 20 ms a tick; a new scan every third, a new fix every fifth tick.
inline void fill(TickRecord& r, std::uint32_t n) {
  const double x = 0.1 * (1 + static_cast<double>(n));
  using Float = std::numeric_limits<float>;
  r.scan = {.stamp = Time{Duration{1000 + n / 3}},
            .sequence = 1 + n / 3,
            .beam_count = 5,
            .first_angle_rad = -1.5F,
            .angle_step_rad = 0.25F,
            .range_min_m = 0.02F,
            .range_max_m = 25.0F,
            .sweep = Duration{7},
            .period = Duration{8},
            .range_m = {static_cast<float>(1 + n / 3), std::bit_cast<float>(kOddNan), Float::infinity(), -0.0F,
                        Float::denorm_min()}};
  r.wheels = {
      Time{Duration{11}}, n + 1, x, x * 2, x * 3, x * 4, DriveTrouble::kDriveSilent, {DriveFaultKind::kVesc, 23, n},
      StopStage::kSilent, false};
  r.input = {Time{Duration{12}}, true, {x * 5, x * 6},   x * 7, x * 18, x * 19, n % 2 == 1,
             n % 2 == 0,         true, {x * 20, -x * 21}};
  if (n % 7 == 3) r.input.goal_heading_rad = kAnyHeading;
  r.fix = {Time{Duration{13}}, 1 + n / 5, true, {1.0, 2.0, 3.0}, 0.25, 0.5, 0.75, {}};
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

inline Time time_of(std::uint32_t tick) { return Time{Duration{20'000'000LL * tick}}; }

/// Tick `n` as `fill` makes it.
inline std::unique_ptr<TickRecord> made_tick(std::uint32_t n) {
  auto record = std::make_unique<TickRecord>();
  record->now = time_of(n);
  fill(*record, n);
  return record;
}

inline void record_tick(Recorder& recorder, std::uint32_t n) {
  fill(recorder.begin(time_of(n)), n);
  recorder.commit();
}

/// The entry that a new encoder makes of a record.
inline std::vector<unsigned char> entry_of(const TickRecord& record, std::uint64_t lost = 0) {
  std::vector<unsigned char> bytes(kMaxEntryBytes);
  bytes.resize(TickEncoder().encode(record, lost, bytes));
  return bytes;
}

/// The record that a new decoder makes of an entry; null where it refuses it.
inline std::unique_ptr<TickRecord> record_of(std::span<const unsigned char> entry) {
  auto record = std::make_unique<TickRecord>();
  std::uint64_t lost = 0;
  return TickDecoder().decode(entry, *record, lost) ? std::move(record) : nullptr;
}

[[nodiscard]] inline bool same_scan(const LaserScan& a, const LaserScan& b) {
  const auto fields = [](const LaserScan& s) {
    return std::tie(s.stamp, s.sequence, s.beam_count, s.first_angle_rad, s.angle_step_rad, s.range_min_m,
                    s.range_max_m, s.sweep, s.period);
  };
  return fields(a) == fields(b) && std::memcmp(a.range_m.data(), b.range_m.data(), sizeof a.range_m) == 0;
}

[[nodiscard]] inline bool same_movers(const OutsideFix& a, const OutsideFix& b) {
  const auto fields = [](const ObservedMover& m) { return std::tie(m.id, m.position_in_map, m.radius_m); };
  return std::ranges::equal(a.movers, b.movers, {}, fields, fields);
}

[[nodiscard]] inline bool same_path(const PlannedPath& a, const PlannedPath& b) {
  return a.stamp == b.stamp && std::equal(a.points.begin(), a.points.end(), b.points.begin(), b.points.end());
}

[[nodiscard]] inline bool same_bits(const TickRecord& a, const TickRecord& b) {
  const auto devices = [](const TickRecord& t) {
    const WheelState& w = t.wheels;
    const OperatorInput& i = t.input;
    const OutsideFix& f = t.fix;
    return std::tie(t.now, t.took, w.stamp, w.sequence, w.left_rad, w.right_rad, w.left_radps, w.right_radps, w.trouble,
                    w.fault, w.stop, w.ready, i.stamp, i.has_goal, i.goal_in_map, i.goal_tolerance_m,
                    i.goal_heading_tolerance_rad, i.emergency_stop, i.reset, f.stamp, f.sequence, f.has_pose,
                    f.map_from_robot, f.position_std_m, f.heading_std_rad, f.mover_std_m);
  };
  const auto made = [](const TickRecord& t) {
    return std::tie(t.pose.stamp, t.pose.map_from_robot, t.pose.position_std_m, t.pose.heading_std_rad, t.plan_asked,
                    t.plan_sequence, t.plan_stamp, t.plan_status, t.wanted, t.latency.tick_s, t.latency.drive_s,
                    t.verdict.permitted, t.verdict.reasons, t.verdict.gap_m, t.command.stamp, t.command.left_radps,
                    t.command.right_radps);
  };
  const auto heading = [](const TickRecord& t) { return std::bit_cast<std::uint64_t>(t.input.goal_heading_rad); };
  return devices(a) == devices(b) && heading(a) == heading(b) && made(a) == made(b) && same_scan(a.scan, b.scan) &&
         same_movers(a.fix, b.fix) && same_path(a.path, b.path);
}

}  // namespace jaywalk
