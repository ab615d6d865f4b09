#include "planner/tracking/departure.h"

#include <algorithm>

#include "tests/perception/room.h"
#include "tests/perception/walker.h"
#include "tests/support/catch.h"

using namespace jaywalk;
using namespace jaywalk::test;

namespace {

EvidenceMap nothing_known() { return EvidenceMap(256, 0.1, {}); }

/// Nothing is known but that beams passed over the cell of `place`.
EvidenceMap free_at(Vec2 place) {
  EvidenceMap still = nothing_known();
  still.add(still.cell_at(place), EvidenceMap::kMin);
  return still;
}

/// Judges bodies by one scan of a room.
struct Judge {
  explicit Judge(const Room& room, const EvidenceMap& map = nothing_known()) : scan(scan_of(room, {}, 1)), still(map) {}
  [[nodiscard]] Departure operator()(const Body& body) const { return departure(body, {sight, still, {}}); }

  LaserScan scan;
  EvidenceMap still;
  LineOfSight sight{scan, {}, {}, {}};
};

/// As seen when it went aside to (3, 0.21): its right and its left side lie behind and ahead on its way.
void show_sides(Body& body) {
  body.outline_in_map.clear();
  for (int k = 0; k < 5; ++k) (void)body.outline_in_map.push_back({3.0, 0.11 + 0.05 * k});
}

bool sees_it_set_out(const Body& body, const Room& room) { return Judge(room)(body) != Departure::kNone; }

}  // namespace

TEST_CASE("who walked a metre and is seen to have left has set out") {
  Room room = rectangle(12.0, 10.0);
  room.discs = {{{3.0, 0.5}, 0.1}};
  CHECK(sees_it_set_out(walker({3.0, -0.5}, {3.0, 0.5}), room));
}

TEST_CASE("a body that both sides of went along has set out for certain, and one that grew has not") {
  // 0.2 m in a second, as straight as can be.
  Body body = walker({3.0, 0.0}, {3.0, 0.2});
  body.arc_m = 0.25;
  const Judge judged(rectangle(12.0, 10.0));
  CHECK(judged(body) == Departure::kCertain);
  body.path.clear();
  for (int k = 1; k <= 10; ++k)  // its middle goes 0.2 m while one side stays where it is
    body.path.add(time_from_seconds(0.1 * k),
                  {.where_in_map = {3.0, 0.02 * k}, .width_m = 0.2 + 0.04 * k, .whole = true});
  CHECK(judged(body) == Departure::kNone);
}

TEST_CASE("what was seen whole at less than four places may have come into view on one side") {
  Body body = walker({3.0, 0.0}, {3.0, 0.3});
  body.arc_m = 0.25;
  body.free_share = 0.0;
  const Judge judged(rectangle(12.0, 10.0));
  const auto whole_for = [&](int places) {
    body.path.clear();
    for (int k = 1; k <= 10; ++k)
      body.path.add(time_from_seconds(0.1 * k), {.where_in_map = {3.0, 0.03 * k}, .whole = k > 10 - places});
    return judged(body);
  };
  CHECK(whole_for(4) == Departure::kCertain);
  CHECK(whole_for(3) == Departure::kLikely);  // its place of before is empty
}

TEST_CASE("who comes out from behind something has set out by the way of the side that is seen") {
  // 0.2 m in a second, straight, on ground that was free before. The filter does not believe it yet.
  Body body = walker({3.0, 0.0}, {3.0, 0.2});
  body.whole = false;
  body.track.velocity_in_map = {0.0, 0.05};
  const Judge judged(rectangle(12.0, 10.0));
  CHECK(judged(body) == Departure::kNone);
  body.edge_m = 0.03;
  const Body came_out = body;
  CHECK(judged(body) == Departure::kLikely);
  body.hidden_side = 1;
  CHECK(judged(body) == Departure::kLikely);
  body.outline_in_map[0] = body.anchor_outline[0];  // what is seen to end stands: more of a thing came into view
  CHECK(judged(body) == Departure::kNone);
  body.hidden_side = -1;
  CHECK(judged(body) == Departure::kLikely);
  body.outline_in_map.back() = body.anchor_outline.back();
  CHECK(judged(body) == Departure::kNone);
  body = came_out;
  body.edge_m = 0.15;  // so far apart are the beams: the way is not longer than one and a half of that
  CHECK(judged(body) == Departure::kNone);
}

