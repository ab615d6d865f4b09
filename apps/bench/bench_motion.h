#pragma once
#include "apps/bench/bench_maps.h"
#include "apps/bench/timing.h"

namespace jaywalk {

/// Times decisions on motion alone, of a P3-DX under way at the map's start among `movers` bodies within 8 m that walk
/// on from scan to scan: belief, futures, trajectories, choice. No seeing, no guide.
[[nodiscard]] Timing time_decision(const BenchMap& map, double cell_m, int movers, int repeats);

}  // namespace jaywalk
