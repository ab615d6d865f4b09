#pragma once
#include <array>

#include "firmware/recording/tick_record.h"
#include "firmware/safety/stop_zone.h"
#include "hal/types/fixed_vector.h"
#include "hal/types/robot_model.h"

namespace jaywalk::view {

/// The body's corners in the map, grown by the stop zone's margin.
using Corners = std::array<Vec2, 4>;

/// The supervisor's stop zone as a picture: where the body comes until it stands, from the twist that was permitted,
/// after the reaction time that the supervisor reckons with, along its arc.
class ShownStopZone {
 public:
  ShownStopZone(const RobotModel& model, Duration tick);

  using Outlines = FixedVector<Corners, 4>;  ///< the last one is where the body stands
  [[nodiscard]] Outlines at(const TickRecord& record) const noexcept;

 private:
  RobotModel model_;
  Duration tick_;
  StopZone zone_;
};

}  // namespace jaywalk::view
