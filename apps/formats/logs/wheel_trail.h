#pragma once
// From recorded poses back to the wheel encoders that would have led there.
#include <optional>
#include <vector>

#include "hal/types/geometry.h"
#include "hal/types/robot_model.h"
#include "hal/types/time.h"
#include "hal/types/wheels.h"

namespace jaywalk::sim {

/// A pose as a recording gives it, in the recording's own frame.
struct OdometryPose {
  Time stamp = kNever;
  Pose2 pose;
  std::optional<Twist2> twist;  ///< where the recording says it
};

/// The drive that replayed wheel angles belong to. Recordings do not say what drove, and any
/// differential drive would do: integrating the angles uses the same numbers.
[[nodiscard]] DriveModel nominal_drive();

/// Wheel readings that a differential drive integrating exact arcs turns back into the poses. Angles begin at zero with
/// the first pose.
///
/// Between two poses the drive runs along a circle's arc through the heading's change da: its
/// length is s = c (da/2) / sin(da/2) with c the displacement along the mean heading. What lies
/// across it (side slip, a SLAM correction) no such drive can do in a moment; it stays as an error of position
/// and is made up for as soon as the robot has turned. Poses more than 0.15 s apart that no arc joins to 1 cm were
/// joined by another way: the drive turns, drives straight and turns, in thirds of the time, with a reading after each.
/// But not where up to 3 cm aside would take a turn of over 15 degrees: scans between would be seen that far turned.
/// Heading is exact at every pose. Speeds are the recording's where it has them, else differences. `poses` has rising
/// stamps.
[[nodiscard]] std::vector<WheelState> wheel_trail(const std::vector<OdometryPose>& poses, const DriveModel& drive);

/// The same with readings every 0.1 s at least, the wheels turning evenly, where two are up to 1.5 s apart: wheels that
/// were recorded seldom turned all the same, and scans between ask where they were.
[[nodiscard]] std::vector<WheelState> filled_in(const std::vector<WheelState>& trail);

/// Times of a trail's reports: the median period, and the 95th percentile of lateness beyond it. At least a loop's
/// period, at most what a base may have (report_ms, report_late_ms); longer silence is a gap.
[[nodiscard]] DriveTimes report_times(const std::vector<WheelState>& trail);

}  // namespace jaywalk::sim
