#include <memory>
#include <utility>

#include "tests/perception/cut_scan.h"
#include "tests/perception/room.h"
#include "tests/support/catch.h"

using namespace jaywalk;
using namespace jaywalk::test;

namespace {

using Cut = std::unique_ptr<CutScan>;

/// A scan, cut and judged against a map.
Cut cut_on(const EvidenceMap& still, const Room& room, const Fan& fan = {}, double noise_m = 0.0) {
  auto cut = std::make_unique<CutScan>(scan_of(room, {}, 1, noise_m, fan));
  for (std::size_t k = 0; k < cut->points.size(); ++k)
    cut->in_map.ground[k] = ground_at(still, cut->in_map.position[k], cut->points[k].range_m);
  cut->find();
  return cut;
}

Cut cut_on_unknown(const Room& room, double noise_m = 0.0) {
  return cut_on(EvidenceMap(256, 0.1, {}), room, {}, noise_m);
}

EvidenceMap seen_free_all_over() {
  EvidenceMap map(256, 0.1, {});
  for (int j = -128; j < 128; ++j) {
    for (int i = -128; i < 128; ++i) map.add({i, j}, -40);
  }
  return map;
}

Cut cut_on_free(const Room& room, const Fan& fan = {}) { return cut_on(seen_free_all_over(), room, fan); }

}  // namespace

TEST_CASE("two points are one thing or two whichever way the scanner turns") {
  const double step = 0.00873;
  ScanPoints points;
  (void)points.push_back({.in_robot = direction(0.0) * 10.0, .range_m = 10.0, .beam = 0});
  (void)points.push_back({.in_robot = direction(step) * 10.25, .range_m = 10.25, .beam = 1});  // 0.265 m apart
  Segments segments;
  cut_at_jumps(points, {.beams = 2, .angle_step_rad = step}, segments);
  CHECK(segments.size() == 1);  // three spacings there: 0.268 m; at the nearer one 0.262 m
  std::swap(points[0], points[1]);
  cut_at_jumps(points, {.beams = 2, .angle_step_rad = -step}, segments);
  CHECK(segments.size() == 1);
}

TEST_CASE("a wall at a slant is one thing, and a body before it another") {
  Room room{.walls = {{{2.0, 1.0}, {12.0, 1.0}}}};  // 27 to 5 degrees; its farthest points are 0.7 m apart
  const Cut wall = cut_on_unknown(room, 0.01);
  CHECK(wall->segments.back().first == 1);  // the first and farthest has no step beyond it
  room.discs = {{{6.0, 0.5}, 0.27}};
  const Cut cut = cut_on_unknown(room, 0.01);
  REQUIRE(cut->detections.size() == 1);
  CHECK(distance(cut->detections[0].centre_in_map, {6.0, 0.5}) < 0.05);
}

TEST_CASE("a body's centre lies behind its visible arc") {
  const Cut cut = cut_on_free({.discs = {{{3.0, 1.0}, 0.27}}});
  REQUIRE(cut->detections.size() == 1);
  const Detection& detection = cut->detections[0];
  CHECK(distance(detection.centre_in_map, {3.0, 1.0}) < 0.04);
  CHECK(detection.radius_m == Approx(0.27).margin(0.03));
  CHECK(detection.in_free_space);
  CHECK_FALSE(detection.leg());
}

TEST_CASE("what is wider than 1.1 m may be a body where it is seen to end on both sides, what is far wider is a wall") {
  const Wall wall{{3.0, -0.85}, {3.0, 0.85}};
  const Cut cut = cut_on_free({.walls = {wall}});
  CHECK(cut->segments.size() == 1);
  CHECK(cut->detections.empty());
  CHECK(cut_on_free(with({}, {wall}))->detections.empty());  // seen to end on both sides
  const Disc wide{{3.0, 0.0}, 0.7};
  const Wall hides_a_tenth{{1.5, 0.29}, {1.5, 0.9}};
  REQUIRE(cut_on_free(with({wide}))->detections.size() == 1);
  CHECK(cut_on_free(with({wide}, {hides_a_tenth}))->detections.size() == 1);  // the little wall alone
  CHECK(cut_on_free({.discs = {wide}})->detections.empty());                  // nothing is seen beside it
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
  for (int k = 0; k < 14; ++k) map.add_hit({2.05, 0.05}, 10, 1.0 / 15);  // 0.93 s
  CHECK(map.occupied({20, 0}));
  CHECK(ground_at(map, {2.05, 0.05}, 1.0) == Ground::kUnknown);
  map.add_hit({2.05, 0.05}, 10, 1.0 / 15);
  CHECK(ground_at(map, {2.05, 0.05}, 1.0) == Ground::kWall);
  map.add({20, 0}, -64);  // looked through: whatever comes next is new
  map.add_hit({2.05, 0.05}, 40, 9.0);
  CHECK(map.occupied({20, 0}));
  CHECK_FALSE(map.stands({20, 0}));  // one hit after a gap is one hit
  EvidenceMap often(64, 0.1, {});
  for (int k = 0; k < 38; ++k) often.add_hit({2.05, 0.05}, 10, 1.0 / 40);
  CHECK_FALSE(often.stands({20, 0}));
  for (int k = 0; k < 4; ++k) often.add_hit({2.05, 0.05}, 10, 1.0 / 40);
  CHECK(often.stands({20, 0}));
}

