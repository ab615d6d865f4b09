#pragma once
// Maps of every shape, and one executor's fields of them against the serial one's, byte by byte.
#include <vector>

#include "bench/field/random_maps.h"
#include "planner/paper/map_field.h"
#include "tests/planner/same_bytes.h"
#include "tests/support/catch.h"

namespace jaywalk::test {

inline paper::CellMap filled_map(std::int32_t width, std::int32_t height, std::uint8_t value = 0) {
  return {width, height, std::vector<std::uint8_t>(static_cast<std::size_t>(width * height), value)};
}

/// Empty, a column, a row, odd with one wall, all wall but for a cell, and one of each random kind.
inline std::vector<paper::CellMap> shaped_maps() {
  std::vector<paper::CellMap> maps{filled_map(64, 64), filled_map(1, 65), filled_map(130, 1), filled_map(33, 47),
                                   filled_map(9, 9, 1)};
  for (std::size_t i = 10; i < 33; ++i) maps[3].wall[20 * 33 + i] = 1;
  maps[4].wall[40] = 0;
  MapRandom random(7);
  for (const MapKind kind : kMapKinds) maps.push_back(random_map(kind, 100, random));
  return maps;
}

/// Walls inside, and a grid that is solved as large ones are.
inline paper::CellMap large_map() {
  paper::CellMap map = filled_map(600, 400);
  for (std::size_t j = 100; j < 300; ++j) map.wall[j * 600 + 200] = map.wall[j * 600 + 400] = 1;
  return map;
}

/// Cold and warm.
inline void check_field(const paper::CellMap& map, paper::MapField& other) {
  const auto serial = paper::make_cpu_map_field(map);
  CellIndex goal{0, 0};
  REQUIRE(serial->nearest_free(goal, 100));
  for (const bool cold : {true, false}) {
    const paper::FieldQuality a = cold ? serial->solve_cold(goal) : serial->solve_warm(goal);
    const paper::FieldQuality b = cold ? other.solve_cold(goal) : other.solve_warm(goal);
    CHECK(a.certified);
    CHECK(b.certified);
    CHECK(a.joined == b.joined);
    CHECK(a.cycles == b.cycles);
    int differ = 0;
    for (std::int32_t c = 0; c < map.width * map.height; ++c) {
      const float x = serial->psi(c % map.width, c / map.width), y = other.psi(c % map.width, c / map.width);
      differ += same(&x, &y, 1) ? 0 : 1;
    }
    CHECK(differ == 0);
  }
}

}  // namespace jaywalk::test