TEST_CASE("a steady walk counts where it comes to ground that beams passed before, and else only what is long") {
  // 0.2 m in a second to the left, from a place that a wall hides: nothing tells whether it still stands there. A heap
  // of posts that shows another side does as much.
  Room room = rectangle(12.0, 10.0);
  room.walls.push_back({{2.0, 0.08}, {2.0, -1.0}});
  Body body = walker({3.0, 0.0}, {3.0, 0.2});
  body.free_share = 0.0;
  body.arc_m = 0.25;
  show_sides(body);
  const Vec2 ahead{3.0, 0.31}, behind{3.0, 0.11};
  CHECK(Judge(room)(body) == Departure::kNone);
  CHECK(Judge(room, free_at(ahead))(body) == Departure::kCertain);
  CHECK(Judge(room, free_at(behind))(body) == Departure::kNone);
  body.whole = false;  // it comes out from behind something
  body.edge_m = 0.03;
  CHECK(Judge(room)(body) == Departure::kNone);
  CHECK(Judge(room, free_at(ahead))(body) == Departure::kLikely);
  body.arc_m = 0.0;  // its width is not known yet
  body.path.clear();
  for (int k = 1; k <= 10; ++k)  // not as straight as a thing must go of which nothing is known
    body.path.add(time_from_seconds(0.1 * k), {{3.0 + (k % 2 == 0 ? 0.022 : -0.022), 0.02 * k}});
  CHECK(Judge(room, free_at(ahead))(body) == Departure::kLikely);
}

TEST_CASE("who leaves a place where beams then find nothing has set out, and not where they were not measured") {
  Room open;
  open.discs = {{{3.0, 0.2}, 0.1}};
  Body body = walker({3.0, 0.0}, {3.0, 0.2});
  body.free_share = 0.0;
  body.arc_m = 0.25;
  show_sides(body);
  Judge judged(open);
  CHECK(judged(body) == Departure::kCertain);
  for (float& range : judged.scan.range_m) range = range < 20.0F ? range : 0.0F;
  CHECK(judged(body) == Departure::kNone);
}

TEST_CASE("a steady walk of which the ground says nothing counts where both sides went along for a quarter metre") {
  Room room = rectangle(12.0, 10.0);
  room.walls.push_back({{2.0, 0.08}, {2.0, -1.0}});  // hides the place that it came from
  const Judge judged(room);
  const auto seen = [](double length_m, double width_change_m) {
    Body body = walker({3.0, 0.0}, {3.0, length_m});
    body.free_share = 0.0;
    body.arc_m = 0.25;
    body.path.clear();
    for (int k = 0; k <= 10; ++k)
      body.path.add(
          time_from_seconds(0.1 * k),
          {.where_in_map = {3.0, 0.1 * k * length_m}, .width_m = 0.5 + 0.1 * k * width_change_m, .whole = true});
    return body;
  };
  CHECK(judged(seen(0.3, 0.0)) == Departure::kCertain);
  CHECK(judged(seen(0.2, 0.0)) == Departure::kNone);  // a heap of posts goes 0.16 m
  CHECK(judged(seen(0.3, 0.12)) == Departure::kNone);
  Body part = seen(0.3, 0.0);
  part.whole = false;
  CHECK(judged(part) == Departure::kNone);
}

TEST_CASE("beams that end on a body do not say that it still stands where it set out from") {
  // Half a metre wide and 8 m off, it goes 0.15 m away and as far to the left. Its right side was at (8, -0.25), 0.21 m
  // from where it is now: more than 0.20 m, within which anything there is the same. But the beams to that place, three
  // to either side of -1.8 degrees, reach to -0.8, and its right side is at -0.7 degrees and 0.15 m farther off.
  Body body = walker({8.0, 0.0}, {8.15, 0.15});
  body.arc_m = 0.25;
  for (std::size_t k = 0; k < 5; ++k) {
    body.anchor_outline[k] = {8.0, -0.25 + 0.125 * static_cast<double>(k)};
    body.outline_in_map[k] = body.anchor_outline[k] + Vec2{0.15, 0.15};
  }
  Room room = rectangle(24.0, 10.0);
  room.walls.push_back({{8.15, -0.1}, {8.15, 0.4}});
  const Judge judged(room);
  CHECK(judged(body) == Departure::kNone);
  body.beams = {403, 413};  // beam 405 is straight ahead: -0.67 to 2.67 degrees
  CHECK(judged(body) == Departure::kCertain);
}

