#include "planner/tracking/motion_onset.h"

#include <algorithm>
#include <chrono>

#include "tests/perception/room.h"
#include "tests/perception/walker.h"
#include "tests/support/catch.h"

using namespace jaywalk;
using namespace jaywalk::test;

namespace {

/// Judges bodies by one scan of a room, and one of what it was like 0.7 s before.
struct Judge {
  explicit Judge(const Room& room) : scan(scan_of(room, {}, 1)) {}
  Judge(const Room& room, const Room& before) : Judge(room) { past.keep(scan_of(before, {}, 1), {}, {}, {}); }
  [[nodiscard]] MotionOnset operator()(const Target& target) const {
    return motion_onset(target, {sight, past, scan.stamp + std::chrono::milliseconds(700), {}});
  }

  LaserScan scan;
  PastScans past;
  LineOfSight sight{scan, {}, {}, {}};
};

/// A walker as wide as people.
Target body(Vec2 from, Vec2 to, double free_share) {
  Target target = walker(from, to);
  target.appearance.arc_m = 0.25;
  target.onset.free_share = free_share;
  return target;
}

/// Five points of its outline.
void show(Target& target, Vec2 middle, Vec2 step) {
  target.appearance.outline_in_map.clear();
  for (int k = -2; k <= 2; ++k) (void)target.appearance.outline_in_map.push_back(middle + step * k);
}

/// As seen when it went aside to (3, 0.21): its right and its left side lie behind and ahead on its way.
void show_sides(Target& target) { show(target, {3.0, 0.21}, {0.0, 0.05}); }

/// Its places, in its history alone, 0.1 s apart.
template <class SampleAt>
void place(Target& target, int first, int last, const SampleAt& sample_at) {
  target.onset.positions = history(first, last, sample_at);
}

/// It goes to the left, says its filter.
void go_left(Target& target, double mps) {
  target.estimate.track.velocity_in_map = {0.0, mps};
  target.estimate.track.covariance = {.pp = 1e-4, .pv = 0.0, .vv = 0.01};
  target.estimate.filter = ImmFilter(target.estimate.track);
}

/// The first hides (3, 0) from the laser; the second stands where a body is that went from there to (3, 0.2).
const Wall kHides{{2.0, 0.08}, {2.0, -1.0}}, kStood{{3.0, 0.05}, {3.0, 0.4}};

bool sees_it_start(const Target& target, const Room& room) { return Judge(room)(target) != MotionOnset::kNone; }

}  // namespace

TEST_CASE("who walked a metre and left has set out: not in one hop, nor where beams still end, nor if he stands") {
  const Room left = with({{{3.0, 0.5}, 0.1}});
  const Target walked = walker({3.0, -0.5}, {3.0, 0.5});
  CHECK(sees_it_start(walked, left));
  CHECK_FALSE(sees_it_start(walked, with({{{3.0, 0.5}, 0.1}, {{3.0, -0.5}, 0.1}})));
  Target hopped = walked;
  place(hopped, 0, 9, [](int k) { return Sample{{3.0, k < 5 ? -0.5 : 0.5}}; });
  CHECK_FALSE(sees_it_start(hopped, left));
  Target stands = walked;
  Track still = walked.estimate.track;
  still.covariance = {.pp = 1e-4, .pv = 0.0, .vv = 1e-4};
  stands.estimate.filter = ImmFilter(still);
  for (int k = 0; k < 20; ++k) {
    stands.estimate.filter.predict(still, 0.1);
    stands.estimate.filter.correct(still, {3.0, 0.5}, 0.02);
  }
  CHECK_FALSE(sees_it_start(stands, left));
}

TEST_CASE("a target that both sides of went along has set out for certain, and one that grew has not") {
  // 0.2 m in a second, as straight as can be.
  Target target = body({3.0, 0.0}, {3.0, 0.2}, 1.0);
  const Judge judged(with({}));
  CHECK(judged(target) == MotionOnset::kCertain);
  place(target, 1, 10, [](int k) {  // its middle goes 0.2 m while one side stays where it is
    return Sample{.where_in_map = {3.0, 0.02 * k}, .width_m = 0.2 + 0.04 * k, .whole = true};
  });
  CHECK(judged(target) == MotionOnset::kNone);
}

TEST_CASE("what was seen whole at less than four places may have come into view on one side") {
  Target target = body({3.0, 0.0}, {3.0, 0.3}, 0.0);
  const Judge judged(with({}));
  const auto whole_for = [&](int places) {
    place(target, 1, 10, [&](int k) { return Sample{.where_in_map = {3.0, 0.03 * k}, .whole = k > 10 - places}; });
    return judged(target);
  };
  CHECK(whole_for(4) == MotionOnset::kCertain);
  CHECK(whole_for(3) == MotionOnset::kLikely);  // its place of before is empty
}

