#include <memory>

#include "planner/tracking/scene.h"
#include "tests/support/catch.h"

using namespace jaywalk;

namespace {

/// One body at (2, 0), known since 0 s and seen whole by point 0 of two; point 1 lies beside it, 0.3 m from its middle.
struct Seen {
  Seen() {
    Target target = born_at({2.0, 0.0}, 0.02, 0.25, time_from_seconds(0.0), 7);
    target.estimate.track.hits = 5;
    target.appearance.whole = true;
    target.appearance.arc_m = 0.25;
    (void)targets.push_back(target);
    Detection detection;
    detection.segment = {0, 0};
    detection.track_id = 7;
    (void)detections.push_back(detection);
    in_map.position[0] = {1.75, 0.0};
    in_map.position[1] = {2.0, 0.3};
  }
  Target& target() { return targets[0]; }
  std::array<Becomes, 2> at(double now_s) {
    decide_entries(targets, detections, {in_map.position.data(), 2}, still, time_from_seconds(now_s), entries);
    return {entries[0], entries[1]};
  }

  EvidenceMap still{64, 0.1, {}};
  Targets targets;
  Detections detections;
  PointsInMap in_map;
  Entries entries{};
};

using Pair = std::array<Becomes, 2>;

}  // namespace

TEST_CASE("who may stand on unknown ground is no wall for three seconds") {
  const auto seen = std::make_unique<Seen>();
  CHECK(seen->at(2.9) == Pair{Becomes::kObstacle, Becomes::kWall});
  CHECK(seen->at(3.0) == Pair{Becomes::kWall, Becomes::kWall});
  seen->detections[0].on_wall = true;  // a pillar that comes into view again
  CHECK(seen->at(1.0)[0] == Becomes::kWall);
}

TEST_CASE("posts and what is seen in part are walls at once") {
  const auto seen = std::make_unique<Seen>();
  seen->target().appearance.arc_m = 0.1;
  CHECK(seen->at(1.0)[0] == Becomes::kWall);
  seen->target().appearance.arc_m = 0.25;
  seen->target().appearance.whole = false;
  CHECK(seen->at(1.0)[0] == Becomes::kWall);
  seen->detections[0].track_id = 8;  // nobody's
  CHECK(seen->at(1.0)[0] == Becomes::kWall);
}

TEST_CASE("who moves or came to free ground and has not settled leaves nothing in the map") {
  const auto seen = std::make_unique<Seen>();
  seen->detections[0].in_free_space = true;
  CHECK(seen->at(9.0) == Pair{Becomes::kNothing, Becomes::kWall});
  seen->target().existence.settled = true;
  CHECK(seen->at(9.0)[0] == Becomes::kWall);
  seen->target().estimate.track.moving = true;
  CHECK(seen->at(9.0) == Pair{Becomes::kNothing, Becomes::kNothing});
  for (int k = 0; k < 3; ++k) seen->still.add_hit({2.0, 0.3}, 10);  // a known obstacle stays one
  CHECK(seen->at(9.0) == Pair{Becomes::kNothing, Becomes::kWall});
}
