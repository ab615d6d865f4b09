#pragma once
// Limits of a fault's reaction, by the loop's period: from the fault to the moment from which on the wheels only slow
// down.
#include <algorithm>

#include "hal/types/time.h"

namespace jaywalk::faults {

using namespace std::chrono_literals;

/// Limit of an immediate reaction: one period until the loop sees the fault, one until the drives obey, and 20 ms for a
/// ramp to fall by 5 mm/s.
[[nodiscard]] inline Duration at_once(Duration tick) noexcept { return 2 * tick + 20ms; }
/// The drives' own watchdog or heartbeat consumer, 100 ms at most, after the frame before it; a wheel that nothing
/// brakes is 5 mm/s slower only after 40 ms more.
[[nodiscard]] inline Duration by_themselves(Duration tick) noexcept { return 100ms + at_once(tick); }
/// 60 ms without feedback, or two and a half periods of the loop.
[[nodiscard]] inline Duration feedback(Duration tick) noexcept {
  return std::max<Duration>(60ms, 5 * tick / 2) + at_once(tick);
}
/// Two scans of 15 Hz that do not come, and the age of the one before.
[[nodiscard]] inline Duration scans(Duration tick) noexcept { return 240ms + at_once(tick); }
/// Plans are good for 0.3 s, and then the speed falls until they are a second old; the scan that they rest on is
/// older than they are.
[[nodiscard]] inline Duration plans(Duration tick) noexcept { return 540ms + at_once(tick); }
/// A lost stop escalates to silence 100 ms after the ramp's end, and 100 ms later the drive's own watchdog acts.
[[nodiscard]] inline Duration escalated(Duration tick) noexcept { return 100ms + 100ms + at_once(tick); }
/// A stranger's NMT command, repeated: the feedback that stops coming, silence, and the drives' own watchdog.
[[nodiscard]] inline Duration taken_over(Duration tick) noexcept { return 100ms + by_themselves(tick); }
/// A scan of 15 Hz, and what it takes to come.
[[nodiscard]] inline Duration next_scan(Duration tick) noexcept { return 67ms + 67ms + at_once(tick); }
/// Two and a half periods of the loop.
[[nodiscard]] inline Duration two_ticks(Duration tick) noexcept { return 5 * tick / 2 + at_once(tick); }
/// A plain stop keeps to the limits of comfort: 1 m/s2 is reached by a jerk of at most 2 m/s3.
[[nodiscard]] inline Duration in_comfort(Duration tick) noexcept { return 500ms + at_once(tick); }
/// Half a second of motion that shows it, and what a P3-DX that turns at 0.8 rad/s needs to move enough.
[[nodiscard]] inline Duration shows_for(Duration) noexcept { return 700ms; }
/// The same, from the first scan that repeats.
[[nodiscard]] inline Duration repeats_for(Duration) noexcept { return 67ms + 500ms; }
/// Wheels that go less far than they say look like slip for long (docs/explanation/safety.md).
[[nodiscard]] inline Duration slips_for(Duration) noexcept { return 4s; }

/// Told 0.03 m/s in the first way after arming (WheelProof), a wheel that stands is 6 mm/s outside what is tolerated.
[[nodiscard]] inline Duration in_first_way(Duration) noexcept { return 6s; }
/// Speeds that stand show where they change.
[[nodiscard]] inline Duration changes_for(Duration) noexcept { return 1s; }
/// A tenth of a second in each: until it is more than a sound drive's, and then a change of speed that shows it: at
/// 0.3 m/s the next one is the stop.
[[nodiscard]] inline Duration ages_for(Duration) noexcept { return 5500ms; }

}  // namespace jaywalk::faults
