#include "firmware/commands/bench_command.h"

#include <array>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "firmware/commands/bench_maps.h"
#include "firmware/commands/bench_rivals.h"
#include "firmware/report/distribution.h"
#include "hal/types/errors.h"
#include "planner/planner.h"

namespace jaywalk {
namespace {

constexpr float kInflation = 3.0F;  ///< cells
constexpr double kCell_m = 0.1;

struct Timing {
  std::string what;
  double p50_ms = 0.0, p99_ms = 0.0;
};

/// Processor time of this one thread: what other programs take meanwhile does not count.
template <class Work>
Timing time(const char* what, int repeats, const Work& work) {
  Distribution took_ms;
  for (int k = 0; k < repeats; ++k) {
    const std::clock_t begin = std::clock();
    work();
    took_ms.add(1e3 * static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC);
  }
  return {what, took_ms.quantile(0.5), took_ms.quantile(0.99)};
}

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

/// The whole plan under way: robot and eight movers move on from tick to tick.
Timing time_plan(const BenchMap& map, int repeats) {
  const std::int32_t side = map.cells.width;
  PlannerConfig config;
  config.side_cells = config.max_side_cells = side;
  const auto planner = make_cpu_planner(config);
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
  request.map_from_robot = {(side - 12) * kCell_m, request.goal_in_map.y, 0.0};
  std::array<Track, 8> tracks = walkers(side * kCell_m);
  request.moving = tracks;
  return time("plan, 8 movers", repeats, [&] {
    constexpr double kScan_s = 1.0 / 15.0;
    request.map_from_robot.x -= request.speed_mps * kScan_s;
    for (Track& track : tracks) track.position_in_map = track.position_in_map + track.velocity_in_map * kScan_s;
    planner->submit(request);
    (void)planner->collect();
  });
}

class Bench {
 public:
  void measure(const BenchMap& map) {
    field::MapField field(map.cells);
    field.inflate(kInflation);
    const std::int32_t side = map.cells.width;
    const int repeats = side >= 2048 ? 3 : side >= 1024 ? 7 : side >= 512 ? 15 : 41;
    bool certified = true;
    const Timing cold = time("cold solve", repeats, [&] { certified &= field.solve_cold(map.goal).certified; });
    const Timing warm = time("warm solve", repeats, [&] { certified &= field.solve_warm(map.goal).certified; });
    const std::vector<Timing> rivals = time_rivals(map, field, repeats);
    for (const Timing& rival : rivals) add(map, rival, rival);
    for (const Timing& own : {cold, warm}) {
      for (const Timing& rival : rivals) add(map, own, rival);
    }
    if (side <= 1024) {
      const Timing plan = time_plan(map, repeats);
      for (const Timing& rival : rivals) add(map, plan, rival);
    }
    if (!certified) std::printf("%s, %d: not certified\n", map.name.c_str(), side);
  }

  [[nodiscard]] const nlohmann::ordered_json& rows() const { return rows_; }

 private:
  static std::vector<Timing> time_rivals(const BenchMap& map, const field::MapField& field, int repeats) {
    const std::int32_t side = map.cells.width;
    std::vector<std::uint8_t> free;
    for (std::int32_t j = 0; j < side; ++j) {
      for (std::int32_t i = 0; i < side; ++i) free.push_back(std::isnan(field.psi(i, j)) ? 0 : 1);
    }
    BenchRivals rivals(side, side, std::move(free));
    return {time("wavefront", repeats, [&] { rivals.wavefront(map.goal); }),
            time("dijkstra, buckets", repeats, [&] { rivals.dijkstra_buckets(map.goal); }),
            time("dijkstra, heap", repeats, [&] { rivals.dijkstra_heap(map.goal); }),
            time("100 sweeps", repeats, [&] { rivals.hundred_sweeps(map.goal); })};
  }

  void add(const BenchMap& map, const Timing& own, const Timing& baseline) {
    const double ratio = own.p50_ms / baseline.p50_ms;
    const std::int32_t side = map.cells.width;
    rows_.push_back({{"what", own.what},
                     {"map", map.name},
                     {"size", side},
                     {"backend", "cpu"},
                     {"p50_ms", own.p50_ms},
                     {"p99_ms", own.p99_ms},
                     {"baseline", baseline.what},
                     {"ratio", ratio}});
    std::printf("%-18s %-15s %5d  cpu  %9.3f %9.3f  %-18s %7.2f\n", own.what.c_str(), map.name.c_str(), side,
                own.p50_ms, own.p99_ms, baseline.what.c_str(), ratio);
  }

  nlohmann::ordered_json rows_ = nlohmann::ordered_json::array();
};

}  // namespace

int run_bench(const BenchOptions& options) {
  std::ofstream out;
  if (options.json) {
    out.open(*options.json);
    if (!out) throw StartupError(options.json->string() + ":0: cannot be written", "choose another --json");
  }
  std::printf("%-18s %-15s %5s  %-4s %9s %9s  %-18s %7s\n", "what", "map", "size", "on", "p50_ms", "p99_ms", "baseline",
              "ratio");
  Bench bench;
  for (std::int32_t side = 256; side <= options.largest; side *= 2) {
    for (const BenchMap& map : bench_maps(side)) bench.measure(map);
  }
  if (options.json) out << bench.rows().dump(1) << '\n';
  return 0;
}

}  // namespace jaywalk
