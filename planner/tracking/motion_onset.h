#pragma once
// Whether a target that was taken for standing has started to move.
#include <cstdint>

#include "hal/types/geometry.h"
#include "planner/scan/line_of_sight.h"
#include "planner/tracking/target.h"

namespace jaywalk {
/// What a target is judged by besides its own path, at one scan.
struct Surroundings {
  const LineOfSight& sight;  ///< of this scan
  const PastScans& past;     ///< the scans before it
  Time now;                  ///< of this scan
  Pose2 map_from_laser;
  Pose2 map_from_first = map_from_laser;  ///< of the robot's first laser: anchors are kept as seen from there

  [[nodiscard]] Vec2 laser_in_map() const { return map_from_laser.position(); }
};

enum class MotionOnset : std::uint8_t {
  kNone,
  kLikely,   ///< to be seen again
  kCertain,  ///< both sides of it went along, seen whole
};

/// Whether this scan's detection of the target (Existence::misses is 0) says that it moves: it was seen steadily, is
/// farther from its anchor than swaying and doubt explain, came here in small steps along one line, and no longer
/// stands at its anchor. The less the ground tells (beams that now pass over the anchor, beams that a moment ago passed
/// where it is, ground that the map has free) and the less of it is seen, the longer and straighter the walk must be. A
/// walk counts only as far as the target does not grow or shrink meanwhile (straight_fit.h). What rides along with the
/// laser belongs to the robot. A target as wide as a body, seen whole, that stood is judged by its newest positions
/// alone as well; one taken for a wall, by nothing else.
///
/// The thresholds are the smallest at which hardly anything started to move in 27 passes over a minute of scans that
/// were taken where nobody was (`no_people_left`, each from another scan on, with three sweep times).
[[nodiscard]] MotionOnset motion_onset(const Target& target, const Surroundings& around) noexcept;

/// Decides, once a scan, whether a target moves beyond reasonable doubt (Track::moving), whether it stands for good
/// (Existence::settled) and whether it was seen to walk (Existence::pedestrian). Two thresholds keep it from
/// wavering: its onset must be likely in two scans running, or certain in one, and it stays moving until it has been
/// slow for more than four seconds.
void judge_motion(Target& target, const Surroundings& around) noexcept;

/// What was seen of its way until now tells nothing.
void forget_walk(Target& target, const Pose2& map_from_laser, Time now) noexcept;

}  // namespace jaywalk
