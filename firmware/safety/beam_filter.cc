#include "firmware/safety/beam_filter.h"

#include <utility>

namespace jaywalk {

BeamFilter::BeamFilter(const RobotModel& model, std::size_t scanner, bool has_wheels)
    : blanked_(model.lasers()[scanner].blanked),
      robot_from_laser_(model.lasers()[scanner].robot_from_laser),
      track_width_m_(model.drive.track_width_m),
      has_wheels_(has_wheels),
      travel_(model.drive) {}

void BeamFilter::filter(LaserScan& scan, const WheelState& wheels) noexcept {
  blank(blanked_, scan);
  travel_.note(wheels);
  if (!has_wheels_ || scan.sequence == 0 || scan.beam_count < 2 || scan.beam_count > kMaxBeams) return;
  const bool is_new = std::exchange(sequence_, scan.sequence) != scan.sequence;
  const Pose2 moved = is_new ? now_from_before(scan.stamp) : Pose2{};
  if (is_new) lone_returns_.take(scan, moved);
  lone_returns_.strike_out(scan);
  if (is_new) free_claims_.take(scan, moved);
  free_claims_.strike_out(scan);
}

/// Pose of the laser at its scan before, in its frame at this one; none where the wheels do not tell.
Pose2 BeamFilter::now_from_before(Time stamp) noexcept {
  Rolled rolled;
  const bool known = travel_.expected_at(stamp, rolled);
  const Pose2 moved = known && rolled_known_ ? arc_of(rolled - rolled_, track_width_m_) : Pose2{};
  rolled_ = rolled;
  rolled_known_ = known;
  return inverse(inverse(robot_from_laser_) * moved * robot_from_laser_);
}

}  // namespace jaywalk
