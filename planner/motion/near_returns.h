#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "hal/types/geometry.h"
#include "hal/types/laser_scan.h"
#include "hal/types/robot_model.h"
#include "planner/cost_to_go/guide.h"
#include "planner/cost_to_go/nearest_surfaces.h"
#include "planner/cost_to_go/planner.h"
#include "planner/motion/robot_body.h"
#include "planner/scan/line_of_sight.h"

namespace jaywalk::motion {

/// What the last scan, of each scanner, hits close to the robot: the points that the supervisor's stop zone will look
/// at, place by place. The map knows a surface as one place a cell, which lies up to 5 cm behind a wall's end.
class NearReturns {
 public:
  /// The nearest hit of each 3 degrees about the robot, of those within its reach in 1.5 s, and of `unseen_walls`, in
  /// the map. What may be a body of `movers` is left out: it will be elsewhere.
  void update(const OfEach<SeenFrom>& scans, const RobotState& robot, const RobotBody& body,
              std::span<const MoverDisc> movers, std::span<const Vec2> unseen_walls) noexcept;

  /// Which share of the speed at `robot` the supervisor takes away, in [0, 1]: beside a point that is nearer than it
  /// was at the look, the outline's edge may go no faster than the stop zone's margin there allows; where something was
  /// nearer than 7 cm, as fast as it may creep beside that.
  [[nodiscard]] float braked_share(const RobotState& robot, const RobotBody& body) const noexcept;

  /// Whether something was so near that the supervisor lets the robot creep at most.
  [[nodiscard]] bool is_beside() const noexcept { return nearest_ < StopZoneRules<float>::kBeside_m; }

  static constexpr float kForS = 1.5F;  ///< so far ahead the supervisor's braking is foreseen

 private:
  static constexpr std::size_t kSectors = 120;
  float x_[kSectors] = {}, y_[kSectors] = {}, gap_[kSectors] = {};
  std::size_t count_ = 0;
  float nearest_ = StopZoneRules<float>::kBeside_m;  ///< of the gaps, and no more than that
};

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
