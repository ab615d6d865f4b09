// After construction the planner takes no memory: heap calls are counted, and page faults.
#include <sys/resource.h>

#include <cstdio>
#include <cstdlib>
#include <vector>

#include "tests/planner/one_plan.h"
#include "tests/planner/test_maps.h"
#include "tests/support/allocation_guard.h"
#include "tests/support/catch.h"

using namespace jaywalk;

namespace {

/// Forty submissions of every kind: with and without movers, goals outside, a window that doubles.
void drive(Planner& planner) {
  static const EvidenceMap office = test::evidence_of(test::office());
  static const EvidenceMap wall = [] {
    EvidenceMap map(512, 0.1, {12.8, 12.8});
    for (std::int32_t j = -40; j < 290; ++j) map.add({128, j}, EvidenceMap::kMax);
    return map;
  }();
  static std::vector<Track> tracks = [] {
    std::vector<Track> some(kMaxTracks);
    test::Random random(5);
    for (Track& track : some) {
      track.position_in_map = {25.6 * random.unit(), 25.6 * random.unit()};
      track.velocity_in_map = {random.unit() - 0.5, random.unit() - 0.5};
      track.radius_m = 0.1;
    }
    return some;
  }();
  PlanRequest request;
  request.speed_mps = 0.6;
  for (int tick = 0; tick < 40; ++tick) {
    request.still = tick < 15 ? &office : &wall;  // the latter also makes the window double
    request.moving = tick % 2 == 0 ? std::span<const Track>(tracks) : std::span<const Track>();
    request.map_from_robot = {1.0 + 0.1 * tick, 1.0, 0.3};
    request.poses.is_asked = tick % 4 == 0;
    request.goal_in_map = tick % 5 == 4 ? Vec2{90.0, 0.0} : Vec2{24.0, 24.0};
    planner.submit(request);
    (void)planner.collect();
  }
}

long page_faults() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return usage.ru_minflt + usage.ru_majflt;
}

}  // namespace

TEST_CASE("submit and collect allocate nothing, whatever comes of them") {
  const bool is_paper = GENERATE(false, true);
  drive(*test::planner_of(is_paper, 512));  // maps and tracks are made
  const auto planner = test::planner_of(is_paper, 512);
  const AllocationGuard guard;
  drive(*planner);
  const auto calls = guard.calls();
  CHECK(calls == 0);
}

TEST_CASE("submit and collect meet no page that was not there: all memory is touched when it is taken") {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  return static_cast<void>(std::printf("skipped: sanitizers take memory of their own\n"));
#endif
  const bool is_paper = GENERATE(false, true);
  drive(*test::planner_of(is_paper, 512));  // the code's own pages, and the stack's
  const auto planner = test::planner_of(is_paper, 512);
  const long before = page_faults();
  drive(*planner);
  CHECK(page_faults() == before);
  constexpr std::size_t kMuch = 64U << 20;
  auto* const more = static_cast<volatile char*>(std::malloc(kMuch));
  REQUIRE(more != nullptr);
  for (std::size_t k = 0; k < kMuch; k += 4096) more[k] = 1;
  CHECK(page_faults() > before);  // the counter counts
  std::free(const_cast<char*>(more));
}
