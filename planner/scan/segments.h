#pragma once
// A scan cut where it jumps.
#include <cstdint>

#include "hal/types/fixed_vector.h"
#include "planner/scan/scan_points.h"

namespace jaywalk {

/// A run of neighbouring points that are one thing: points [first, last] of the scan.
struct Segment {
  std::uint32_t first = 0, last = 0;
};

using Segments = FixedVector<Segment, kMaxBeams>;  ///< never full: a segment has a point, and a beam one at most

/// A scan all round has no end: its list of points is turned so that it begins at a jump, and nothing is cut in two
/// where the scanner begins its turn.
void begin_at_a_jump(const Sweep& sweep, ScanPoints& points) noexcept;

/// Cuts the scan where neighbouring points are farther apart than a surface explains: by the range, and by the steps
/// beside theirs, since a wall seen at a slant goes on in long ones.
void cut_at_jumps(const ScanPoints& points, const Sweep& sweep, Segments& out) noexcept;

}  // namespace jaywalk