TEST_CASE("what stands where something stood a moment ago has not set out, however it seems to go") {
  // 0.2 m in a second to the left, from a place that a wall hides. A heap of posts that shows another side does as
  // much.
  const Room room = with({}, {kHides});
  Target target = body({3.0, 0.0}, {3.0, 0.2}, 0.0);
  show_sides(target);
  CHECK(Judge(room)(target) == MotionOnset::kCertain);
  CHECK(Judge(room, with({}, {kHides, kStood}))(target) == MotionOnset::kNone);
  CHECK(Judge(room, room)(target) == MotionOnset::kCertain);
  const Room hidden = with({}, {kHides, {{1.0, -1.0}, {1.0, 1.0}}});  // that scan tells nothing of it
  CHECK(Judge(room, hidden)(target) == MotionOnset::kCertain);
}

TEST_CASE("who leaves a place where beams then find nothing has set out") {
  Target target = body({3.0, 0.0}, {3.0, 0.2}, 0.0);
  show_sides(target);
  CHECK(Judge({.discs = {{{3.0, 0.2}, 0.1}}})(target) == MotionOnset::kCertain);
}

TEST_CASE("beams that end on a target do not say that it still stands where it set out from") {
  // Half a metre wide and 8 m off, it goes 0.15 m away and as far to the left. Its right side was at (8, -0.25), 0.21 m
  // from where it is now: more than 0.20 m, within which anything there is the same. But the beams to that place, three
  // to either side of -1.8 degrees, reach to -0.8, and its right side is at -0.7 degrees and 0.15 m farther off.
  Target target = body({8.0, 0.0}, {8.15, 0.15}, 1.0);
  for (std::size_t k = 0; k < 5; ++k) {
    target.onset.anchor_outline[k] = {8.0, -0.25 + 0.125 * static_cast<double>(k)};
    target.appearance.outline_in_map[k] = target.onset.anchor_outline[k] + Vec2{0.15, 0.15};
  }
  const Judge judged(rectangle(24.0, 10.0, {}, {{{8.15, -0.1}, {8.15, 0.4}}}));
  CHECK(judged(target) == MotionOnset::kNone);
  target.appearance.beams = {403, 413};  // beam 405 is straight ahead: -0.67 to 2.67 degrees
  CHECK(judged(target) == MotionOnset::kCertain);
}

TEST_CASE("a target that came to free space is known by a shorter walk than one on unknown ground") {
  const Judge judged(with({}));
  Target target = body({3.0, 0.0}, {3.0, 0.09}, 1.0);  // shorter than 0.10 m
  go_left(target, 0.3);
  CHECK(judged(target) == MotionOnset::kCertain);
  target.onset.free_share = 0.0;
  CHECK(judged(target) == MotionOnset::kNone);
}

TEST_CASE("who stood has set out by his newest places alone") {
  const Judge judged(with({}));
  Target target = body({3.0, 0.0}, {3.0, 0.16}, 0.0);  // on ground of which nothing is known
  target.appearance.noise = 2.0;                       // no filter foretold the first step
  go_left(target, 0.4);
  const auto stands_then_walks = [&](double grows_m, void (*change)(Appearance&)) {
    Target changed = target;
    change(changed.appearance);
    place(changed, 0, 19, [&](int k) {  // 4 cm a scan from the seventeenth on; every second scan sees a beam more
      const double steps = std::max(0, k - 15), width_m = 0.5 + 0.06 * (k % 2) + grows_m * steps;
      return Sample{.where_in_map = {3.0, 0.04 * steps}, .width_m = width_m, .spacing_m = 0.06, .whole = true};
    });
    return judged(changed);
  };
  CHECK(stands_then_walks(0.0, [](Appearance&) {}) == MotionOnset::kCertain);
  CHECK(stands_then_walks(0.0, [](Appearance& a) { a.on_wall = true; }) == MotionOnset::kCertain);  // taken for one
  CHECK(stands_then_walks(0.02, [](Appearance&) {}) == MotionOnset::kNone);  // 8 cm wider at the end: half of its way
  CHECK(stands_then_walks(0.0, [](Appearance& a) { a.noise = 3.0; }) == MotionOnset::kNone);
  CHECK(stands_then_walks(0.0, [](Appearance& a) { a.arc_m = 0.1; }) == MotionOnset::kNone);
  CHECK(stands_then_walks(0.0, [](Appearance& a) { a.whole = false; }) == MotionOnset::kNone);
  place(target, 0, 5, [](int k) { return Sample{.where_in_map = {3.0, 0.032 * k}, .whole = true}; });  // never stood
  CHECK(judged(target) == MotionOnset::kLikely);
  target.appearance.noise = 1.0;  // the filter foretold it
  CHECK(judged(target) == MotionOnset::kCertain);
  target.appearance.on_wall = true;  // and of a wall it is none
  CHECK(judged(target) == MotionOnset::kNone);
}

