#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "planner/cost_to_go/guide.h"
#include "planner/cost_to_go/nearest_surfaces.h"
#include "planner/cost_to_go/planner.h"

namespace jaywalk::motion {

/// Surfaces within some 4 m of the robot, from the map of what stands alone: a Guide for motion that heads for no goal.
/// It knows no way from anywhere, and calls nothing unseen. Memory in the constructor. Thread: the loop's.
class LocalGround {
 public:
  explicit LocalGround(const KeepOut& keep_out = {});
  /// What lies within a body of `movers` is no surface. The guide is valid until the next call.
  const Guide& update(const EvidenceMap& still, Vec2 robot_in_map, std::span<const MoverDisc> movers) noexcept;
  /// The last look's; before the first nothing is known.
  [[nodiscard]] const Guide& guide() const noexcept { return guide_; }

 private:
  KeepOut keep_out_;
  field::NearestSurfaces surfaces_;
  std::vector<std::uint8_t> found_unseen_, unseen_;
  std::vector<float> to_go_s_;
  Guide guide_;
};

}  // namespace jaywalk::motion
