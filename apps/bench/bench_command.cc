#include <array>
#include <cstdio>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "apps/bench/bench.h"
#include "apps/jaywalk/commands.h"
#include "apps/jaywalk/progress.h"
#include "apps/rivals/paper_mode.h"
#include "firmware/backends.h"
#include "firmware/control_loop.h"
#include "firmware/recording/recorded_hal.h"
#include "hal/sim/sensors.h"
#include "hal/text_file.h"
#include "hal/types/errors.h"
#include "planner/motion/motion.h"

namespace jaywalk {
namespace {

struct BenchOptions {
  std::optional<std::filesystem::path> json;  ///< file for the rows; the table on the terminal comes always
  int largest = 2048;                         ///< cells a side
  std::optional<std::filesystem::path> map;   ///< one more map, of lines or discs, scaled to each size
};

BenchOptions bench_options;

constexpr double kScan_s = 1.0 / 15.0;
constexpr int kDecisions = 101;
constexpr int kDecisionsBefore = 15;      // by then every mover is known to walk
constexpr int kTicksBefore = 50;          // by then walkers are confirmed
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

/// Spread evenly over a disc of 8 m: radii by the square root, angles by the golden one.
std::vector<Track> walkers_round(Vec2 middle, int count) {
  std::vector<Track> tracks;
  for (int k = 0; k < count; ++k) {
    const Vec2 place = middle + direction(2.39996 * k) * (8.0 * sqrt((k + 0.5) / count));
    tracks.push_back(walker_at(static_cast<std::size_t>(k), place, direction(1.7 * k) * 0.4));
    tracks.back().moving = tracks.back().is_pedestrian = true;
  }
  return tracks;
}

ControlSetup setup_at(const BenchMap& map) {
  ControlSetup setup;
  setup.model = p3dx();
  setup.model.laser.rate_hz = setup.rate_hz;
  const Vec2 start = middle_of(map.start);
  setup.goal = middle_of(map.goal);
  setup.start = {start.x, start.y, atan2(setup.goal.y - start.y, setup.goal.x - start.x)};
  return setup;
}

/// Scans of all ticks, made before the timing begins.
std::vector<LaserScan> scans_of(const BenchMap& map, std::span<const Track> walkers, const ControlSetup& setup,
                                int ticks) {
  sim::WallMap drawn;
  drawn.raster = {{}, kBenchCell_m, map.cells.width, map.cells.height, map.cells.wall};
  drawn.segments = sim::edges_of(drawn.raster);
  const sim::Walls walls(std::move(drawn));
  sim::LaserSim laser(setup.model.laser, 1);
  std::vector<LaserScan> scans(static_cast<std::size_t>(ticks));
  std::vector<sim::Disc> discs(walkers.size());
  for (std::size_t k = 0; k < scans.size(); ++k) {
    const Duration after = setup.tick() * static_cast<std::int64_t>(k + 1);
    for (std::size_t w = 0; w < discs.size(); ++w)
      discs[w] = {walkers[w].position_in_map + walkers[w].velocity_in_map * to_seconds(after), walkers[w].radius_m};
    laser.sweep(walls, discs, setup.start, Time{after}, scans[k]);
    scans[k].sequence = static_cast<std::uint32_t>(k + 1);
  }
  return scans;
}

/// Times decisions on motion alone, of a P3-DX under way at the map's start among `movers` bodies within 8 m that walk
/// on from scan to scan: belief, futures, trajectories, choice. No seeing, no guide.
Timing time_decision(const BenchMap& map, int movers, int repeats) {
  const RobotModel model = p3dx();
  PlannerConfig config;
  config.side_cells = config.max_side_cells = map.cells.width;
  config.body = model.footprint;
  const auto planner = make_cpu_planner(config);
  const EvidenceMap evidence = evidence_of(map, EvidenceMap::kMin);
  const ControlSetup setup = setup_at(map);
  const Pose2 pose = setup.start;
  const Vec2 goal = setup.goal;
  planner->submit(
      {.map_from_robot = pose, .goal_in_map = goal, .speed_mps = model.limits.max_speed_mps, .still = &evidence});
  const auto plan = std::make_unique<Plan>(planner->collect());
  const auto motion = motion::make_motion({.model = model});
  std::vector<Track> tracks = walkers_round(pose.position(), movers);
  const auto scan = std::make_unique<LaserScan>();
  OperatorInput input;
  input.has_goal = true;
  input.goal_in_map = goal;
  Time now{};
  const auto decide = [&] {
    now += duration_from_seconds(kScan_s);
    for (Track& t : tracks)
      t.position_in_map = t.position_in_map + t.velocity_in_map * kScan_s, t.stamp = t.still_since = now;
    scan->stamp = plan->stamp = now;
    motion->decide({.now = now,
                    .new_scan = true,
                    .map_from_robot = pose,
                    .driven = {0.4, 0.0},
                    .input = input,
                    .scan = *scan,
                    .map_from_laser = pose,
                    .perceived = {.tracks = tracks, .still = evidence},
                    .plan = *plan},
                   {motion::Intent::Kind::kGoal});
  };
  for (int k = 0; k < kDecisionsBefore; ++k) decide();
  return time(("decision, " + std::to_string(movers)).c_str(), repeats, "cpu", decide);
}

/// Times whole ticks that each have a new scan, of 811 beams over 270 degrees: seeing, planning and acting, by a robot
/// that stands at the map's start while `walkers` go on from where they are. A simulated laser sees them and the walls.
Timing time_tick(const BenchMap& map, std::span<const Track> walkers, Backend backend, int repeats) {
  const ControlSetup setup = setup_at(map);
  const std::vector<LaserScan> scans = scans_of(map, walkers, setup, kTicksBefore + repeats);
  const auto devices = std::make_unique<TickRecord>();
  devices->input.has_goal = true;
  devices->input.goal_in_map = setup.goal;
  RecordedHal hal(*devices);
  const ChosenPlanner chosen = make_planner(setup.planner(), backend);
  Recorder recorder({});
  ControlLoop loop(setup, hal.hal(), *chosen.planner, recorder);
  auto next = scans.begin();
  const auto tick = [&] {
    devices->scan = *next++;
    devices->now = devices->wheels.stamp = devices->scan.stamp;
    ++devices->wheels.sequence;
    (void)loop.tick(devices->now);
  };
  for (int k = 0; k < kTicksBefore; ++k) tick();
  return time("tick, 8 movers", repeats, chosen.planner->backend(), tick);
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
    paper::FieldQuality quality;
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
