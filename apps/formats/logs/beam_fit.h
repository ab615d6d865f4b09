#pragma once
// Resamples scans to one number of beams. Drivers of spinning lasers publish a different number each turn.
#include <span>
#include <string>

#include "apps/formats/logs/recorded_log.h"

namespace jaywalk::sim {

/// The directions of a scan's beams.
struct BeamAngles {
  double first_rad = 0.0, step_rad = 0.0;
  std::size_t beams = 0;

  [[nodiscard]] double angle_rad(std::size_t beam) const { return first_rad + step_rad * static_cast<double>(beam); }
  /// The beam nearest to that direction; -1 outside the fan.
  [[nodiscard]] std::ptrdiff_t beam_at(double angle) const;
};

/// Fills `out`, a range a beam of `to`, from `ranges`, one a beam of `from`. Where several fall on one, the nearest hit
/// counts; where none does, the one beside it within the scan's own step, else nothing is known (NaN).
void resample(const BeamAngles& from, std::span<const float> ranges, const BeamAngles& to, std::span<float> out);

/// Gives every scan the number of beams that the median scan has, in its directions; a remark tells which numbers there
/// were.
void fit_beams(RecordedLog& log, const std::string& name);

}  // namespace jaywalk::sim
