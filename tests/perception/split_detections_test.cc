#include <memory>

#include "planner/tracking/detection.h"
#include "planner/tracking/target.h"
#include "tests/perception/room.h"
#include "tests/support/catch.h"

using namespace jaywalk;
using namespace jaywalk::test;

namespace {

/// Targets 0.27 m in radius that were seen three times, each where a disc of the scan is; and the scan cut at jumps.
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
    Target target = born_at(place, 0.01, 0.27, time_from_seconds(0.0), static_cast<std::uint32_t>(targets.size() + 1));
    target.estimate.track.hits = 3;
    target.estimate.track.moving = moving;
    target.appearance.arc_m = 0.27;
    REQUIRE(targets.push_back(target));
  }
  /// The width of segment `k`, m.
  [[nodiscard]] double width_m(std::size_t k) const {
    return distance(in_map.position[segments[k].first], in_map.position[segments[k].last]);
  }

  ScanPoints points;
  PointsInMap in_map;
  Segments segments;
  Targets targets;
};

}  // namespace

TEST_CASE("three known targets a hand apart are three segments and unknown ones stay one") {
  const std::vector<Vec2> places{{3.0, -0.57}, {3.0, 0.0}, {3.0, 0.57}};  // 3 cm between them
  const auto seen = std::make_unique<SideBySide>(places);
  REQUIRE(seen->segments.size() == 1);
  split_detections(seen->targets, seen->in_map, seen->segments);
  CHECK(seen->segments.size() == 1);

  for (const Vec2 place : places) seen->know(place);
  split_detections(seen->targets, seen->in_map, seen->segments);
  REQUIRE(seen->segments.size() == 3);
  for (std::size_t k = 0; k < 3; ++k) CHECK(seen->width_m(k) == Approx(0.53).margin(0.04));  // 0.54 less a beam
  CHECK(seen->segments[0].first == 0);
  CHECK(seen->segments[1].first == seen->segments[0].last + 1);  // no point is lost
  CHECK(seen->segments[2].first == seen->segments[1].last + 1);
  CHECK(seen->segments[2].last + 1 == seen->points.size());
}

TEST_CASE("one target is not cut in two for another that is expected half in it") {
  const auto seen = std::make_unique<SideBySide>(std::vector<Vec2>{{3.0, 0.0}});
  seen->know({3.0, -0.2});  // they begin and end it, but 0.54 m is less than three quarters of 1.08 m
  seen->know({3.0, 0.2});
  split_detections(seen->targets, seen->in_map, seen->segments);
  CHECK(seen->segments.size() == 1);
}

TEST_CASE("two of whom one moves are cut and two that stand are not") {
  const std::vector<Vec2> places{{3.0, -0.285}, {3.0, 0.285}};
  for (const bool moves : {false, true}) {
    const auto seen = std::make_unique<SideBySide>(places);
    seen->know(places[0], moves);
    seen->know(places[1], false);
    REQUIRE(seen->segments.size() == 1);
    split_detections(seen->targets, seen->in_map, seen->segments);
    CHECK(seen->segments.size() == (moves ? 2 : 1));
  }
}
