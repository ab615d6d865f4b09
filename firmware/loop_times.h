#pragma once
#include <cstdint>

#include "firmware/log_histogram.h"

namespace jaywalk {

/// How well a loop with a thread of its own kept time, from its first tick on.
struct LoopTimes {
  LogHistogram wake_late_us;  ///< from when a tick was due to when the thread woke
  LogHistogram tick_us;       ///< from waking to the end of the tick, the status and the trace included
  std::uint64_t minor_faults = 0, major_faults = 0;  ///< page faults of that thread; major: the disk was waited for
};

}  // namespace jaywalk
