#include "firmware/commands/field_command.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "firmware/commands/map_cells.h"
#include "firmware/report/distribution.h"
#include "hal/types/errors.h"

namespace jaywalk {
namespace {

using field::MapField;
using field::MapQuality;

/// A goal that is not free is replaced by the nearest cell this near.
constexpr double kGoalRadius_m = 0.5;
constexpr int kRepeats = 9;

/// Median processor time of one solution: what other programs take meanwhile does not count.
template <class Solve>
double median_ms(const Solve& solve) {
  Distribution took_ms;
  for (int k = 0; k < kRepeats; ++k) {
    const std::clock_t begin = std::clock();
    solve();
    took_ms.add(1e3 * static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC);
  }
  return took_ms.quantile(0.5);
}

std::int32_t cell_number(double metres, double cell_m) {
  return static_cast<std::int32_t>(std::floor(std::clamp(metres / cell_m, -1e6, 1e6)));
}

CellIndex goal_cell(const FieldOptions& options, const MapCells& map, const MapField& solver) {
  CellIndex at{map.cells.width / 2, map.cells.height / 2};
  std::int32_t radius = map.cells.width + map.cells.height;
  if (options.goal) {
    const Vec2 in_cells = inverse(map.map_from_cells) * *options.goal;
    at = {cell_number(in_cells.x, map.cell_m), cell_number(in_cells.y, map.cell_m)};
    radius = cell_number(kGoalRadius_m, map.cell_m);
  }
  if (!solver.nearest_free(at, radius)) {
    throw StartupError(
        options.map.string() + ":0: no free cell " + (options.goal ? "within 0.5 m of the goal" : "at all"),
        "give another --goal, or a smaller --inflation_m");
  }
  return at;
}

/// NumPy's format 1.0: magic, version, length of a header that ends at a multiple of 64 bytes, values.
void write_npy(const std::filesystem::path& file, const MapCells& map, const MapField& solver) {
  std::string header = "{'descr': '<f4', 'fortran_order': False, 'shape': (" + std::to_string(map.cells.height) + ", " +
                       std::to_string(map.cells.width) + "), }";
  header.resize((10 + header.size() + 1 + 63) / 64 * 64 - 10 - 1, ' ');
  header += '\n';
  std::ofstream out(file, std::ios::binary);
  out.write("\x93NUMPY\x01\x00", 8);
  out.put(static_cast<char>(header.size() & 0xff)).put(static_cast<char>(header.size() >> 8));
  out << header;
  for (std::int32_t j = map.cells.height - 1; j >= 0; --j) {
    for (std::int32_t i = 0; i < map.cells.width; ++i) {
      const float psi = solver.psi(i, j);
      out.write(reinterpret_cast<const char*>(&psi), sizeof psi);  // all our machines are little-endian
    }
  }
  if (!out.flush()) throw StartupError(file.string() + ":0: cannot be written", "choose another --out");
}

void write_json(const std::filesystem::path& file, const nlohmann::ordered_json& json) {
  std::ofstream out(file);
  out << json.dump(2) << '\n';
  if (!out.flush()) throw StartupError(file.string() + ":0: cannot be written", "choose another --out");
}

}  // namespace

int run_field(const FieldOptions& options) {
  if (!(options.inflation_m >= 0.0 && options.inflation_m <= 5.0)) {
    throw StartupError("--inflation_m: outside 0 to 5 m", "give the robot's radius and a margin");
  }
  const MapCells map = load_map_cells(options.map, options.cell_m);
  MapField solver(map.cells);
  solver.inflate(static_cast<float>(options.inflation_m / map.cell_m));
  const CellIndex goal = goal_cell(options, map, solver);
  MapQuality warm, cold;
  const double cold_ms = median_ms([&] { cold = solver.solve_cold(goal); });
  const double warm_ms = median_ms([&] { warm = solver.solve_warm(goal); });
  cold = solver.solve_cold(goal);
  const float reach = solver.reach(goal);
  std::error_code failed;
  std::filesystem::create_directories(options.out, failed);
  write_npy(options.out / "field.npy", map, solver);
  write_json(options.out / "field.json", {{"certified", cold.certified},
                                          {"reach", reach},
                                          {"cycles", cold.cycles},
                                          {"cold_ms", cold_ms},
                                          {"warm_ms", warm_ms},
                                          {"backend", "cpu"},
                                          {"warm_certified", warm.certified},
                                          {"joined_cells", cold.joined}});
  if (options.backend == Backend::kCuda) std::puts("cuda: not for a map alone; the CPU solves");
  std::printf("%s: %d x %d cells, %s, reach %.4f, cold %.2f ms, warm %.2f ms; see %s\n", options.map.c_str(),
              map.cells.width, map.cells.height, cold.certified ? "certified" : "not certified",
              static_cast<double>(reach), cold_ms, warm_ms, (options.out / "field.npy").c_str());
  return cold.certified ? 0 : 1;
}

}  // namespace jaywalk
