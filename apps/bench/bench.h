#pragma once
// `jaywalk bench`: maps, motions and rival methods that it measures.
#include <chrono>
#include <cstdint>
#include <ctime>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "apps/report/distribution.h"
#include "firmware/control_setup.h"
#include "planner/mapping/evidence_map.h"
#include "planner/paper/map_field.h"
#include "planner/tracking/track.h"

namespace jaywalk {

/// Walls grow by this on every map, in cells.
inline constexpr float kBenchInflation = 3.0F;

/// A map to measure on, with a goal and a start that are free after inflation.
struct BenchMap {
  std::string name;
  paper::CellMap cells;
  CellIndex goal, start;
};

/// Open room, office, serpentine corridors 1.5 m and 1.0 m wide, clutter: `side` cells of 0.1 m a side, walls all
/// round. The same bytes on every machine.
[[nodiscard]] std::vector<BenchMap> bench_maps(std::int32_t side);

/// A map of lines or discs from a file, its cells chosen so that it fills `side` of them; the goal near its middle, the
/// start near its upper right corner. Throws StartupError.
[[nodiscard]] BenchMap scaled_map(const std::filesystem::path& file, std::int32_t side);

/// Shortest ways and harmonic potentials as textbooks have them, on free cells that are inflated beforehand at no cost.
class BenchRivals {
 public:
  /// `free`: width x height, 1 where a robot may be. Takes all memory.
  BenchRivals(std::int32_t width, std::int32_t height, std::vector<std::uint8_t> free);

  /// Steps to the goal over four neighbours, breadth first.
  void wavefront(CellIndex goal);
  /// Distance to the goal over eight neighbours (10 straight, 14 diagonal), by a ring of buckets.
  void dijkstra_buckets(CellIndex goal);
  /// The same by a binary heap.
  void dijkstra_heap(CellIndex goal);
  /// The paper's recipe: 100 red-black sweeps of the harmonic potential from 0.5, single precision.
  void hundred_sweeps(CellIndex goal);

  /// Distance of a cell as the last of the first three methods found it; negative where there is no way.
  [[nodiscard]] std::int32_t distance(CellIndex at) const { return distance_[index(at)]; }

 private:
  [[nodiscard]] std::size_t index(CellIndex at) const {
    return static_cast<std::size_t>(at.j) * static_cast<std::size_t>(stride_) + static_cast<std::size_t>(at.i);
  }
  /// Calls visit(cell, cost) for each of the eight neighbours that is free, corners not cut.
  template <class Visit>
  void for_each_step(std::size_t from, const Visit& visit) const;

  std::int32_t width_, height_, stride_;  ///< a ring of cells round the map is not free
  std::vector<std::uint8_t> free_;
  std::vector<std::int32_t> distance_;
  std::vector<std::uint32_t> queue_;
  std::vector<float> phi_;
};

struct Timing {
  std::string what;
  double p50_ms = 0.0, p99_ms = 0.0;
  std::string backend;
};

/// Times `work`. On the CPU processor time of this one thread: what other programs take meanwhile does not count. On a
/// device wall time, submission and waiting included.
template <class Work>
Timing time(const char* what, int repeats, const std::string& backend, const Work& work) {
  Distribution took_ms;
  for (int k = 0; k < repeats; ++k) {
    const std::clock_t ticks = std::clock();
    const auto begin = std::chrono::steady_clock::now();
    work();
    const std::chrono::duration<double, std::milli> wall_ms = std::chrono::steady_clock::now() - begin;
    took_ms.add(backend == "cpu" ? 1e3 * static_cast<double>(std::clock() - ticks) / CLOCKS_PER_SEC : wall_ms.count());
  }
  return {what, took_ms.quantile(0.5), took_ms.quantile(0.99), backend};
}

/// Times decisions on motion alone, of a P3-DX under way at the map's start among `movers` bodies within 8 m that walk
/// on from scan to scan: belief, futures, trajectories, choice. No seeing, no guide.
[[nodiscard]] Timing time_decision(const BenchMap& map, double cell_m, int movers, int repeats);

/// Times whole ticks that each have a new scan, of 811 beams over 270 degrees: seeing, planning and acting, by a robot
/// that stands at the map's start while `walkers` go on from where they are. A simulated laser sees them and the walls.
[[nodiscard]] Timing time_tick(const BenchMap& map, double cell_m, std::span<const Track> walkers, Backend backend,
                               int repeats);

}  // namespace jaywalk
