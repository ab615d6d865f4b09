#pragma once
#include <span>

#include "apps/bench/bench_maps.h"
#include "apps/bench/timing.h"
#include "firmware/control_setup.h"
#include "planner/tracking/track.h"

namespace jaywalk {

/// Times decisions on motion alone, of a P3-DX under way at the map's start among `movers` bodies within 8 m that walk
/// on from scan to scan: belief, futures, trajectories, choice. No seeing, no guide.
[[nodiscard]] Timing time_decision(const BenchMap& map, double cell_m, int movers, int repeats);

/// Times whole ticks that each have a new scan, of 811 beams over 270 degrees: seeing, planning and acting, by a robot
/// that stands at the map's start while `walkers` go on from where they are. A simulated laser sees them and the walls.
[[nodiscard]] Timing time_tick(const BenchMap& map, double cell_m, std::span<const Track> walkers, Backend backend,
                               int repeats);

}  // namespace jaywalk
