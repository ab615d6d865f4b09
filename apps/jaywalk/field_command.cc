#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "apps/bench/bench.h"
#include "apps/jaywalk/commands.h"
#include "apps/rivals/paper_mode.h"
#include "firmware/program/program.h"
#include "hal/shown_text.h"
#include "hal/text_file.h"
#include "hal/types/errors.h"

namespace jaywalk {
namespace {

struct FieldOptions {
  std::filesystem::path map;     ///< .yaml (map_server), .map (ARIA), .txt (cylinders), .png or .pgm
  std::optional<Vec2> goal;      ///< in the map; default: the free cell nearest its middle
  double inflation_m = 0.3;      ///< walls grow by this
  std::optional<double> cell_m;  ///< of a picture without a YAML file, or of what has no cells (default there: 0.1 m)
  Backend backend = Backend::kAuto;
  int device = 0;           ///< CUDA's number
  bool start_only = false;  ///< the start field alone: shortest ways, no potential solved
  std::filesystem::path out = "out/field";
};

using paper::FieldQuality;
using paper::MapField;

/// A goal that is not free is replaced by the nearest cell this near.
constexpr double kGoalRadius_m = 0.5;
constexpr int kRepeats = 9;

std::int32_t cell_number(double metres, double cell_m) {
  return static_cast<std::int32_t>(std::floor(std::clamp(metres / cell_m, -1e6, 1e6)));
}

/// Nobody is to take the field for that of another goal.
void tell_moved_goal(const FieldOptions& options, const MapCells& map, CellIndex asked, CellIndex at) {
  if (!options.goal || (asked.i == at.i && asked.j == at.j)) return;
  const Vec2 to = map.map_from_cells * Vec2{(at.i + 0.5) * map.cell_m, (at.j + 0.5) * map.cell_m};
  const std::string text =
      formatted("jaywalk: --goal %.2f,%.2f lies in a wall or too near one; the field leads to %.2f,%.2f\n",
                options.goal->x, options.goal->y, to.x, to.y);
  std::fputs(text.c_str(), stderr);
}

CellIndex goal_cell(const FieldOptions& options, const MapCells& map, const MapField& solver) {
  CellIndex at{map.cells.width / 2, map.cells.height / 2};
  std::int32_t radius = map.cells.width + map.cells.height;
  if (options.goal) {
    const Vec2 in_cells = inverse(map.map_from_cells) * *options.goal;
    at = {cell_number(in_cells.x, map.cell_m), cell_number(in_cells.y, map.cell_m)};
    radius = cell_number(kGoalRadius_m, map.cell_m);
  }
  const CellIndex asked = at;
  if (!solver.nearest_free(at, radius)) {
    throw StartupError(
        options.map.string() + ": no free cell " + (options.goal ? "within 0.5 m of the goal" : "at all"),
        "give another --goal, or a smaller --inflation");
  }
  tell_moved_goal(options, map, asked, at);
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
  if (!out.flush()) throw StartupError(file.string() + ": cannot be written", "choose another --out");
}

/// For a person: the share of cells that pick the exact field's best neighbour.
std::string best_in_words(const std::optional<double>& best) {
  if (!best) return "best neighbours not counted (too many cells)";
  return formatted("%.3f %% pick the best neighbour", 100.0 * *best);
}

int run_field(const FieldOptions& options) {
  if (!(options.inflation_m >= 0.0 && options.inflation_m <= 5.0))
    throw StartupError("--inflation: outside 0 to 5 m", "give the robot's radius and a margin");
  const MapCells map = load_map_cells(options.map, options.cell_m);
  const std::unique_ptr<MapField> chosen = make_map_field(map.cells, options.backend, options.device);
  MapField& solver = *chosen;
  solver.inflate(static_cast<float>(options.inflation_m / map.cell_m));
  const CellIndex goal = goal_cell(options, map, solver);
  const auto solve = [&] { return options.start_only ? solver.solve_start(goal) : solver.solve_cold(goal); };
  FieldQuality warm, cold;
  const Timing cold_time = time("cold", kRepeats, solver.backend(), [&] { cold = solve(); });
  const Timing warm_time = time("warm", kRepeats, solver.backend(), [&] { warm = solver.solve_warm(goal); });
  cold = solve();
  const float reach = solver.reach(goal);
  const std::optional<double> best = solver.best_neighbours(goal, paper::kMostMultiplications);
  std::error_code failed;
  std::filesystem::create_directories(options.out, failed);
  write_npy(options.out / "field.npy", map, solver);
  nlohmann::ordered_json json{{"certified", cold.certified},
                              {"reach", reach},
                              {"cycles", cold.cycles},
                              {"cold_ms", cold_time.p50_ms},
                              {"warm_ms", warm_time.p50_ms},
                              {"backend", solver.backend()},
                              {"warm_certified", warm.certified},
                              {"joined_cells", cold.joined},
                              {"best_neighbours", best ? nlohmann::ordered_json(*best) : nullptr}};
  write_text(options.out / "field.json", json.dump(2) + "\n", "choose another --out");
  std::printf("%s: %d x %d cells, %s, reach %.4f, %s, cold %.2f ms, warm %.2f ms on %s; see %s\n", options.map.c_str(),
              map.cells.width, map.cells.height, cold.certified ? "certified" : "not certified",
              static_cast<double>(reach), best_in_words(best).c_str(), cold_time.p50_ms, warm_time.p50_ms,
              solver.backend(), (options.out / "field.npy").c_str());
  return cold.certified ? 0 : 1;
}

}  // namespace

void add_field(CLI::App& app, int& exit_code) {
  static FieldOptions options;
  CLI::App* field = app.add_subcommand("field", "The potential field of a map alone");
  field->add_option("map", options.map, "map_server YAML, ARIA .map, cylinders .txt, or a picture")->required();
  add_place(*field, "--goal", options.goal, "Goal X,Y in the map (default: the free cell nearest its middle)");
  field->add_option("--inflation,--inflation_m", options.inflation_m, "Walls grow by this (m)")->capture_default_str();
  field->add_option("--resolution", options.cell_m, "Metres a cell: of a picture, of lines or cylinders");
  add_backend(*field, options.backend, options.device);
  field->add_flag("--start-field", options.start_only, "The start field alone: shortest ways, no potential solved");
  field->add_option("--out", options.out, "Folder for field.npy and field.json")->capture_default_str();
  field->callback([&exit_code] { exit_code = run_field(options); });
}

}  // namespace jaywalk
