#pragma once
#include <cstddef>
#include <optional>
#include <vector>

#include "apps/report/picture/scene.h"

namespace jaywalk {
/// A run at equal steps of time, for the moving picture. Allocates; works outside the tick.
class Playback {
 public:
  /// Steps of 0.4 s, longer where there would be more than `most_steps` (2 or more). Keeps a reference to `driven`.
  Playback(const std::vector<DrivenPose>& driven, std::size_t most_steps);

  /// Seconds of the run that the playback covers, more than 0.
  [[nodiscard]] double lasts_s() const { return lasts_s_; }
  /// The robot at each step, headings continuous (rad, beyond pi where it turned round); empty without a driven pose.
  [[nodiscard]] std::vector<Pose2> robot() const;
  /// The trail at each step; its first point before it begins, its last after it ends. `trail` has a point.
  [[nodiscard]] std::vector<Vec2> positions(const Trail& trail) const;
  /// When the trail is there, as shares of the playback in [0, 1].
  struct Stay {
    double from = 0.0, to = 1.0;
  };
  [[nodiscard]] Stay stay(const Trail& trail) const;

 private:
  [[nodiscard]] Time time_of(std::size_t step) const;

  const std::vector<DrivenPose>& driven_;
  Time begin_ = kNever;
  double lasts_s_ = 1.0;
  std::size_t steps_ = 2;
};

/// Where the trail was at time `t`, in a straight line between its points; its last point for 1 s after its end. No
/// value before its first point and later than that.
[[nodiscard]] std::optional<Vec2> position_at(const Trail& trail, Time t);

}  // namespace jaywalk
