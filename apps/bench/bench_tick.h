#pragma once
#include <span>

#include "apps/bench/bench_maps.h"
#include "apps/bench/timing.h"
#include "firmware/control_setup.h"
#include "planner/tracking/track.h"

namespace jaywalk {

/// Times whole ticks that each have a new scan, of 811 beams over 270 degrees: seeing, planning and acting, by a robot
/// that stands at the map's start while `walkers` go on from where they are. A simulated laser sees them and the walls.
[[nodiscard]] Timing time_tick(const BenchMap& map, double cell_m, std::span<const Track> walkers, Backend backend,
                               int repeats);

}  // namespace jaywalk
