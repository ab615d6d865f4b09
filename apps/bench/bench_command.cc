#include <array>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "apps/bench/bench.h"
#include "apps/jaywalk/commands.h"
#include "apps/jaywalk/progress.h"
#include "apps/rivals/paper_mode.h"
#include "hal/text_file.h"
#include "hal/types/errors.h"

namespace jaywalk {
namespace {

struct BenchOptions {
  std::optional<std::filesystem::path> json;  ///< file for the rows; the table on the terminal comes always
  int largest = 2048;                         ///< cells a side
  std::optional<std::filesystem::path> map;   ///< one more map, of lines or discs, scaled to each size
};

BenchOptions bench_options;

constexpr double kCell_m = 0.1;
constexpr int kDecisions = 101;
constexpr std::int32_t kTickCells = 256;  // what a loop sees around it

/// Movers that walk about, so that no two submissions are alike.
std::array<Track, 8> walkers(double side_m) {
  std::array<Track, 8> tracks{};
  for (std::size_t k = 0; k < tracks.size(); ++k) {
    const double share = (static_cast<double>(k) + 0.5) / static_cast<double>(tracks.size());
    tracks[k].id = static_cast<std::uint32_t>(k + 1);
    tracks[k].position_in_map = {side_m * share, side_m * (1.0 - 0.5 * share)};
    tracks[k].velocity_in_map = {k % 2 == 0 ? 0.4 : -0.4, 0.2};
    tracks[k].covariance = {0.001, 0.0, 0.002};
    tracks[k].radius_m = 0.27;
  }
  return tracks;
}

/// Planner to measure: that of the robot, or the paper's.
enum class PlanOf { kTimeToGo, kPotential };

/// The whole plan under way: robot and eight movers move on from tick to tick. By the time to go they are bodies that
/// are no walls, half of them such as ways past are preferred to.
Timing time_plan(const BenchMap& map, PlanOf what, Backend backend, int repeats) {
  const std::int32_t side = map.cells.width;
  paper::PaperConfig config;
  config.side_cells = config.max_side_cells = side;
  const bool by_potential = what == PlanOf::kPotential;
  const auto chosen = by_potential ? make_paper_planner(config, backend) : make_planner(config, backend);
  Planner& planner = *chosen.planner;
  const double middle_m = side * kCell_m / 2.0;
  EvidenceMap evidence(2 * side, kCell_m, {middle_m, middle_m});
  for (std::int32_t j = 0; j < side; ++j) {
    for (std::int32_t i = 0; i < side; ++i) {
      const auto c = static_cast<std::size_t>(j) * static_cast<std::size_t>(side) + static_cast<std::size_t>(i);
      if (map.cells.wall[c] != 0) evidence.add({i, j}, EvidenceMap::kMax);
    }
  }
  PlanRequest request;
  request.still = &evidence;
  request.speed_mps = 0.6;
  request.goal_in_map = {(map.goal.i + 0.5) * kCell_m, (map.goal.j + 0.5) * kCell_m};
  request.map_from_robot = {(map.start.i + 0.5) * kCell_m, (map.start.j + 0.5) * kCell_m, 0.0};
  std::array<Track, 8> tracks = walkers(side * kCell_m);
  std::array<MoverDisc, tracks.size()> bodies;
  std::array<StandingPedestrian, tracks.size() / 2> standing;
  if (by_potential)
    request.moving = tracks;
  else
    request.masked = bodies, request.standing = standing;
  const char* const name = by_potential ? "potential, 8 movers" : "plan, 8 movers";
  return time(name, repeats, planner.backend(), [&] {
    constexpr double kScan_s = 1.0 / 15.0;
    request.map_from_robot.x -= request.speed_mps * kScan_s;
    for (std::size_t k = 0; k < tracks.size(); ++k) {
      Track& track = tracks[k];
      track.position_in_map = track.position_in_map + track.velocity_in_map * kScan_s;
      bodies[k] = {track.position_in_map, track.radius_m};
      if (k % 2 == 0) standing[k / 2] = {track.position_in_map, track.radius_m};
    }
    planner.submit(request);
    (void)planner.collect();
  });
}

/// The same work by the device's own events, as often as its quantiles want.
template <class Work>
Timing time_on_device(const char* what, int repeats, const paper::MapField& field, const Work& work) {
  Distribution took_ms;
  for (int k = 0; k < repeats; ++k) {
    const double before_ms = field.device_ms();
    work();
    took_ms.add(field.device_ms() - before_ms);
  }
  return {what, took_ms.quantile(0.5), took_ms.quantile(0.99), field.backend()};
}

class Bench {
 public:
  /// `share`: of all maps, those measured before.
  void measure(const BenchMap& map, double share) {
    progress_.show(share, map.name + ", " + std::to_string(map.cells.width));
    const std::int32_t side = map.cells.width;
    const int repeats = side >= 2048 ? 3 : side >= 1024 ? 7 : side >= 512 ? 15 : 41;
    const std::vector<Timing> rivals = time_rivals(map, repeats);
    for (const Timing& rival : rivals) add(map, rival, rival);
    measure(map, *make_map_field(map.cells, Backend::kCpu), Backend::kCpu, repeats, rivals);
    const auto device = make_map_field(map.cells, Backend::kAuto);
    if (device->backend() != std::string("cpu")) measure(map, *device, Backend::kCuda, repeats, rivals);
  }

