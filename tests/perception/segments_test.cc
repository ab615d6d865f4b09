#include "planner/perception/segments.h"

#include <memory>

#include "tests/perception/room.h"
#include "tests/support/catch.h"

using namespace jaywalk;
using namespace jaywalk::test;

namespace {

constexpr double kStepRad = 1.5 * kPi / 810;

/// A scan from the origin, cut and judged against a map.
struct Cut {
  explicit Cut(const Room& room, const EvidenceMap& still = EvidenceMap(256, 0.1, {})) {
    ScanProjection().project(scan_of(room, {}, 1), {}, {}, points);
    for (std::size_t k = 0; k < points.size(); ++k) {
      in_map.position[k] = points[k].in_robot;
      in_map.ground[k] = ground_at(still, points[k].in_robot, points[k].range_m);
    }
    cut_at_jumps(points, kStepRad, segments);
    find_clusters(points, in_map, segments, 810, {0.0, 0.0}, clusters);
  }

  ScanPoints points;
  PointsInMap in_map;
  Segments segments;
  Clusters clusters;
};

EvidenceMap seen_free_all_over() {
  EvidenceMap map(256, 0.1, {});
  for (int j = -128; j < 128; ++j) {
    for (int i = -128; i < 128; ++i) map.add({i, j}, -40);
  }
  return map;
}

}  // namespace

TEST_CASE("a disc before a wall is a segment of its own") {
  Room room;
  room.walls = {{{4.0, -2.0}, {4.0, 2.0}}};
  room.discs = {{{2.0, 0.0}, 0.25}};
  const auto cut = std::make_unique<Cut>(room);
  CHECK(cut->segments.size() == 3);  // wall, disc, wall
}

TEST_CASE("a body's centre lies behind its visible arc") {
  Room room;
  room.discs = {{{3.0, 1.0}, 0.27}};
  const auto cut = std::make_unique<Cut>(room, seen_free_all_over());
  REQUIRE(cut->clusters.size() == 1);
  const Cluster& cluster = cut->clusters[0];
  CHECK(distance(cluster.centre_in_map, {3.0, 1.0}) < 0.04);
  CHECK(cluster.radius_m == Approx(0.27).margin(0.03));
  CHECK(cluster.in_free_space);
  CHECK_FALSE(cluster.leg());
}

TEST_CASE("what is wider than a body is a wall wherever it stands") {
  Room room;
  room.walls = {{{3.0, -0.6}, {3.0, 0.6}}};
  const auto cut = std::make_unique<Cut>(room, seen_free_all_over());
  CHECK(cut->segments.size() == 1);
  CHECK(cut->clusters.empty());
}

TEST_CASE("points within a wall's noise are the wall's") {
  EvidenceMap map(64, 0.1, {});
  for (int k = 0; k < 5; ++k) map.add_hit({2.05, 0.05}, 10, 0.25);
  // 1 m away a wall's points scatter by 0.112 m, 5 m away by 0.16 m.
  CHECK(ground_at(map, {1.95, 0.05}, 1.0) == Ground::kWall);
  CHECK(ground_at(map, {1.92, 0.05}, 1.0) == Ground::kUnknown);
  CHECK(ground_at(map, {1.92, 0.05}, 5.0) == Ground::kWall);
  map.add({18, 0}, -12);  // two beams passed: a slanting one frees what it only grazes
  CHECK(ground_at(map, {1.85, 0.05}, 1.0) == Ground::kUnknown);
  map.add({18, 0}, -6);
  CHECK(ground_at(map, {1.85, 0.05}, 1.0) == Ground::kFree);
}

TEST_CASE("a surface is no wall before it has stood for a second") {
  EvidenceMap map(64, 0.1, {});
  for (int k = 0; k < 14; ++k) map.add_hit({2.05, 0.05}, 10, 1.0 / 15);  // 0.93 s: in units of 1/64 s, 4 a scan, 56
  CHECK(map.occupied({20, 0}));
  CHECK(ground_at(map, {2.05, 0.05}, 1.0) == Ground::kUnknown);
  for (int k = 0; k < 2; ++k) map.add_hit({2.05, 0.05}, 10, 1.0 / 15);  // 64 of 64
  CHECK(ground_at(map, {2.05, 0.05}, 1.0) == Ground::kWall);
  map.add({20, 0}, -64);  // looked through: whatever comes next is new
  map.add_hit({2.05, 0.05}, 40, 9.0);
  CHECK(map.occupied({20, 0}));
  CHECK_FALSE(map.stands({20, 0}));  // one hit after a gap is one hit
}

