#pragma once
#include <optional>

#include "apps/formats/logs/recorded_log.h"

namespace jaywalk {

/// Time (s) by which the stamps of a recording's odometry are ahead of its scans': two computers' clocks, or, below 0,
/// of wheels that are reported late. Localisation by scans alone lives through the recording until the robot has turned
/// by 12 rad; the answer is the shift, within 0.5 s, at which its turns differ least from the wheels'. Nothing: less
/// than 0.1 s or a sweep; or there are no wheels, too little turning (3 rad), or no shift is much likelier than none.
[[nodiscard]] std::optional<double> found_clock_offset(const sim::RecordedLog& log);

}  // namespace jaywalk