  /// One backend's solver and planner.
  void measure(const BenchMap& map, paper::MapField& field, Backend backend, int repeats,
               const std::vector<Timing>& rivals) {
    field.inflate(kBenchInflation);
    paper::MapQuality quality;
    bool certified = true;
    std::vector<Timing> own{time("cold solve", repeats, field.backend(), [&] {
      quality = field.solve_cold(map.goal);
      certified &= quality.certified;
    })};
    progress_.make_way();
    std::printf("%s, %d: reach %.4f, %d cycles, best neighbours %s\n", map.name.c_str(), map.cells.width,
                static_cast<double>(field.reach(map.goal)), quality.cycles, best_neighbours(field, map.goal).c_str());
    own.push_back(
        time("warm solve", repeats, field.backend(), [&] { certified &= field.solve_warm(map.goal).certified; }));
    if (backend == Backend::kCuda) {
      constexpr int kEventRepeats = 1000;
      own.push_back(time_on_device("cold, by events", kEventRepeats, field,
                                   [&] { certified &= field.solve_cold(map.goal).certified; }));
      own.push_back(time_on_device("warm, by events", kEventRepeats, field,
                                   [&] { certified &= field.solve_warm(map.goal).certified; }));
    }
    if (map.cells.width <= 1024) own.push_back(time_plan(map, PlanOf::kPotential, backend, repeats));
    if (map.cells.width <= 1024 && backend == Backend::kCpu)
      own.push_back(time_plan(map, PlanOf::kTimeToGo, backend, repeats));
    if (map.cells.width <= kTickCells) {
      own.push_back(time_tick(map, kCell_m, walkers(map.cells.width * kCell_m), backend, repeats));
      if (backend == Backend::kCpu)
        for (const int movers : {16, 64}) own.push_back(time_decision(map, kCell_m, movers, kDecisions));
    }
    for (const Timing& timing : own)
      for (const Timing& rival : rivals) add(map, timing, rival);
    if (!certified) std::printf("%s, %d: not certified\n", map.name.c_str(), map.cells.width);
  }

  [[nodiscard]] const nlohmann::ordered_json& rows() const { return rows_; }

 private:
  static std::string best_neighbours(const paper::MapField& field, CellIndex goal) {
    const std::optional<double> best = field.best_neighbours(goal, paper::kMostMultiplications);
    return best ? std::to_string(100.0 * *best) + " %" : "not counted (too many cells)";
  }