TEST_CASE("a body that came to free space is known by a shorter walk than one on unknown ground") {
  const Judge judged(rectangle(12.0, 10.0));
  Body body = walker({3.0, 0.0}, {3.0, 0.09});  // shorter than 0.10 m
  body.arc_m = 0.25;
  body.track.velocity_in_map = {0.0, 0.3};
  body.track.covariance = {.pp = 1e-4, .pv = 0.0, .vv = 0.01};
  body.models = MotionModels(body.track);
  CHECK(judged(body) == Departure::kCertain);
  body.free_share = 0.0;
  CHECK(judged(body) == Departure::kNone);
}

TEST_CASE("who stood has set out by his newest places alone") {
  const Judge judged(rectangle(12.0, 10.0));
  Body body = walker({3.0, 0.0}, {3.0, 0.16});  // on ground of which nothing is known
  body.arc_m = 0.25;
  body.free_share = 0.0;
  body.noise = 2.0;  // no filter foretold the first step
  body.track.velocity_in_map = {0.0, 0.4};
  body.track.covariance = {.pp = 1e-4, .pv = 0.0, .vv = 0.01};
  body.models = MotionModels(body.track);
  const auto stands_then_walks = [&](double grows_m) {
    body.path.clear();
    for (int k = 0; k < 20; ++k) {  // 4 cm a scan from the seventeenth on, of which every second scan sees a beam more
      const double steps = std::max(0, k - 15);
      body.path.add(time_from_seconds(0.1 * k), {.where_in_map = {3.0, 0.04 * steps},
                                                 .width_m = 0.5 + 0.06 * (k % 2) + grows_m * steps,
                                                 .spacing_m = 0.06,
                                                 .whole = true});
    }
    return judged(body);
  };
  CHECK(stands_then_walks(0.0) == Departure::kCertain);
  body.on_wall = true;  // for so long that he was taken for a wall
  CHECK(stands_then_walks(0.0) == Departure::kCertain);
  body.on_wall = false;
  CHECK(stands_then_walks(0.02) == Departure::kNone);  // 8 cm wider at the end: half of its way
  body.noise = 3.0;
  CHECK(stands_then_walks(0.0) == Departure::kNone);
  body.noise = 2.0;
  body.arc_m = 0.1;
  CHECK(stands_then_walks(0.0) == Departure::kNone);
  body.arc_m = 0.25;
  body.whole = false;
  CHECK(stands_then_walks(0.0) == Departure::kNone);
  body.whole = true;
  body.path.clear();
  for (int k = 0; k < 6; ++k)  // he never stood
    body.path.add(time_from_seconds(0.1 * k), {.where_in_map = {3.0, 0.032 * k}, .whole = true});
  CHECK(judged(body) == Departure::kLikely);
  body.noise = 1.0;  // the filter foretold it
  CHECK(judged(body) == Departure::kCertain);
  body.on_wall = true;  // and of a wall it is none
  CHECK(judged(body) == Departure::kNone);
}

TEST_CASE("who stood and was taken for a wall has set out where he left his place or came to free ground") {
  Room room = rectangle(12.0, 10.0);
  Body body = walker({3.0, 0.0}, {3.0, 0.2});
  body.arc_m = 0.25;
  body.free_share = 0.0;
  body.on_wall = true;
  show_sides(body);
  body.path.clear();
  for (int k = 0; k < 20; ++k)
    body.path.add(time_from_seconds(0.1 * k), {.where_in_map = {3.0, 0.04 * std::max(0, k - 14)}, .whole = true});
  CHECK(Judge(room)(body) == Departure::kCertain);  // beams pass over where he stood
  room.walls.push_back({{2.0, 0.08}, {2.0, -1.0}});
  CHECK(Judge(room)(body) == Departure::kNone);
  CHECK(Judge(room, free_at({3.0, 0.31}))(body) == Departure::kCertain);
}

