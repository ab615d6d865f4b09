#include <array>
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

constexpr int kDecisions = 101;
constexpr std::int32_t kTickCells = 256;  // what a loop sees around it

/// Movers that walk about, so that no two submissions are alike.
std::array<Track, 8> walkers(double side_m) {
  std::array<Track, 8> tracks{};
  for (std::size_t k = 0; k < tracks.size(); ++k) {
    const double share = (static_cast<double>(k) + 0.5) / static_cast<double>(tracks.size());
    tracks[k] = walker_at(k, {side_m * share, side_m * (1.0 - 0.5 * share)}, {k % 2 == 0 ? 0.4 : -0.4, 0.2});
  }
  return tracks;
}

/// The whole plan under way, of the robot's planner or, `by_potential`, of the paper's: robot and eight movers move on
/// from tick to tick. By the time to go they are bodies that are no walls, half of them such as ways past are preferred
/// to.
Timing time_plan(const BenchMap& map, bool by_potential, Backend backend, int repeats) {
  const std::int32_t side = map.cells.width;
  paper::PaperConfig config;
  config.side_cells = config.max_side_cells = side;
  const auto chosen = by_potential ? make_paper_planner(config, backend) : make_planner(config, backend);
  Planner& planner = *chosen.planner;
  const EvidenceMap evidence = evidence_of(map, 0);
  const Vec2 start = middle_of(map.start);
  PlanRequest request;
  request.still = &evidence;
  request.speed_mps = 0.6;
  request.goal_in_map = middle_of(map.goal);
  request.map_from_robot = {start.x, start.y, 0.0};
  std::array<Track, 8> tracks = walkers(side * kBenchCell_m);
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
    const auto cold = [&] {
      quality = field.solve_cold(map.goal);
      certified &= quality.certified;
    };
    const auto warm = [&] { certified &= field.solve_warm(map.goal).certified; };
    std::vector<Timing> own{time("cold solve", repeats, field.backend(), cold)};
    progress_.make_way();
    std::printf("%s, %d: reach %.4f, %d cycles, best neighbours %s\n", map.name.c_str(), map.cells.width,
                static_cast<double>(field.reach(map.goal)), quality.cycles, best_neighbours(field, map.goal).c_str());
    own.push_back(time("warm solve", repeats, field.backend(), warm));
    if (backend == Backend::kCuda) {  // by the device's own events, as often as their quantiles want
      constexpr int kEventRepeats = 1000;
      const auto events_ms = [&] { return field.device_ms(); };
      own.push_back(time("cold, by events", kEventRepeats, field.backend(), cold, events_ms));
      own.push_back(time("warm, by events", kEventRepeats, field.backend(), warm, events_ms));
    }
    for (const bool by_potential : {true, false})
      if (map.cells.width <= 1024 && (by_potential || backend == Backend::kCpu))
        own.push_back(time_plan(map, by_potential, backend, repeats));
    if (map.cells.width <= kTickCells) {
      own.push_back(time_tick(map, walkers(map.cells.width * kBenchCell_m), backend, repeats));
      if (backend == Backend::kCpu)
        for (const int movers : {16, 64}) own.push_back(time_decision(map, movers, kDecisions));
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

int run_bench(const BenchOptions& options) {
  const std::vector<BenchMap> maps = all_maps(options);
  // Before minutes of measuring, and without harm to what the file holds.
  if (options.json && !std::ofstream(*options.json, std::ios::app))
    throw StartupError(options.json->string() + ": cannot be written", "choose another --json");
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
