#pragma once
// `jaywalk bench`: maps, motions and rival methods that it measures.
#include <chrono>
#include <cstdint>
#include <ctime>
#include <filesystem>
#include <string>
#include <vector>

#include "apps/report/distribution.h"
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

/// Metres a cell of every map.
inline constexpr double kBenchCell_m = 0.1;

[[nodiscard]] inline Vec2 middle_of(CellIndex cell) {
  return {(cell.i + 0.5) * kBenchCell_m, (cell.j + 0.5) * kBenchCell_m};
}

/// The map as a robot in its middle holds it; `of_free`: evidence of cells without a wall.
[[nodiscard]] EvidenceMap evidence_of(const BenchMap& map, int of_free);

/// A pedestrian's track, numbered from 0.
[[nodiscard]] Track walker_at(std::size_t number, Vec2 place, Vec2 velocity);

struct Timing {
  std::string what;
  double p50_ms = 0.0, p99_ms = 0.0;
  std::string backend;
};

/// Times `work` by a clock that gives ms.
template <class Work, class Clock>
Timing time(const char* what, int repeats, const std::string& backend, const Work& work, const Clock& now_ms) {
  Distribution took_ms;
  for (int k = 0; k < repeats; ++k) {
    const double before_ms = now_ms();
    work();
    took_ms.add(now_ms() - before_ms);
  }
  return {what, took_ms.quantile(0.5), took_ms.quantile(0.99), backend};
}

/// Times `work` on the CPU by processor time of this one thread: what other programs take meanwhile does not count. On
/// a device by wall time, submission and waiting included.
template <class Work>
Timing time(const char* what, int repeats, const std::string& backend, const Work& work) {
  const auto begin = std::chrono::steady_clock::now();
  return time(what, repeats, backend, work, [&] {
    const std::chrono::duration<double, std::milli> wall_ms = std::chrono::steady_clock::now() - begin;
    return backend == "cpu" ? 1e3 * static_cast<double>(std::clock()) / CLOCKS_PER_SEC : wall_ms.count();
  });
}

/// Times shortest ways and harmonic potentials as textbooks have them, on free cells that are inflated beforehand at no
/// cost.
[[nodiscard]] std::vector<Timing> time_rivals(const BenchMap& map, int repeats);

}  // namespace jaywalk
