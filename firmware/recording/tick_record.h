#pragma once
// The tick's only local state: enough to live through the tick again.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "firmware/safety/latency.h"
#include "firmware/safety/reasons.h"
#include "hal/types/fixed_vector.h"
#include "hal/types/laser_scan.h"
#include "hal/types/operator_input.h"
#include "hal/types/outside_fix.h"
#include "hal/types/wheels.h"
#include "planner/cost_to_go/planner.h"
#include "planner/localization/localizer.h"

namespace jaywalk {

/// A place in the map as recordings and messages have it, mm; within +-2,147 km.
struct PointMm {
  std::int32_t x = 0, y = 0;
  bool operator==(const PointMm&) const = default;
};

[[nodiscard]] inline PointMm in_mm(Vec2 p) noexcept {
  const auto whole = [](double metres) {
    constexpr double kMost = std::numeric_limits<std::int32_t>::max();
    return static_cast<std::int32_t>(std::clamp(std::floor(metres * 1000.0 + 0.5), -kMost, kMost));
  };
  return {whole(p.x), whole(p.y)};
}
[[nodiscard]] inline Vec2 in_metres(PointMm p) noexcept { return {p.x / 1000.0, p.y / 1000.0}; }

struct PlannedPath {
  Time stamp = kNever;                            ///< of the scan that the plan rests on
  FixedVector<PointMm, kMaxPathPoints> points{};  ///< from the robot to the goal; empty: no path
};

/// The path of `plan`; none unless its status is kOk. Finite points, as a plan has them.
inline void keep_path(const Plan& plan, PlannedPath& path) noexcept {
  path.stamp = plan.stamp;
  path.points.clear();
  for (const Vec2& point : plan.path) static_cast<void>(path.points.push_back(in_mm(point)));  // as many as there fit
}

/// All that crosses the HAL and the supervisor in a tick, as it is recorded: more fields than a struct has elsewhere.
struct TickRecord {
  Time now = kNever;
  // In: what the devices said.
  LaserScan scan;  ///< the first scanner's newest
  OfOthers<LaserScan> other_scans;
  WheelState wheels;
  OperatorInput input;
  OutsideFix fix;
  Duration took{0};  ///< from now until the command was out, by the HAL's clock
  // Made of it.
  PoseEstimate pose;
  bool plan_asked = false;          ///< this tick submitted a request
  std::uint32_t plan_sequence = 0;  ///< which submission collect() answered with
  Time plan_stamp = kNever;
  PlanStatus plan_status = PlanStatus::kNone;
  PlannedPath path;  ///< with the tick that a plan is new in
  Twist2 wished;     ///< what a person's stick asks for; not in a recording, the stick is
  Twist2 wanted;
  MeasuredLatency latency;  ///< measured in the ticks before, for the stop zone
  Verdict verdict;
  // Out.
  WheelCommand command;

  [[nodiscard]] OfEach<LaserScan> scans() const noexcept { return {scan, other_scans}; }
  /// The scan that was taken last.
  [[nodiscard]] const LaserScan& newest_scan() const noexcept {
    const LaserScan* newest = &scan;
    for (const LaserScan& other : other_scans) newest = other.stamp > newest->stamp ? &other : newest;
    return *newest;
  }
  /// How many there were, of all scanners: another number where one of them has a new one.
  [[nodiscard]] std::uint32_t scan_count() const noexcept {
    std::uint32_t count = 0;
    for (const LaserScan& of : scans()) count += of.sequence;
    return count;
  }
};

}  // namespace jaywalk
