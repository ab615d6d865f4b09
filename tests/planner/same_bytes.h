#pragma once
// The plans of one planner against those of the serial CPU, byte by byte.
#include <cstring>
#include <functional>
#include <vector>

#include "planner/cost_to_go/planner.h"
#include "planner/paper/paper.h"
#include "tests/planner/one_plan.h"
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

inline paper::PaperConfig window(std::int32_t side) {
  paper::PaperConfig config;
  config.side_cells = config.max_side_cells = side;
  return config;
}

inline paper::PaperConfig small_window() {
  paper::PaperConfig config = window(64);
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

/// Both plan `request`. Whether there was a path.
inline bool check_plan(Planner& cpu, Planner& other, const PlanRequest& request) {
  other.submit(request);
  cpu.submit(request);
  const Plan& a = cpu.collect();
  const Plan& b = other.collect();
  REQUIRE(a.status == b.status);
  REQUIRE(a.path.size() == b.path.size());
  CHECK(a.cycles == b.cycles);
  CHECK(a.certified == b.certified);
  CHECK(same(a.path.data(), b.path.data(), static_cast<std::int32_t>(a.path.size())));
  REQUIRE(a.predictions.size() == b.predictions.size());
  for (std::size_t k = 0; k < a.predictions.size(); ++k) {
    CHECK(same(&a.predictions[k].position_in_map, &b.predictions[k].position_in_map, 1));
  }
  const auto psi_a = cpu.view_field().psi, psi_b = other.view_field().psi;
  REQUIRE(psi_a.size() == psi_b.size());
  CHECK(same(psi_a.data(), psi_b.data(), static_cast<std::int32_t>(psi_a.size())));
  return a.status == PlanStatus::kOk;
}

/// Both plan in a window of 6.4 m among six walkers; `look` after each plan.
inline void check_crowd(
    Planner& cpu, Planner& other, const TestMap& walls, int ticks, const std::function<void()>& look = [] {}) {
  const EvidenceMap map = evidence_of(walls);
  std::vector<Track> tracks = crowd();
  PlanRequest request = across(map);
  int planned = 0;
  for (int tick = 0; tick < ticks; ++tick) {
    for (Track& track : tracks) track.position_in_map = track.position_in_map + track.velocity_in_map * 0.066;
    request.moving = tracks;
    planned += check_plan(cpu, other, request) ? 1 : 0;
    look();
  }
  CHECK(planned > 0);
}

/// A robot that sets out from one corner of a map for the other.
inline void check_run(Planner& cpu, Planner& other, const TestMap& map, int ticks) {
  const EvidenceMap evidence = evidence_of(map);
  PlanRequest request = request_on(evidence, {1.07, 0.65}, {0.1 * map.side - 1.29, 0.1 * map.side - 1.32});
  request.map_from_robot.heading = 0.4;
  for (int tick = 0; tick < ticks; ++tick) {
    request.map_from_robot.x += 0.04;
    check_plan(cpu, other, request);
  }
}

}  // namespace jaywalk::test
