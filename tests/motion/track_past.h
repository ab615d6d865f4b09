#pragma once
// What the tracker keeps of a track's past, for tests that make tracks themselves.
#include "planner/tracking/track.h"
#include "planner/tracking/tuning.h"

namespace jaywalk::tests {

/// Of one track: whether it has walked, and since when it has been where it is.
class TrackPast {
 public:
  /// A well seen disc of 0.27 m radius.
  [[nodiscard]] Track of(Vec2 position, Vec2 velocity, Time now) {
    const bool moving = norm(velocity) > 0.1;
    is_pedestrian_ = is_pedestrian_ || moving;
    if (since_ == kNever || distance(at_, position) > kStandsWithinM) at_ = position, since_ = now;
    return {.id = 1,
            .stamp = now,
            .position_in_map = position,
            .velocity_in_map = velocity,
            .covariance = {1e-4, 1e-5, 1e-3},
            .radius_m = 0.27,
            .moving = moving,
            .is_pedestrian = is_pedestrian_,
            .still_since = since_,
            .hits = 20,
            .last_seen = now};
  }

 private:
  bool is_pedestrian_ = false;
  Vec2 at_;
  Time since_ = kNever;
};

}  // namespace jaywalk::tests
