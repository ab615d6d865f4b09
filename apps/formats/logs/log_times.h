#pragma once
// Which stamps of a recording are of one clock that runs.
#include <chrono>
#include <cstddef>
#include <span>
#include <vector>

#include "hal/types/geometry.h"
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

// Whether the times in a recording can be the laser's, and even ones where they cannot.

/// Some recordings were stamped by a program that went through them later: a dozen scans share a stamp while the robot
/// drives two metres, and times between them tell how long that program took. Where that is so in five lines, and
/// one of a hundred, no time in the file is of use: give the lines out again, evenly between the first stamp and the
/// last.
class LineClock {
 public:
  /// A line's stamp, and how the robot moved since the line before.
  void see(Time said, const Pose2& moved) noexcept;

  /// Whether the stamps seen cannot be the laser's.
  [[nodiscard]] bool wrong() const { return stood_ >= kFewest && stood_ * kOneLineIn > lines_; }
  /// Lines in which the robot drove though time stood still.
  [[nodiscard]] std::size_t stood() const { return stood_; }

  /// Evenly spaced time of line `k`, from the first stamp to the last; at 10 Hz where both are the same.
  [[nodiscard]] Time even(std::size_t k) const;

 private:
  static constexpr std::size_t kFewest = 5, kOneLineIn = 100;

  std::size_t lines_ = 0, stood_ = 0;
  Time first_ = kNever, last_ = kNever;
};

}  // namespace jaywalk::sim
