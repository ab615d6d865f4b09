#pragma once
// A room to look round in: straight walls and discs, and the scan that an exact laser would take of them.
#include <initializer_list>
#include <vector>

#include "hal/types/geometry.h"
#include "hal/types/laser_scan.h"

namespace jaywalk::test {

struct Wall {
  Vec2 from, to;
};

struct Disc {
  Vec2 centre;
  double radius_m = 0.0;
};

struct Room {
  std::vector<Wall> walls{};
  std::vector<Disc> discs{};
};

/// Four walls, `width` by `depth`, centred on the origin, and in them discs and more walls.
[[nodiscard]] Room rectangle(double width, double depth, std::initializer_list<Disc> discs = {},
                             std::initializer_list<Wall> walls = {});

/// The same of 12 m x 10 m.
[[nodiscard]] inline Room with(std::initializer_list<Disc> discs, std::initializer_list<Wall> walls = {}) {
  return rectangle(12.0, 10.0, discs, walls);
}

/// How the laser's beams lie.
struct Fan {
  std::uint32_t beams = 811;
  double first_rad = -0.75 * kPi, step_rad = 1.5 * kPi / 810;
};

/// 811 beams over 270 degrees (or `fan`), 20 m, scan number `k` of a 15 Hz laser: stamped (k - 1)/15 s, sequence k. A
/// beam that meets nothing returns nothing. `noise_m` is the half width of a deterministic ripple over the ranges.
[[nodiscard]] LaserScan scan_of(const Room& room, const Pose2& map_from_laser, std::uint32_t k, double noise_m = 0.0,
                                const Fan& fan = {});

}  // namespace jaywalk::test
