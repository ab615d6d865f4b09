#pragma once
#include <cstddef>
#include <span>

#include "hal/types/geometry.h"
#include "hal/types/robot_model.h"
#include "hal/types/scanners.h"
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

}  // namespace jaywalk::motion