  static std::vector<Timing> time_rivals(const BenchMap& map, int repeats) {
    const std::int32_t side = map.cells.width;
    const auto field = paper::make_cpu_map_field(map.cells);
    field->inflate(kBenchInflation);
    (void)field->solve_start(map.goal);
    std::vector<std::uint8_t> free;
    for (std::int32_t j = 0; j < side; ++j)
      for (std::int32_t i = 0; i < side; ++i) free.push_back(std::isnan(field->psi(i, j)) ? 0 : 1);
    BenchRivals rivals(side, side, std::move(free));
    return {time("wavefront", repeats, "cpu", [&] { rivals.wavefront(map.goal); }),
            time("dijkstra, buckets", repeats, "cpu", [&] { rivals.dijkstra_buckets(map.goal); }),
            time("dijkstra, heap", repeats, "cpu", [&] { rivals.dijkstra_heap(map.goal); }),
            time("100 sweeps", repeats, "cpu", [&] { rivals.hundred_sweeps(map.goal); })};
  }

  void add(const BenchMap& map, const Timing& own, const Timing& baseline) {
    const double ratio = own.p50_ms / baseline.p50_ms;
    const std::int32_t side = map.cells.width;
    rows_.push_back({{"what", own.what},
                     {"map", map.name},
                     {"size", side},
                     {"backend", own.backend},
                     {"p50_ms", own.p50_ms},
                     {"p99_ms", own.p99_ms},
                     {"baseline", baseline.what},
                     {"ratio", ratio}});
    progress_.make_way();
    std::printf("%-19s %-15s %5d  %-4s %9.3f %9.3f  %-18s %7.2f\n", own.what.c_str(), map.name.c_str(), side,
                own.backend.c_str(), own.p50_ms, own.p99_ms, baseline.what.c_str(), ratio);
  }

  Progress progress_;
  nlohmann::ordered_json rows_ = nlohmann::ordered_json::array();
};

std::vector<BenchMap> all_maps(const BenchOptions& options) {
  std::vector<BenchMap> maps;
  for (std::int32_t side = 256; side <= options.largest; side *= 2) {
    for (BenchMap& map : bench_maps(side)) maps.push_back(std::move(map));
    if (options.map) maps.push_back(scaled_map(*options.map, side));
  }
  return maps;
}

/// Before minutes of measuring, and without harm to what the file holds.
void refuse_unwritable(const std::filesystem::path& file) {
  if (!std::ofstream(file, std::ios::app))
    throw StartupError(file.string() + ": cannot be written", "choose another --json");
}

int run_bench(const BenchOptions& options) {
  const std::vector<BenchMap> maps = all_maps(options);
  if (options.json) refuse_unwritable(*options.json);
  std::printf("%-19s %-15s %5s  %-4s %9s %9s  %-18s %7s\n", "what", "map", "size", "on", "p50_ms", "p99_ms", "baseline",
              "ratio");
  Bench bench;
  for (std::size_t k = 0; k < maps.size(); ++k)
    bench.measure(maps[k], static_cast<double>(k) / static_cast<double>(maps.size()));
  if (options.json) write_text(*options.json, bench.rows().dump(1) + "\n", "choose another --json");
  return 0;
}

}  // namespace

void add_bench(CLI::App& app, int& exit_code) {
  CLI::App* bench = app.add_subcommand("bench", "Measure solver and planner against what a user would pick instead");
  bench->add_option("--json", bench_options.json, "File for the rows");
  bench->add_option("--map", bench_options.map, "One more map (.map or .txt), scaled to each size");
  bench->add_option("--largest", bench_options.largest, "Largest map, cells a side")
      ->check(CLI::IsMember({256, 512, 1024, 2048}))
      ->capture_default_str();
  bench->callback([&exit_code] { exit_code = run_bench(bench_options); });
}

}  // namespace jaywalk
