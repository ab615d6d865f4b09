#pragma once
#include <algorithm>

namespace jaywalk {

/// The least clearance (m) wanted of the next pose of a way: `margin_m`; from a start that is nearer to something than
/// that, no less than there, for it may be left, and passed alike, but over a whole way not approached.
/// `before_m`: of the pose before. Clearances below zero are depths (BodyMap).
constexpr double least_clearance_m(double margin_m, double at_start_m, double before_m) {
  constexpr double kUneven_m = 0.002;  // clearances along a straight wall, between a map's nodes
  return std::min(margin_m, std::max(at_start_m, before_m) - kUneven_m);
}

}  // namespace jaywalk
