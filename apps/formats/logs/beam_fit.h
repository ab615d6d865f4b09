#pragma once
// Resamples scans to one number of beams. Drivers of spinning lasers publish a different number each turn.
#include <string>

#include "apps/formats/logs/recorded_log.h"

namespace jaywalk::sim {

/// Gives every scan the number of beams that the median scan has, in its directions; a remark tells which numbers there
/// were. Where several of a scan's own beams fall on one, the nearest hit counts; where none does, the one beside it
/// within the scan's own step, else nothing is known (NaN).
void fit_beams(RecordedLog& log, const std::string& name);

}  // namespace jaywalk::sim