TEST_CASE("in unknown space what goes on behind nearer things on both sides is no body") {
  // A wall seen through a gap of 0.4 m, and a disc that nothing hides.
  const Cut cut =
      cut_on_unknown({.walls = {{{1.0, 0.2}, {1.0, 2.0}}, {{1.0, -0.2}, {1.0, -2.0}}, {{1.5, -2.0}, {1.5, 2.0}}},
                      .discs = {{{-1.0, 2.0}, 0.2}}});
  CHECK(cut->near({-1.0, 2.0}, 0.1) != nullptr);
  CHECK(cut->near({1.5, 0.0}, 0.4) == nullptr);
}

TEST_CASE("a body half behind something nearer knows which side is hidden, and which ends where nothing returns") {
  Room room{.walls = {{{1.0, 0.0}, {1.0, -0.8}}}, .discs = {{{3.0, 0.0}, 0.27}}};  // hides what is right of ahead
  const Cut before_nothing = cut_on_free(room);
  const Detection* half = before_nothing->near({3.0, 0.1}, 0.3);
  REQUIRE(half != nullptr);
  CHECK(half->low_end == End::kHidden);
  CHECK(half->high_end == End::kUnknown);
  room.walls.push_back({{5.0, -4.0}, {5.0, 4.0}});
  const Cut before_wall = cut_on_free(room);
  half = before_wall->near({3.0, 0.1}, 0.3);
  REQUIRE(half != nullptr);
  CHECK(half->low_hidden());  // beams count from right to left
  CHECK_FALSE(half->high_hidden());
  CHECK_FALSE(half->whole());
  CHECK(half->radius_m == Approx(0.135).margin(0.02));
  CHECK(half->high_side.y > 0.99);
  CHECK(half->along.x > 0.99);
}

TEST_CASE("what is half behind a leg is not behind more: legs take turns in hiding one another") {
  // The nearer hides what lies up to 0.09 m left of straight.
  const Cut cut = cut_on_free({.discs = {{{2.0, 0.0}, 0.06}, {{3.0, 0.15}, 0.1}}});
  const Detection* const half = cut->near({3.0, 0.17}, 0.2);
  REQUIRE(half != nullptr);
  CHECK(half->low_hidden());
  CHECK_FALSE(half->behind_more);
}

TEST_CASE("a narrow piece hides more than a leg where something wide that is nearer hides it, well before") {
  const auto behind_more = [](double piece_x_m) {
    // A wall hides all but a hand's breadth of a piece beside it, and that one a body's right half.
    const Cut cut = cut_on_free(
        {.walls = {{{0.5, 0.0}, {0.5, -0.8}}, {{piece_x_m, -1.0}, {piece_x_m, 0.1}}, {{6.0, -4.0}, {6.0, 4.0}}},
         .discs = {{{3.0, 0.1 * 3.0 / piece_x_m}, 0.27}}});
    const Detection* const body = cut->near({3.0, 0.3}, 0.35);
    return body != nullptr && body->behind_more;
  };
  CHECK(behind_more(1.5));
  CHECK_FALSE(behind_more(2.5));  // a piece of the same heap
}

/// Of what has stood there for two seconds.
Cut stood(const Room& room) {
  EvidenceMap map = seen_free_all_over();
  const LaserScan scan = scan_of(room, {}, 1);
  for (std::size_t b = 0; b < scan.beam_count; ++b) {
    if (!scan.is_hit(b)) continue;
    for (int k = 0; k < 8; ++k)
      map.add_hit(direction(scan.angle_rad(b)) * static_cast<double>(scan.range_m[b]), 10, 0.25);
  }
  return cut_on(map, room);
}

TEST_CASE("who stood for long is watched before open space as well, where no beam beside him returns anything") {
  const double away_m = GENERATE(0.6, 1.0, 3.0, 7.0);
  Room room{.discs = {{direction(0.5) * away_m, 0.27}}};
  for (const double slant : {-0.5, -0.25, 0.0, 0.25, 0.5}) {  // panels, half a metre wide, at up to 80 degrees
    const Vec2 place = direction(-1.2 + slant) * 3.0, along = direction(-1.2 + slant + 2.8 * slant + kPi / 2);
    room.walls.push_back({place + along * -0.25, place + along * 0.25});
  }
  const Cut cut = stood(room);
  REQUIRE(cut->detections.size() == 1);
  const Detection& him = cut->detections[0];
  CHECK(distance(him.centre_in_map, room.discs[0].centre) < 0.1);
  CHECK(him.low_end == End::kUnknown);
  CHECK(him.on_wall);
}

