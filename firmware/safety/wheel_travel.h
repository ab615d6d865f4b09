#pragma once
#include <array>
#include <cstddef>
#include <cstdint>

#include "hal/types/geometry.h"
#include "hal/types/robot_model.h"
#include "hal/types/wheels.h"

namespace jaywalk {

/// Way of each wheel's rim, m, positive forwards.
struct Rolled {
  double left_m = 0.0, right_m = 0.0;
};
constexpr Rolled operator-(const Rolled& a, const Rolled& b) noexcept {
  return {a.left_m - b.left_m, a.right_m - b.right_m};
}

/// Ring of the wheels' latest readings: the way that each wheel had rolled at a moment. Thread: the loop's; memory is
/// fixed.
class WheelTravel {
 public:
  explicit WheelTravel(const DriveModel& drive) : drive_(drive) {}

  /// Takes a reading once; one that is no number or not newer than the one before is left out.
  void note(const WheelState& wheels) noexcept;
  /// kNever before the first reading.
  [[nodiscard]] Time newest() const noexcept { return readings_[newest_].stamp; }
  /// Interpolates between the readings before and after; false where there are none.
  [[nodiscard]] bool at(Time stamp, Rolled& rolled) const noexcept;
  /// The same, but up to 0.2 s beyond the newest reading at the speeds between the last two, and later still as that
  /// reading has it; false before the first.
  [[nodiscard]] bool expected_at(Time stamp, Rolled& rolled) const noexcept;
  /// Mean twist from a moment, at which the wheels had rolled so far, to the newest reading; none where that is no
  /// later.
  [[nodiscard]] Twist2 twist_since(Time stamp, const Rolled& rolled) const noexcept;

 private:
  static constexpr std::size_t kMostReadings = 128;
  struct Reading {
    Time stamp = kNever;
    Rolled rolled;
  };

  DriveModel drive_;
  std::array<Reading, kMostReadings> readings_{};
  std::size_t newest_ = 0;
  std::uint32_t seen_ = 0;
};

/// Motion of the robot on the arc that its wheels rolled: its pose at the end in the frame of its start.
[[nodiscard]] Pose2 arc_of(const Rolled& rolled, double track_width_m) noexcept;

}  // namespace jaywalk
