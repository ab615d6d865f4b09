#include "apps/bench/bench_tick.h"

#include <memory>
#include <vector>

#include "firmware/backends.h"
#include "firmware/control_loop.h"
#include "firmware/recording/recorded_hal.h"
#include "hal/sim/laser_sim.h"

namespace jaywalk {
namespace {

constexpr int kTicksBefore = 50;  // ticks: by then walkers are confirmed

sim::Walls walls_of(const BenchMap& map, double cell_m) {
  sim::WallMap walls;
  walls.raster = {{}, cell_m, map.cells.width, map.cells.height, map.cells.wall};
  walls.segments = sim::edges_of(walls.raster);
  return sim::Walls(std::move(walls));
}

Vec2 middle(CellIndex cell, double cell_m) { return {(cell.i + 0.5) * cell_m, (cell.j + 0.5) * cell_m}; }

ControlSetup setup_at(const BenchMap& map, double cell_m) {
  ControlSetup setup;
  setup.model = p3dx();
  setup.model.laser.rate_hz = setup.rate_hz;
  const Vec2 start = middle(map.start, cell_m);
  setup.goal = middle(map.goal, cell_m);
  setup.start = {start.x, start.y, atan2(setup.goal.y - start.y, setup.goal.x - start.x)};
  return setup;
}

/// What the laser sees at each tick, taken before anything is timed.
std::vector<LaserScan> scans_of(const BenchMap& map, double cell_m, std::span<const Track> walkers,
                                const ControlSetup& setup, int ticks) {
  const sim::Walls walls = walls_of(map, cell_m);
  sim::LaserSim laser(setup.model.laser, 1);
  std::vector<LaserScan> scans(static_cast<std::size_t>(ticks));
  std::vector<sim::Disc> discs(walkers.size());
  for (std::size_t k = 0; k < scans.size(); ++k) {
    const Duration after = setup.tick() * static_cast<std::int64_t>(k + 1);
    for (std::size_t w = 0; w < discs.size(); ++w) {
      discs[w] = {walkers[w].position_in_map + walkers[w].velocity_in_map * to_seconds(after), walkers[w].radius_m};
    }
    laser.sweep(walls, discs, setup.start, Time{after}, scans[k]);
    scans[k].sequence = static_cast<std::uint32_t>(k + 1);
  }
  return scans;
}

}  // namespace

Timing time_tick(const BenchMap& map, double cell_m, std::span<const Track> walkers, Backend backend, int repeats) {
  const ControlSetup setup = setup_at(map, cell_m);
  const std::vector<LaserScan> scans = scans_of(map, cell_m, walkers, setup, kTicksBefore + repeats);
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