TEST_CASE("who most likely stands has not set out") {
  Room room = rectangle(12.0, 10.0);
  room.discs = {{{3.0, 0.5}, 0.1}};
  Body body = walker({3.0, -0.5}, {3.0, 0.5});
  Track still = body.track;
  still.covariance = {.pp = 1e-4, .pv = 0.0, .vv = 1e-4};
  body.models = MotionModels(still);
  for (int k = 0; k < 20; ++k) {
    body.models.predict(still, 0.1);
    body.models.correct(still, {3.0, 0.5}, 0.02);
  }
  CHECK_FALSE(sees_it_set_out(body, room));
}

TEST_CASE("whose place still returns beams has not set out") {
  Room room = rectangle(12.0, 10.0);
  room.discs = {{{3.0, 0.5}, 0.1}, {{3.0, -0.5}, 0.1}};
  CHECK_FALSE(sees_it_set_out(walker({3.0, -0.5}, {3.0, 0.5}), room));
}

TEST_CASE("who came the whole way in one hop has not set out") {
  Room room = rectangle(12.0, 10.0);
  room.discs = {{{3.0, 0.5}, 0.1}};
  Body body = walker({3.0, -0.5}, {3.0, 0.5});
  body.path.clear();
  for (int k = 0; k < 10; ++k) body.path.add(time_from_seconds(0.1 * k), {{3.0, k < 5 ? -0.5 : 0.5}});
  CHECK_FALSE(sees_it_set_out(body, room));
}

TEST_CASE("on ground of which nothing is known a short walk far off is not enough") {
  // Coming towards the laser hides the place behind. Half a metre in a second, 8 m off: 0.8 m are wanted there, and
  // 0.5 m at 3 m, less what rounding takes.
  Body far = walker({8.5, 0.0}, {8.0, 0.0}), near = walker({3.6, 0.0}, {3.0, 0.0});
  far.free_share = near.free_share = 0.0;
  Room room = rectangle(24.0, 10.0);
  room.discs = {{{8.0, 0.0}, 0.2}};
  CHECK_FALSE(sees_it_set_out(far, room));
  room.discs = {{{3.0, 0.0}, 0.2}};
  CHECK(sees_it_set_out(near, room));
}

TEST_CASE("a piece of wall that slides along itself has not set out, and one broadside on has") {
  // 0.4 m wide pieces; the place that each came from is out of sight behind a post.
  Room room = rectangle(24.0, 10.0);
  room.discs = {{{2.0, 0.0}, 0.3}};
  Body slides = walker({4.0, 0.0}, {6.0, 0.0}), strides = slides;
  slides.outline_in_map.clear(), strides.outline_in_map.clear();
  for (int k = 0; k < 5; ++k) {
    (void)slides.outline_in_map.push_back({5.8 + 0.1 * k, 0.0});
    (void)strides.outline_in_map.push_back({6.0, -0.2 + 0.1 * k});
  }
  CHECK_FALSE(sees_it_set_out(slides, room));
  CHECK(sees_it_set_out(strides, room));
}

TEST_CASE(
    "a flat piece that slides along itself has not set out where beams pass over its old place, a round one has") {
  // 0.4 m wide, at a slant, 0.85 m along its own line in a second: other parts of one wall come into view as a robot
  // drives, and behind the gap that it is seen through another wall.
  Body flat = walker({4.0, -0.6}, {4.6, 0.0});
  flat.whole = false;
  flat.free_share = 0.0;
  flat.outline_in_map.clear();
  Body round = flat;
  for (int k = -2; k <= 2; ++k) {
    const Vec2 p{4.6 + 0.07 * k, 0.07 * k};
    (void)flat.outline_in_map.push_back(p);
    (void)round.outline_in_map.push_back(p + Vec2{-0.02, 0.02} * (4.0 - k * k));
  }
  const Room room = rectangle(12.0, 10.0);
  CHECK_FALSE(sees_it_set_out(flat, room));
  CHECK(sees_it_set_out(round, room));
}
