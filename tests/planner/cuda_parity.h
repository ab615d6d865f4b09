#pragma once
// The plans of one planner against those of the CPU's, byte by byte.
#include <cstring>
#include <vector>

#include "planner/cost_to_go/planner.h"
#include "tests/planner/same_bytes.h"
#include "tests/planner/test_maps.h"
#include "tests/support/catch.h"

namespace jaywalk::test {

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

/// A robot that sets out from one corner of a map for the other.
inline void check_run(Planner& cpu, Planner& other, const TestMap& map, int ticks) {
  const EvidenceMap evidence = evidence_of(map);
  PlanRequest request;
  request.map_from_robot = {1.07, 0.65, 0.4};
  request.goal_in_map = {0.1 * map.side - 1.29, 0.1 * map.side - 1.32};
  request.speed_mps = 0.6;
  request.still = &evidence;
  for (int tick = 0; tick < ticks; ++tick) {
    request.map_from_robot.x += 0.04;
    check_plan(cpu, other, request);
  }
}

}  // namespace jaywalk::test
