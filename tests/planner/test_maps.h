#pragma once
// Maps for tests of the planner: 25.6 m x 25.6 m of 10 cm cells, walls all round.
#include <cstdint>
#include <string>
#include <vector>

#include "planner/mapping/evidence_map.h"
#include "planner/paper/mark_stages.h"

namespace jaywalk::test {

/// A small generator of our own: the same numbers everywhere.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed * 2654435769U + 88172645463325252U) {}
  std::uint32_t next() {
    state_ ^= state_ << 13;
    state_ ^= state_ >> 7;
    state_ ^= state_ << 17;
    return static_cast<std::uint32_t>(state_ >> 32);
  }
  std::int32_t below(std::int32_t n) { return static_cast<std::int32_t>(next() % static_cast<std::uint32_t>(n)); }
  double unit() { return next() / 4294967296.0; }

 private:
  std::uint64_t state_;
};

struct TestMap {
  std::string name;
  std::int32_t side;
  std::vector<std::uint8_t> wall;

  TestMap(std::string map_name, std::int32_t cells)
      : name(std::move(map_name)), side(cells), wall(static_cast<std::size_t>(cells * cells), 0) {
    box(0, 0, side, 1), box(0, side - 1, side, side), box(0, 0, 1, side), box(side - 1, 0, side, side);
  }
  std::uint8_t& at(std::int32_t i, std::int32_t j) { return wall[static_cast<std::size_t>(j * side + i)]; }
  /// Fills cells [i0, i1) x [j0, j1), clipped.
  void box(std::int32_t i0, std::int32_t j0, std::int32_t i1, std::int32_t j1, std::uint8_t value = paper::kWall) {
    for (std::int32_t j = j0 < 0 ? 0 : j0; j < j1 && j < side; ++j) {
      for (std::int32_t i = i0 < 0 ? 0 : i0; i < i1 && i < side; ++i) at(i, j) = value;
    }
  }
  /// Walls two cells thick about [low, high) x [low, high), within it.
  TestMap& frame(std::int32_t low, std::int32_t high) {
    box(low, low, high, low + 2), box(low, high - 2, high, high);
    box(low, low, low + 2, high), box(high - 2, low, high, high);
    return *this;
  }
};

/// Three rooms of 6.4 m, doors between them, and a shelf in the third.
inline TestMap rooms() {
  TestMap map("rooms", 64);
  map.box(20, 0, 22, 44), map.box(42, 20, 44, 64), map.box(42, 8, 54, 10);
  return map;
}

inline TestMap open_room() { return {"open", 256}; }

/// Rooms on either side of a corridor, doors 1.2 m wide.
inline TestMap office() {
  TestMap map("office", 256);
  map.box(0, 110, 256, 112), map.box(0, 144, 256, 146);
  for (std::int32_t i = 50; i < 256; i += 50) map.box(i, 0, i + 2, 110), map.box(i, 146, i + 2, 256);
  for (std::int32_t i = 20; i < 256; i += 50) map.box(i, 110, i + 12, 112, 0), map.box(i + 8, 144, i + 20, 146, 0);
  map.box(50, 60, 52, 72, 0), map.box(150, 190, 152, 202, 0);
  return map;
}

/// One long way there and back, `corridor` cells wide, behind walls two cells thick.
inline TestMap serpentine(std::int32_t corridor) {
  TestMap map("serpentine " + std::to_string(corridor), 256);
  bool gap_right = true;
  for (std::int32_t j = 1 + corridor; j + corridor < 255; j += corridor + 2, gap_right = !gap_right) {
    map.box(0, j, 256, j + 2);
    if (gap_right) {
      map.box(255 - corridor, j, 255, j + 2, 0);
    } else {
      map.box(1, j, 1 + corridor, j + 2, 0);
    }
  }
  return map;
}

inline TestMap clutter(std::uint64_t seed, std::int32_t pieces = 110) {
  TestMap map("clutter " + std::to_string(seed), 256);
  Random random(seed);
  for (std::int32_t k = 0; k < pieces; ++k) {
    const std::int32_t i = 1 + random.below(250), j = 1 + random.below(250);
    const std::int32_t w = 2 + random.below(9), h = 2 + random.below(9);
    map.box(i, j, i + w, j + h);
  }
  map.box(4, 4, 24, 24, 0), map.box(232, 232, 252, 252, 0);
  return map;
}

/// Every cell a wall with a chance of 2 in 1000: the hardest for descent.
inline TestMap speckle(std::uint64_t seed) {
  TestMap map("speckle " + std::to_string(seed), 256);
  Random random(seed);
  for (std::uint8_t& cell : map.wall) {
    if (random.below(1000) < 2) cell = paper::kWall;
  }
  map.box(4, 4, 24, 24, 0), map.box(232, 232, 252, 252, 0);
  return map;
}

/// The map as evidence, its cell (0, 0) the world's.
inline EvidenceMap evidence_of(const TestMap& map) {
  const double middle = map.side * 0.05;
  EvidenceMap evidence(2 * map.side, 0.1, {middle, middle});
  for (std::int32_t c = 0; c < map.side * map.side; ++c) {
    const bool is_wall = map.wall[static_cast<std::size_t>(c)] != 0;
    if (is_wall) evidence.add({c % map.side, c / map.side}, EvidenceMap::kMax);
  }
  return evidence;
}

}  // namespace jaywalk::test
