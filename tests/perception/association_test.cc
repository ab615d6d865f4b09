#include "planner/perception/association.h"

#include <memory>

#include "tests/perception/room.h"
#include "tests/support/catch.h"

using namespace jaywalk;
using namespace jaywalk::test;

namespace {

/// Bodies 0.27 m in radius that were seen three times, each where a disc of the scan is; and the scan cut at jumps.
struct SideBySide {
  explicit SideBySide(const std::vector<Vec2>& places) {
    Room room;
    for (const Vec2 place : places) room.discs.push_back({place, 0.27});
    const LaserScan scan = scan_of(room, {}, 1);
    ScanProjection().project(scan, {}, {}, points);
    for (std::size_t k = 0; k < points.size(); ++k) in_map.position[k] = points[k].in_robot;
    cut_at_jumps(points, sweep_of(scan), segments);
  }
  void know(Vec2 place, bool moving = true) {
    Body body = born_at(place, 0.01, 0.27, time_from_seconds(0.0), static_cast<std::uint32_t>(bodies.size() + 1));
    body.track.hits = 3;
    body.track.moving = moving;
    body.arc_m = 0.27;
    REQUIRE(bodies.push_back(body));
  }
  /// The width of segment `k`, m.
  [[nodiscard]] double width_m(std::size_t k) const {
    return distance(in_map.position[segments[k].first], in_map.position[segments[k].last]);
  }

  ScanPoints points;
  PointsInMap in_map;
  Segments segments;
  Bodies bodies;
};

/// What is seen of a disc of 0.4 m about (4, 0), from the origin, behind a wall 2 m off that ends at `edge_y`.
std::unique_ptr<Clusters> clusters_behind(double edge_y) {
  Room room;
  room.walls = {{{2.0, -3.0}, {2.0, edge_y}}};
  room.discs = {{{4.0, 0.0}, 0.4}};
  const LaserScan scan = scan_of(room, {}, 1);
  const auto points = std::make_unique<ScanPoints>();
  ScanProjection().project(scan, {}, {}, *points);
  const auto in_map = std::make_unique<PointsInMap>();
  in_map->ground.fill(Ground::kFree);
  for (std::size_t k = 0; k < points->size(); ++k) in_map->position[k] = (*points)[k].in_robot;
  const auto segments = std::make_unique<Segments>();
  cut_at_jumps(*points, sweep_of(scan), *segments);
  auto clusters = std::make_unique<Clusters>();
  find_clusters(*points, *in_map, *segments, sweep_of(scan), {}, *clusters);
  return clusters;
}

}  // namespace

TEST_CASE("three known bodies a hand apart are three segments and unknown ones stay one") {
  const std::vector<Vec2> places{{3.0, -0.57}, {3.0, 0.0}, {3.0, 0.57}};  // 3 cm between them
  const auto seen = std::make_unique<SideBySide>(places);
  REQUIRE(seen->segments.size() == 1);
  cut_between(seen->bodies, seen->in_map, seen->segments);
  CHECK(seen->segments.size() == 1);

  for (const Vec2 place : places) seen->know(place);
  cut_between(seen->bodies, seen->in_map, seen->segments);
  REQUIRE(seen->segments.size() == 3);
  for (std::size_t k = 0; k < 3; ++k) CHECK(seen->width_m(k) == Approx(0.53).margin(0.04));  // 0.54 less a beam
  CHECK(seen->segments[0].first == 0);
  CHECK(seen->segments[1].first == seen->segments[0].last + 1);  // no point is lost
  CHECK(seen->segments[2].first == seen->segments[1].last + 1);
  CHECK(seen->segments[2].last + 1 == seen->points.size());
}

TEST_CASE("one body is not cut in two for another that is expected half in it") {
  const auto seen = std::make_unique<SideBySide>(std::vector<Vec2>{{3.0, 0.0}});
  seen->know({3.0, -0.2});  // they begin and end it, but 0.54 m is less than three quarters of 1.08 m
  seen->know({3.0, 0.2});
  cut_between(seen->bodies, seen->in_map, seen->segments);
  CHECK(seen->segments.size() == 1);
}

TEST_CASE("two of whom one moves are cut and two that stand are not") {
  const std::vector<Vec2> places{{3.0, -0.285}, {3.0, 0.285}};
  for (const bool moves : {false, true}) {
    const auto seen = std::make_unique<SideBySide>(places);
    seen->know(places[0], moves);
    seen->know(places[1], false);
    REQUIRE(seen->segments.size() == 1);
    cut_between(seen->bodies, seen->in_map, seen->segments);
    CHECK(seen->segments.size() == (moves ? 2 : 1));
  }
}

TEST_CASE("where a side has the middle of who comes out does not depend on how much of him is in view") {
  Vec2 last;
  for (const double edge_y : {0.12, 0.08, 0.0, -0.08, -0.15}) {  // at 4 m twice as far aside
    const auto clusters = clusters_behind(edge_y);
    REQUIRE(clusters->size() == 1);
    const Observation seen = observe_new(*clusters, 0, 1);
    CHECK(seen.hidden_side == -1);
    CHECK(seen.position_in_map.y == Approx(0.15).margin(0.02));  // 0.25 m from the side that is seen, at 0.4
    CHECK(seen.position_in_map.x == Approx(4.0).margin(0.2));
    CHECK(seen.position_in_map.y - seen.radius_m < 2.0 * edge_y + 0.05);  // what is seen of him is his
    CHECK(norm(seen.was_off) == 0.0);
    last = seen.position_in_map;
  }
  const auto clusters = clusters_behind(-1.0);
  REQUIRE(clusters->size() == 1);
  Body body = born_at(last, 0.01, 0.25, time_from_seconds(0.0), 1);
  body.hidden_side = -1;
  (*clusters)[0].track_id = 1;
  Observation whole;
  REQUIRE(observe(body, *clusters, whole));
  CHECK(distance(whole.position_in_map, {4.0, 0.0}) < 0.03);
  CHECK(distance(whole.position_in_map - whole.was_off, last) < 0.05);
  body.arc_m = 0.4;  // once his width is known, what has been said of him stands
  REQUIRE(observe(body, *clusters, whole));
  CHECK(norm(whole.was_off) == 0.0);
}

TEST_CASE("a cluster between one who is surely near and one who may be anywhere is the former's") {
  const auto clusters = std::make_unique<Clusters>();
  REQUIRE(clusters->push_back({}));  // about the origin
  const auto bodies = std::make_unique<Bodies>();
  REQUIRE(bodies->push_back(born_at({0.0, 0.25}, 0.1, 0.27, time_from_seconds(0.0), 1)));  // 1.6 deviations off
  REQUIRE(bodies->push_back(born_at({0.0, 0.25}, 0.7, 0.27, time_from_seconds(0.0), 2)));  // 0.4
  associate(*bodies, *clusters);
  CHECK((*clusters)[0].track_id == 1);
}
