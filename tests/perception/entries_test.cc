#include "planner/tracking/entries.h"

#include <memory>

#include "tests/support/catch.h"

using namespace jaywalk;

namespace {

/// One body at (2, 0), known since 0 s and seen whole by point 0 of two; point 1 lies beside it, 0.3 m from its middle.
struct Seen {
  Seen() {
    Body body = born_at({2.0, 0.0}, 0.02, 0.25, time_from_seconds(0.0), 7);
    body.track.hits = 5;
    body.whole = true;
    body.arc_m = 0.25;
    (void)bodies.push_back(body);
    Cluster cluster;
    cluster.segment = {0, 0};
    cluster.track_id = 7;
    (void)clusters.push_back(cluster);
    in_map.position[0] = {1.75, 0.0};
    in_map.position[1] = {2.0, 0.3};
  }
  Body& body() { return bodies[0]; }
  std::array<Becomes, 2> at(double now_s) {
    decide_entries(bodies, clusters, in_map, 2, still, time_from_seconds(now_s), entries);
    return {entries[0], entries[1]};
  }

  EvidenceMap still{64, 0.1, {}};
  Bodies bodies;
  Clusters clusters;
  PointsInMap in_map;
  Entries entries{};
};

using Pair = std::array<Becomes, 2>;

}  // namespace

TEST_CASE("who may stand on unknown ground is no wall for three seconds") {
  const auto seen = std::make_unique<Seen>();
  CHECK(seen->at(2.9) == Pair{Becomes::kObstacle, Becomes::kWall});
  CHECK(seen->at(3.0) == Pair{Becomes::kWall, Becomes::kWall});
  seen->clusters[0].on_wall = true;  // a pillar that comes into view again
  CHECK(seen->at(1.0)[0] == Becomes::kWall);
}

TEST_CASE("posts and what is seen in part are walls at once") {
  const auto seen = std::make_unique<Seen>();
  seen->body().arc_m = 0.1;
  CHECK(seen->at(1.0)[0] == Becomes::kWall);
  seen->body().arc_m = 0.25;
  seen->body().whole = false;
  CHECK(seen->at(1.0)[0] == Becomes::kWall);
  seen->clusters[0].track_id = 8;  // nobody's
  CHECK(seen->at(1.0)[0] == Becomes::kWall);
}

TEST_CASE("who moves or came to free ground and has not settled leaves nothing in the map") {
  const auto seen = std::make_unique<Seen>();
  seen->clusters[0].in_free_space = true;
  CHECK(seen->at(9.0) == Pair{Becomes::kNothing, Becomes::kWall});
  seen->body().settled = true;
  CHECK(seen->at(9.0)[0] == Becomes::kWall);
  seen->body().track.moving = true;
  CHECK(seen->at(9.0) == Pair{Becomes::kNothing, Becomes::kNothing});
  for (int k = 0; k < 3; ++k) seen->still.add_hit({2.0, 0.3}, 10);  // a known obstacle stays one
  CHECK(seen->at(9.0) == Pair{Becomes::kNothing, Becomes::kWall});
}
