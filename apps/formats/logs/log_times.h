#pragma once
// Which stamps of a recording are of one clock that runs.
#include <chrono>
#include <span>
#include <vector>

#include "hal/types/time.h"

namespace jaywalk::sim {

inline constexpr const char* kTimeStands = "its time does not grow";
inline constexpr const char* kTimeLeapt = "its time is ahead of those after it";
inline constexpr const char* kOtherClock = "its time is over an hour from the others'";
/// A tick lasts 20 ms: a clock that was set right would be replayed for ever.
inline constexpr Duration kOtherClockFrom = std::chrono::hours(1);

/// A cause for each stamp that is left out, nullptr for those that are kept, in the order of `stamps`: that of
/// recording. Kept are, of the largest group without a gap of an hour, those of the longest sequence that rises
/// strictly: a clock that was set right on the way costs the fewest.
[[nodiscard]] std::vector<const char*> judge_times(std::span<const Time> stamps);

}  // namespace jaywalk::sim
