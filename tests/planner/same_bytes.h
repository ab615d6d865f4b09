#pragma once
// One executor against the serial one, byte by byte.
#include <cstring>
#include <memory>
#include <vector>

#include "planner/paper/paper.h"
#include "planner/paper/paper_planner.h"
#include "tests/planner/test_maps.h"
#include "tests/support/catch.h"

namespace jaywalk::test {

template <class T>
bool same(const T* a, const T* b, std::int32_t n) {
  return std::memcmp(a, b, static_cast<std::size_t>(n) * sizeof(T)) == 0;
}

/// Six movers in 6.4 m x 6.4 m.
inline std::vector<Track> crowd() {
  std::vector<Track> tracks;
  Random random(17);
  for (std::uint32_t k = 1; k <= 6; ++k) {
    Track track;
    track.id = k;
    track.position_in_map = {6.4 * random.unit(), 6.4 * random.unit()};
    track.velocity_in_map = {random.unit() - 0.5, random.unit() - 0.5};
    track.covariance = {0.001, 0.0005, 0.01};
    track.radius_m = 0.1;
    tracks.push_back(track);
  }
  return tracks;
}

inline paper::PaperConfig small_window() {
  paper::PaperConfig config;
  config.side_cells = config.max_side_cells = 64;
  config.inflation_m = 0.15;
  config.mover_margin_m = 0.1;
  return config;
}

/// From one corner of such a window to the other.
inline PlanRequest across(const EvidenceMap& still) {
  PlanRequest request;
  request.map_from_robot = {0.83, 0.77, 0.6};
  request.goal_in_map = {5.52, 5.53};
  request.speed_mps = 0.6;
  request.still = &still;
  return request;
}

/// Marks and whole plans among walkers, on a map of 64 cells a side that can be crossed.
template <class Executor>
void check_plans(const TestMap& walls, int ticks) {
  const EvidenceMap map = evidence_of(walls);
  paper::PaperPlanner<paper::SerialExecutor> serial(small_window(), std::make_unique<paper::SerialExecutor>());
  paper::PaperPlanner<Executor> other(small_window(), std::make_unique<Executor>());
  std::vector<Track> tracks = crowd();
  PlanRequest request = across(map);
  int planned = 0;
  for (int tick = 0; tick < ticks; ++tick) {
    for (Track& track : tracks) track.position_in_map = track.position_in_map + track.velocity_in_map * 0.066;
    request.moving = tracks;
    serial.submit(request);
    other.submit(request);
    const Plan& a = serial.collect();
    const Plan& b = other.collect();
    REQUIRE(a.status == b.status);
    REQUIRE(a.path.size() == b.path.size());
    CHECK(a.cycles == b.cycles);
    CHECK(same(serial.arrays().marks, other.arrays().marks, 6));
    CHECK(same(serial.arrays().occupants, other.arrays().occupants, 64 * 64));
    CHECK(same(a.path.data(), b.path.data(), static_cast<std::int32_t>(a.path.size())));
    CHECK(same(serial.view_field().psi.data(), other.view_field().psi.data(), 64 * 64));
    if (a.status == PlanStatus::kOk) ++planned;
  }
  CHECK(planned > 0);
}

}  // namespace jaywalk::test