TEST_CASE("what has stood there half hidden is not watched, round or not, nor where nothing is seen beside it") {
  // Half of it is as wide as a body.
  CHECK(stood({.walls = {{{1.0, 0.0}, {1.0, -1.2}}}, .discs = {{{3.0, 0.0}, 0.5}}})->detections.empty());
}

TEST_CASE("where a wall stands only what stands alone and is as wide as a body is watched") {
  const Wall half_as_wide_as_a_body{{1.0, 2.6}, {1.2, 2.9}};
  const Cut cut = stood(
      rectangle(10.0, 8.0, {{{3.0, 1.0}, 0.27}, {{2.0, -1.5}, 0.08}, {{3.4, 2.9}, 0.9}}, {half_as_wide_as_a_body}));
  REQUIRE(cut->detections.size() == 1);
  CHECK(distance(cut->detections[0].centre_in_map, {3.0, 1.0}) < 0.04);
  CHECK(cut->detections[0].on_wall);
  CHECK_FALSE(cut->detections[0].in_free_space);
}

TEST_CASE("what reaches the end of the sweep may go on outside it") {
  const Cut cut = cut_on_free(rectangle(10.0, 10.0, {{direction(0.75 * kPi) * 3.0, 0.27}}));
  REQUIRE(cut->detections.size() == 1);
  CHECK(cut->detections[0].high_hidden());
  CHECK_FALSE(cut->detections[0].low_hidden());
  CHECK(cut->detections[0].beams.last == 810);
}

TEST_CASE("who stands where a scanner that looks all round begins its turn is one body, whole") {
  const Room room = rectangle(10.0, 8.0, {{{3.0, 0.0}, 0.27}});
  for (const double step_deg : {0.5, -0.5}) {         // from straight ahead on, either way round
    for (const std::uint32_t beams : {720U, 721U}) {  // the last beam beside the first, or on it
      const Fan fan{.beams = beams, .first_rad = 0.0, .step_rad = step_deg * kPi / 180.0};
      const Cut cut = cut_on_free(room, fan);
      REQUIRE(cut->detections.size() == 1);
      const Detection& detection = cut->detections[0];
      CHECK(distance(detection.centre_in_map, {3.0, 0.0}) < 0.04);
      CHECK(detection.low_end == End::kSeen);
      CHECK(detection.high_end == End::kSeen);
      CHECK(detection.radius_m == Approx(0.27).margin(0.03));
      CHECK(detection.beams.has(2));
      CHECK(detection.beams.has(718));
      CHECK_FALSE(detection.beams.has(360));
    }
  }
}

TEST_CASE("where a scan all round begins, sides and what hides them are told beyond its ends as well") {
  const Wall hides_the_right_half{{1.5, -1.0}, {1.5, -0.005}};  // up to the last beam
  const Room room = rectangle(10.0, 8.0, {{{3.0, 0.0}, 0.27}}, {hides_the_right_half});
  const Fan fan{.beams = 720, .first_rad = 0.0, .step_rad = kPi / 360.0};
  const Cut cut = cut_on_free(room, fan);
  REQUIRE(cut->detections.size() == 2);  // the wall is as wide as a body may be
  const Detection& half = cut->detections[0].centre_in_map.y > 0.0 ? cut->detections[0] : cut->detections[1];
  CHECK(half.low_end == End::kHidden);
  CHECK(half.high_end == End::kSeen);
  CHECK(half.behind_more);
}

TEST_CASE("a circular room without a jump is one wall, and no body though its ends meet") {
  const auto scan = std::make_unique<LaserScan>(scan_of({}, {}, 1, 0.0, {.beams = 720, .step_rad = kPi / 360.0}));
  for (std::size_t b = 0; b < scan->beam_count; ++b) scan->range_m[b] = 3.0F;
  const auto cut = std::make_unique<CutScan>(*scan);
  cut->find();
  CHECK(cut->points[0].beam == 0);
  CHECK(cut->segments.size() == 1);
  CHECK(cut->detections.empty());
}

TEST_CASE("a scan of which every beam is a piece of its own is taken apart to its end") {
  const auto scan = std::make_unique<LaserScan>(scan_of({}, {}, 1, 0.0, {.beams = 2048, .step_rad = kPi / 1100.0}));
  for (std::size_t b = 0; b < scan->beam_count; ++b) scan->range_m[b] = b % 2 == 0 ? 1.0F : 3.0F;
  const auto cut = std::make_unique<CutScan>(*scan);
  CHECK(cut->segments.size() == 2048);
  CHECK(cut->segments.back().last == 2047);
}
