#pragma once
// Maps of many kinds, to try the solver where nobody has tuned it. The same bytes on every machine.
#include <cstdint>

#include "planner/paper/map_field.h"

namespace jaywalk {
enum class MapKind : std::uint8_t {
  kRooms,  ///< rooms within rooms, walls two cells thick, one or two doors 8 to 17 cells wide each
  kCave,   ///< rock with ragged passages of any width
  kMaze,   ///< one way between any two places, corridors 8 to 21 cells wide
  kBoxes,  ///< up to 300 boxes of up to 40 cells a side thrown in; free to the border
};
inline constexpr MapKind kMapKinds[] = {MapKind::kRooms, MapKind::kCave, MapKind::kMaze, MapKind::kBoxes};
[[nodiscard]] const char* name_of(MapKind kind);

/// A generator of our own (xorshift): what the standard's distributions give depends on the library.
class MapRandom {
 public:
  explicit MapRandom(std::uint64_t seed) : state_(seed * 2654435769U + 88172645463325252U) {}
  /// From 0 to n - 1.
  std::int32_t below(std::int32_t n);

 private:
  std::uint64_t state_;
};

/// `side` x `side` cells.
[[nodiscard]] paper::CellMap random_map(MapKind kind, std::int32_t side, MapRandom& random);

}  // namespace jaywalk
