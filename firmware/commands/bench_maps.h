#pragma once
#include <string>
#include <vector>

#include "planner/field/map_field.h"

namespace jaywalk {

/// A map to measure on, with a goal that is free after an inflation of three cells.
struct BenchMap {
  std::string name;
  field::CellMap cells;
  CellIndex goal;
};

/// Open room, office, serpentine corridors 1.5 m and 1.0 m wide, clutter: `side` cells of 0.1 m a side, walls all
/// round. The same bytes on every machine.
[[nodiscard]] std::vector<BenchMap> bench_maps(std::int32_t side);

}  // namespace jaywalk
