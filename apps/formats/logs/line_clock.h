#pragma once
// Whether the times in a recording can be the laser's, and even ones where they cannot.
#include <cstddef>

#include "hal/types/geometry.h"
#include "hal/types/time.h"

namespace jaywalk::sim {

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

  /// Of line `k` of those seen: the first stamp, and evenly on to the last; ten a second where they are the same.
  [[nodiscard]] Time even(std::size_t k) const;

 private:
  static constexpr std::size_t kFewest = 5, kOneLineIn = 100;

  std::size_t lines_ = 0, stood_ = 0;
  Time first_ = kNever, last_ = kNever;
};

}  // namespace jaywalk::sim
