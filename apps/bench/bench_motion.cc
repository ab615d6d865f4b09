#include <memory>
#include <string>
#include <vector>

#include "apps/bench/bench.h"
#include "firmware/backends.h"
#include "firmware/control_loop.h"
#include "firmware/recording/recorded_hal.h"
#include "hal/sim/sensors.h"
#include "hal/types/robot_model.h"
#include "planner/motion/motion.h"

namespace jaywalk {
namespace {

constexpr double kScan_s = 1.0 / 15.0;
constexpr double kWithin_m = 8.0;
constexpr int kDecisionsBefore = 15;  // decisions: by then every mover is known to walk

/// Spread evenly over a disc: radii by the square root, angles by the golden one.
std::vector<Track> walkers_round(Vec2 middle, int count) {
  std::vector<Track> tracks;
  for (int k = 0; k < count; ++k) {
    const Vec2 place = middle + direction(2.39996 * k) * (kWithin_m * sqrt((k + 0.5) / count));
    tracks.push_back(walker_at(static_cast<std::size_t>(k), place, direction(1.7 * k) * 0.4));
    tracks.back().moving = tracks.back().is_pedestrian = true;
  }
  return tracks;
}

constexpr int kTicksBefore = 50;  // ticks: by then walkers are confirmed

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

}  // namespace

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

}  // namespace jaywalk
