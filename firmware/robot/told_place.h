#pragma once
#include "hal/hal.h"

namespace jaywalk {

/// Fixes from a person's word on where the robot is, once PlaceCheck has taken it: the only ones of a robot without a
/// localisation system outside it. Thread: the loop's.
class ToldPlace final : public PoseSource {
 public:
  // A person's eye on a plan; within what a scan matcher puts right (correlative_search.cc).
  ToldPlace() noexcept { fix_.position_std_m = 0.13, fix_.heading_std_rad = 0.1; }

  /// Said three times, in as many ticks: the localizer passes one fix over that is far from where it believes to be.
  void tell(const Pose2& map_from_robot) noexcept {
    fix_.map_from_robot = map_from_robot;
    fix_.has_pose = true;
    left_ = kTimes;
  }
  /// Of the tick that begins at `now`.
  void step(Time now) noexcept {
    if (left_ == 0) return;
    --left_;
    fix_.stamp = now;
    ++fix_.sequence;
  }
  [[nodiscard]] const OutsideFix& latest() noexcept override { return fix_; }

 private:
  static constexpr int kTimes = 3;
  OutsideFix fix_;
  int left_ = 0;
};

}  // namespace jaywalk
