#pragma once
// Whether a body that was taken for standing has set out.
#include <cstdint>

#include "planner/tracking/bodies.h"
#include "planner/tracking/surroundings.h"

namespace jaywalk {

enum class Departure : std::uint8_t {
  kNone,
  kLikely,   ///< to be seen again
  kCertain,  ///< both sides of a body went along, seen whole
};

/// Whether this scan's sight of the body (Body::misses is 0) says that it walks: it was seen steadily, is farther from
/// where it stood than swaying and doubt explain, came here in small steps along one line, and no longer stands where
/// it stood. The less the ground tells (beams that now pass over where it stood, ground under it or ahead of it that
/// was free before) and the less of a body is seen, the longer and straighter the walk must be, and the more so the
/// farther off: few points, and a heading's error grows. A walk counts only as far as the thing does not grow or shrink
/// meanwhile (steady_walk.h, places.h). What rides along with the laser belongs to the robot. Who is as wide as a body,
/// seen whole, and stood is judged by his newest places alone as well; what is taken for a wall, by nothing else.
///
/// The thresholds are the smallest at which hardly anything set out in 27 passes over a minute of scans that were taken
/// where nobody was (`no_people_left`, each from another scan on, with three sweep times).
[[nodiscard]] Departure departure(const Body& body, const Surroundings& around) noexcept;

}  // namespace jaywalk
