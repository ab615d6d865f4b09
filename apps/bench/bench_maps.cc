#include <algorithm>
#include <optional>

#include "apps/bench/bench.h"
#include "apps/jaywalk/map_cells.h"
#include "hal/types/errors.h"

namespace jaywalk {
namespace {

BenchMap walled(std::string name, std::int32_t side) {
  const auto n = static_cast<std::size_t>(side);
  BenchMap map{std::move(name), {side, side, std::vector<std::uint8_t>(n * n, 0)}, {12, 12}, {side - 12, 12}};
  for (std::size_t k = 0; k < n; ++k)
    map.cells.wall[k] = map.cells.wall[(n - 1) * n + k] = map.cells.wall[k * n] = map.cells.wall[k * n + n - 1] = 1;
  return map;
}

/// Cells [i0, i1) x [j0, j1), clipped to what lies inside the outer walls.
struct Cells {
  std::int32_t i0, j0, i1, j1;
};

void set(BenchMap& map, const Cells& cells, std::uint8_t value) {
  const std::int32_t side = map.cells.width;
  for (std::int32_t j = std::max(cells.j0, 1); j < std::min(cells.j1, side - 1); ++j) {
    for (std::int32_t i = std::max(cells.i0, 1); i < std::min(cells.i1, side - 1); ++i) {
      map.cells.wall[static_cast<std::size_t>(j) * static_cast<std::size_t>(side) + static_cast<std::size_t>(i)] =
          value;
    }
  }
}

/// Rooms of 5 m on both sides of corridors 3 m wide, doors 1.2 m.
BenchMap office(std::int32_t side) {
  BenchMap map = walled("office", side);
  constexpr std::int32_t kRoom = 50, kCorridor = 30, kDoor = 12, kPeriod = 2 * kRoom + kCorridor;
  for (std::int32_t j = kRoom; j < side; j += kPeriod)
    set(map, {0, j, side, j + 2}, 1), set(map, {0, j + kCorridor, side, j + kCorridor + 2}, 1);
  for (std::int32_t i = kRoom; i < side; i += kRoom) set(map, {i, 0, i + 2, side}, 1);
  for (std::int32_t j = kRoom; j < side; j += kPeriod) {
    set(map, {0, j + 2, side, j + kCorridor}, 0);
    for (std::int32_t i = 20; i < side; i += kRoom)
      set(map, {i, j, i + kDoor, j + 2}, 0), set(map, {i, j + kCorridor, i + kDoor, j + kCorridor + 2}, 0);
    // One door between rooms that lie back to back, so that corridors are joined.
    set(map, {20, j + kCorridor + kRoom - 6, 32, j + kCorridor + kRoom + 6}, 0);
  }
  return map;
}

BenchMap serpentine(std::int32_t side, std::int32_t corridor) {
  BenchMap map = walled(corridor == 15 ? "corridor 1.5 m" : "corridor 1.0 m", side);
  bool right = true;
  for (std::int32_t j = 1 + corridor; j + corridor < side - 1; j += corridor + 2, right = !right)
    set(map, {right ? 0 : 1 + corridor, j, right ? side - 1 - corridor : side, j + 2}, 1);
  map.goal = {12, 5};
  map.start = {side - 12, 5};
  return map;
}

BenchMap clutter(std::int32_t side) {
  BenchMap map = walled("clutter", side);
  std::uint32_t state = 12345;
  const auto below = [&state](std::int32_t n) {  // Numerical Recipes' congruential generator, high bits
    state = state * 1664525U + 1013904223U;
    return static_cast<std::int32_t>((state >> 8) % static_cast<std::uint32_t>(n));
  };
  for (std::int32_t k = 0; k < side * side / 600; ++k) {
    const std::int32_t i = 1 + below(side), j = 1 + below(side);
    const std::int32_t w = 2 + below(9), h = 2 + below(9);
    set(map, {i, j, i + w, j + h}, 1);
  }
  set(map, {4, 4, 24, 24}, 0);
  return map;
}

}  // namespace

std::vector<BenchMap> bench_maps(std::int32_t side) {
  return {walled("open", side), office(side), serpentine(side, 15), serpentine(side, 10), clutter(side)};
}

BenchMap scaled_map(const std::filesystem::path& file, std::int32_t side) {
  const MapCells coarse = load_map_cells(file, std::nullopt);
  const double extent = std::max(coarse.cells.width, coarse.cells.height) * coarse.cell_m;
  const MapCells fine = load_map_cells(file, extent / (side - 4));
  const auto n = static_cast<std::size_t>(side);
  BenchMap map{file.stem().string(), {side, side, std::vector<std::uint8_t>(n * n, 1)}, {}, {}};
  for (std::int32_t j = 0; j < fine.cells.height; ++j) {
    const auto row = fine.cells.wall.begin() + static_cast<std::ptrdiff_t>(j) * fine.cells.width;
    std::copy(row, row + fine.cells.width, map.cells.wall.begin() + static_cast<std::ptrdiff_t>(j) * side);
  }
  const auto field = paper::make_cpu_map_field(map.cells);
  field->inflate(kBenchInflation);
  map.goal = {fine.cells.width / 2, fine.cells.height / 2};
  map.start = {fine.cells.width - 12, fine.cells.height - 12};
  if (!field->nearest_free(map.goal, side) || !field->nearest_free(map.start, side))
    throw StartupError(file.string() + ": no free cell", "give a map with room for a robot");
  return map;
}

}  // namespace jaywalk
