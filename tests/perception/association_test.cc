#include <memory>

#include "planner/tracking/target.h"
#include "tests/perception/cut_scan.h"
#include "tests/perception/room.h"
#include "tests/support/catch.h"

using namespace jaywalk;
using namespace jaywalk::test;

namespace {

/// What is seen from the origin of a room whose ground was free.
std::unique_ptr<Detections> clusters_of(const Room& room) {
  const auto cut = std::make_unique<CutScan>(scan_of(room, {}, 1));
  cut->find();
  return std::make_unique<Detections>(cut->detections);
}

/// What is seen of a disc of 0.4 m about (4, 0), from the origin, behind a wall 2 m off that ends at `edge_y`.
std::unique_ptr<Detections> clusters_behind(double edge_y) {
  return clusters_of({.walls = {{{2.0, -3.0}, {2.0, edge_y}}}, .discs = {{{4.0, 0.0}, 0.4}}});
}

/// Targets 0.27 m in radius that were seen three times, each where a disc of the scan is; and the scan cut at jumps.
struct SideBySide : CutScan {
  explicit SideBySide(const std::vector<Vec2>& places) : CutScan(scan_of(discs_at(places), {}, 1)) {}
  static Room discs_at(const std::vector<Vec2>& places) {
    Room room;
    for (const Vec2 place : places) room.discs.push_back({place, 0.27});
    return room;
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

  Targets targets;
};

}  // namespace

TEST_CASE("where a side has the middle of who comes out does not depend on how much of him is in view") {
  Vec2 last;
  for (const double edge_y : {0.12, 0.08, 0.0, -0.08, -0.15}) {  // at 4 m twice as far aside
    const auto detections = clusters_behind(edge_y);
    REQUIRE(detections->size() == 1);
    Observation seen;
    REQUIRE(observe_new(*detections, 0, 1, seen));
    CHECK(seen.hidden_side == -1);
    CHECK(seen.position_in_map.y == Approx(0.15).margin(0.02));  // 0.25 m from the side that is seen, at 0.4
    CHECK(seen.position_in_map.x == Approx(4.0).margin(0.2));
    CHECK(seen.position_in_map.y - seen.radius_m < 2.0 * edge_y + 0.05);  // what is seen of him is his
    CHECK(norm(seen.was_off) == 0.0);
    last = seen.position_in_map;
  }
  const auto detections = clusters_behind(-1.0);
  REQUIRE(detections->size() == 1);
  Target target = born_at(last, 0.01, 0.25, time_from_seconds(0.0), 1);
  target.appearance.hidden_side = -1;
  (*detections)[0].track_id = 1;
  Observation whole;
  REQUIRE(observe(target.estimate.track, target.appearance, *detections, whole));
  CHECK(distance(whole.position_in_map, {4.0, 0.0}) < 0.03);
  CHECK(distance(whole.position_in_map - whole.was_off, last) < 0.05);
  target.appearance.arc_m = 0.4;  // once his width is known, what has been said of him stands
  REQUIRE(observe(target.estimate.track, target.appearance, *detections, whole));
  CHECK(norm(whole.was_off) == 0.0);
}

TEST_CASE("who goes behind something is as wide as he was") {
  const auto detections = clusters_behind(0.0);
  REQUIRE(detections->size() == 1);
  const Observation unknown = observation_of(*detections, 0, -1, 0.0, false);
  CHECK(unknown.radius_m < 0.3);
  CHECK(observation_of(*detections, 0, -1, 0.4, false).radius_m == 0.4);
}

TEST_CASE("a detection between one who is surely near and one who may be anywhere is the former's") {
  const auto detections = std::make_unique<Detections>();
  REQUIRE(detections->push_back({}));  // about the origin
  const auto targets = std::make_unique<Targets>();
  REQUIRE(targets->push_back(born_at({0.0, 0.25}, 0.1, 0.27, time_from_seconds(0.0), 1)));  // 1.6 deviations off
  REQUIRE(targets->push_back(born_at({0.0, 0.25}, 0.7, 0.27, time_from_seconds(0.0), 2)));  // 0.4
  associate(*targets, *detections);
  CHECK((*detections)[0].track_id == 1);
}

TEST_CASE("two legs have their middle between them and of one alone it is deeper and less sure") {
  const auto both = clusters_of({.discs = {{{4.0, 0.15}, 0.06}, {{4.0, -0.15}, 0.06}}});
  REQUIRE(both->size() == 2);
  Observation seen;
  REQUIRE(observe_new(*both, 0, 1, seen));
  CHECK(distance(seen.position_in_map, {4.0, 0.0}) < 0.02);
  CHECK((*both)[1].track_id == 1);
  const double sure_m = seen.std_m;

  const auto one = clusters_of({.discs = {{{4.0, 0.0}, 0.06}}});
  REQUIRE(one->size() == 1);
  REQUIRE(observe_new(*one, 0, 1, seen));
  CHECK(distance(seen.position_in_map, {4.08, 0.0}) < 0.02);  // the other one stands behind it
  CHECK(seen.std_m > 2.0 * sure_m);

  const auto merged = clusters_of({.discs = {{{4.0, 0.07}, 0.06}, {{4.0, -0.07}, 0.06}}});
  REQUIRE(merged->size() == 1);  // 2 cm between them
  REQUIRE(observe_new(*merged, 0, 1, seen));
  CHECK(distance(seen.position_in_map, {4.0, 0.0}) < 0.1);
  CHECK(seen.std_m == sure_m);
}

TEST_CASE("who was seen on two legs is no arc when one hides the other or both are side by side") {
  Target target = born_at({4.0, 0.0}, 0.1, 0.25, time_from_seconds(0.0), 7);
  Observation seen;
  const auto see = [&](const Room& room) {
    const auto detections = clusters_of(room);
    for (Detection& c : *detections) c.track_id = 7;
    CHECK(observe(target.estimate.track, target.appearance, *detections, seen));
  };
  const Room side_by_side{.discs = {{{4.0, 0.1}, 0.08}, {{4.0, -0.1}, 0.08}}};
  see(side_by_side);
  CHECK(seen.arc_m > 0.15);  // it might as well be a body
  const double arc_m = seen.arc_m;
  target.appearance.legs_share = 1.0;
  see(side_by_side);
  CHECK(seen.arc_m == 0.0);
  CHECK(seen.std_m == Approx(0.07));

  const Room half_a_leg{.walls = {{{2.0, 0.02}, {2.0, 0.1}}}, .discs = {{{4.0, 0.0}, 0.06}}};
  target.appearance.legs_share = 0.0;
  target.appearance.arc_m = arc_m;
  see(half_a_leg);
  CHECK(seen.std_m < 0.05);  // less of a known body is in view
  target.appearance.legs_share = 1.0;
  target.appearance.arc_m = 0.0;
  see(half_a_leg);
  CHECK(seen.std_m > 0.2);
}

TEST_CASE("two points are a leg where legs have no more, and a new target only with another one") {
  CHECK(clusters_of({.discs = {{{2.0, 0.0}, 0.009}}})->empty());  // at 2 m a leg has nine

  const auto one = clusters_of({.discs = {{{9.0, 0.026}, 0.06}}});
  REQUIRE(one->size() == 1);
  REQUIRE((*one)[0].sparse);
  Observation seen;
  CHECK_FALSE(observe_new(*one, 0, 1, seen));
  CHECK((*one)[0].track_id == 0);
  Target known = born_at({9.0, 0.0}, 0.1, 0.25, time_from_seconds(0.0), 7);
  (*one)[0].track_id = 7;
  CHECK(observe(known.estimate.track, known.appearance, *one, seen));

  const auto two = clusters_of({.discs = {{{9.0, 0.13}, 0.06}, {{9.0, -0.13}, 0.06}}});
  REQUIRE(two->size() == 2);
  CHECK(observe_new(*two, 0, 1, seen));
  CHECK((*two)[1].track_id == 1);

  const auto beside = clusters_of({.discs = {{{9.0, 0.13}, 0.06}, {{9.0, -0.13}, 0.06}, {{5.0, 0.155}, 0.06}}});
  REQUIRE(beside->size() == 2);  // the post and the leg beside which nothing stands
  CHECK((*beside)[0].sparse);
  CHECK_FALSE((*beside)[1].sparse);
}

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

TEST_CASE("two of whom one moves are cut, two that stand are not, nor is one for another expected half in it") {
  const auto segments_of = [](const std::vector<Vec2>& places, double aside_m, bool left_moves, bool right_moves) {
    const auto seen = std::make_unique<SideBySide>(places);
    seen->know({3.0, -aside_m}, left_moves);
    seen->know({3.0, aside_m}, right_moves);
    REQUIRE(seen->segments.size() == 1);
    split_detections(seen->targets, seen->in_map, seen->segments);
    return seen->segments.size();
  };
  CHECK(segments_of({{3.0, -0.285}, {3.0, 0.285}}, 0.285, true, false) == 2);
  CHECK(segments_of({{3.0, -0.285}, {3.0, 0.285}}, 0.285, false, false) == 1);
  CHECK(segments_of({{3.0, 0.0}}, 0.2, true, true) == 1);  // 0.54 m, less than three quarters of 1.08 m
}