TEST_CASE("in unknown space what goes on behind nearer things on both sides is no body") {
  Room room;  // a wall seen through a gap of 0.4 m, and a disc that nothing hides
  room.walls = {{{1.0, 0.2}, {1.0, 2.0}}, {{1.0, -0.2}, {1.0, -2.0}}, {{1.5, -2.0}, {1.5, 2.0}}};
  room.discs = {{{-1.0, 2.0}, 0.2}};
  const auto cut = std::make_unique<Cut>(room);
  bool gap = false, disc = false;
  for (const Cluster& c : cut->clusters) {
    gap = gap || distance(c.centre_in_map, {1.5, 0.0}) < 0.4;
    disc = disc || distance(c.centre_in_map, {-1.0, 2.0}) < 0.1;
  }
  CHECK(disc);
  CHECK_FALSE(gap);
}

TEST_CASE("a body half behind something nearer knows which of its sides is hidden") {
  Room room;
  room.walls = {{{1.0, 0.0}, {1.0, -0.8}},
                {{5.0, -4.0}, {5.0, 4.0}}};  // hides what lies to the right of straight ahead
  room.discs = {{{3.0, 0.0}, 0.27}};
  const auto cut = std::make_unique<Cut>(room, seen_free_all_over());
  const Cluster* half = nullptr;
  for (const Cluster& c : cut->clusters) half = distance(c.centre_in_map, {3.0, 0.1}) < 0.3 ? &c : half;
  REQUIRE(half != nullptr);
  CHECK(half->low_hidden());  // beams count from right to left
  CHECK_FALSE(half->high_hidden());
  CHECK_FALSE(half->whole());
  CHECK(half->emerges());
  CHECK(half->radius_m == Approx(0.135).margin(0.02));
  CHECK(half->high_side.y > 0.99);
  CHECK(half->along.x > 0.99);
}

TEST_CASE("a side beside which beams return nothing is not seen to end") {
  Room room;
  room.walls = {{{1.0, 0.0}, {1.0, -0.8}}};  // hides one half, and behind the other there is nothing
  room.discs = {{{3.0, 0.0}, 0.27}};
  const auto cut = std::make_unique<Cut>(room, seen_free_all_over());
  const Cluster* half = nullptr;
  for (const Cluster& c : cut->clusters) half = distance(c.centre_in_map, {3.0, 0.1}) < 0.3 ? &c : half;
  REQUIRE(half != nullptr);
  CHECK(half->low_end == End::kHidden);
  CHECK(half->high_end == End::kUnknown);
  CHECK_FALSE(half->emerges());
}

TEST_CASE("what is half behind a leg does not emerge: legs take turns in hiding one another") {
  Room room;
  room.discs = {{{2.0, 0.0}, 0.06}, {{3.0, 0.15}, 0.1}};  // the nearer hides what lies up to 0.09 m left of straight
  const auto cut = std::make_unique<Cut>(room, seen_free_all_over());
  const Cluster* half = nullptr;
  for (const Cluster& c : cut->clusters) half = distance(c.centre_in_map, {3.0, 0.17}) < 0.2 ? &c : half;
  REQUIRE(half != nullptr);
  CHECK(half->low_hidden());
  CHECK_FALSE(half->emerges());
}

TEST_CASE("what reaches the end of the sweep may go on outside it") {
  Room room = rectangle(10.0, 10.0);
  room.discs = {{direction(0.75 * kPi) * 3.0, 0.27}};
  const auto cut = std::make_unique<Cut>(room, seen_free_all_over());
  REQUIRE(cut->clusters.size() == 1);
  CHECK(cut->clusters[0].high_hidden());
  CHECK_FALSE(cut->clusters[0].low_hidden());
  CHECK_FALSE(cut->clusters[0].emerges());  // a glint on glass goes along with the robot there
  CHECK(cut->clusters[0].beams.last == 810);
}

TEST_CASE("a scan in more pieces than fit is cut short and the rest counts as wall") {
  const auto scan = std::make_unique<LaserScan>(scan_of(rectangle(4.0, 4.0), {}, 1));
  for (std::size_t b = 0; b < scan->beam_count; b += 2) scan->range_m[b] = 1.0F;  // every second beam
  const auto points = std::make_unique<ScanPoints>();
  ScanProjection().project(*scan, {}, {}, *points);
  const auto segments = std::make_unique<Segments>();
  cut_at_jumps(*points, kStepRad, *segments);
  CHECK(segments->full());
  CHECK(segments->back().last < points->size() - 1);
}
