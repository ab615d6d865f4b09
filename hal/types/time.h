#pragma once
// Time as the control loop counts it: nanoseconds since an epoch of the clock device's own.
#include <chrono>
#include <cstdint>

namespace jaywalk {

/// Tag of the loop's own time line; it has no now(): time comes from the HAL's Clock alone.
struct ControlTimeline {
  using rep = std::int64_t;
  using period = std::nano;
  using duration = std::chrono::nanoseconds;
  using time_point = std::chrono::time_point<ControlTimeline>;
  static constexpr bool is_steady = true;
};

using Duration = std::chrono::nanoseconds;
using Time = ControlTimeline::time_point;

/// A stamp older than everything: "never seen".
inline constexpr Time kNever = Time::min();

constexpr double to_seconds(Duration d) { return static_cast<double>(d.count()) * 1e-9; }
constexpr double to_seconds(Time t) { return to_seconds(t.time_since_epoch()); }

/// Nearest nanosecond to `s` seconds; `s` is finite and below 292 years.
constexpr Duration duration_from_seconds(double s) {
  return Duration{static_cast<std::int64_t>(s * 1e9 + (s < 0 ? -0.5 : 0.5))};
}
constexpr Time time_from_seconds(double s) { return Time{duration_from_seconds(s)}; }

/// How old `stamp` is at `now`; Duration::max() for what was never seen.
constexpr Duration age(Time stamp, Time now) { return stamp == kNever ? Duration::max() : now - stamp; }

}  // namespace jaywalk