TEST_CASE("who stood and was taken for a wall has set out where he left his place and came where nothing stood") {
  Target target = body({3.0, 0.0}, {3.0, 0.2}, 0.0);
  target.appearance.on_wall = true;
  show_sides(target);
  place(target, 0, 19, [](int k) { return Sample{.where_in_map = {3.0, 0.04 * std::max(0, k - 14)}, .whole = true}; });
  CHECK(Judge(with({}))(target) == MotionOnset::kCertain);  // beams pass over where he stood
  const Room room = with({}, {kHides});
  CHECK(Judge(room, room)(target) == MotionOnset::kCertain);
  CHECK(Judge(room, with({}, {kHides, kStood}))(target) == MotionOnset::kNone);
}

/// Comes from (3.6, 0) to (3, 0), and to and fro aside of that.
void sway(Target& target, double aside_m, double grows_m) {
  place(target, 0, 10, [&](int k) {
    const double y = k % 2 == 0 ? aside_m : -aside_m;
    return Sample{.where_in_map = {3.6 - 0.06 * k, y}, .width_m = grows_m * k, .whole = true};
  });
}

TEST_CASE("who sways has set out where beams passed a moment ago and not where none tells") {
  // Coming towards the laser hides the place behind: 0.6 m in a second, as one leg or the other is seen.
  const Room room = with({{{3.0, 0.0}, 0.1}});
  Target target = walker({3.6, 0.0}, {3.0, 0.0});
  const Judge was_free(room, with({})), untold(room);
  sway(target, 0.14, 0.0);
  CHECK(was_free(target) == MotionOnset::kLikely);
  CHECK(untold(target) == MotionOnset::kNone);
  target.appearance.noise = 3.0;  // a heap that changes its shape
  CHECK(was_free(target) == MotionOnset::kNone);
  target.appearance.noise = 1.0;
  sway(target, 0.14, 0.04);  // 0.4 m wider at the end
  CHECK(was_free(target) == MotionOnset::kNone);
  sway(target, 0.14, 0.0);
  target.onset.free_share = 0.0;  // the map does not agree
  CHECK(was_free(target) == MotionOnset::kNone);
  sway(target, 0.09, 0.0);
  CHECK(was_free(target) == MotionOnset::kLikely);
}

TEST_CASE("what went less than half its own width has not set out by swaying") {
  Target target = walker({3.6, 0.0}, {3.0, 0.0});
  sway(target, 0.09, 0.0);
  const Judge was_free(with({{{3.0, 0.0}, 0.1}}), with({}));
  const auto as_wide_as = [&](double width_m) {
    show(target, {3.0, 0.0}, {0.0, 0.25 * width_m});
    return was_free(target);
  };
  CHECK(as_wide_as(1.0) == MotionOnset::kLikely);
  CHECK(as_wide_as(1.3) == MotionOnset::kNone);
}

TEST_CASE("a piece of wall that slides along itself has not set out, and one broadside on has") {
  // 0.4 m wide pieces; the place that each came from is out of sight behind a post.
  const Room room = rectangle(24.0, 10.0, {{{2.0, 0.0}, 0.3}});
  Target slides = walker({4.0, 0.0}, {6.0, 0.0}), strides = slides;
  show(slides, {6.0, 0.0}, {0.1, 0.0});
  show(strides, {6.0, 0.0}, {0.0, 0.1});
  CHECK_FALSE(sees_it_start(slides, room));
  CHECK(sees_it_start(strides, room));
}

TEST_CASE("a piece at a slant that slides along itself has not set out though beams pass over its old place") {
  // 0.4 m wide, 0.85 m along its own line in a second: other parts of one wall come into view as a robot drives, and
  // behind the gap that it is seen through another wall.
  Target piece = walker({4.0, -0.6}, {4.6, 0.0});
  piece.appearance.whole = false;
  piece.onset.free_share = 0.0;
  show(piece, {4.6, 0.0}, {0.07, 0.07});
  CHECK_FALSE(sees_it_start(piece, with({})));
}
