#include "planner/tracking/occlusion.h"

#include <algorithm>
#include <memory>

#include "tests/perception/watch.h"
#include "tests/support/allocation_guard.h"
#include "tests/support/catch.h"

using namespace jaywalk;
using namespace jaywalk::test;

namespace {

Time at_s(double t_s) { return time_from_seconds(t_s); }

/// Seen from `born_s` to `last_s`, when it was at (x, 0) and walked on at 0.5 m/s along y.
Target walker(std::uint32_t id, double x, double born_s, double last_s) {
  Target target = born_at({x, 0.0}, 0.01, 0.3, at_s(born_s), id);
  target.estimate.track.velocity_in_map = {0.0, 0.5};
  target.estimate.track.last_seen = at_s(last_s);
  target.estimate.track.hits = 30;
  target.estimate.track.moving = true;
  target.estimate.as_seen = target.estimate.track;
  target.appearance.arc_m = 0.26;
  return target;
}

Target newcomer(Vec2 place, double t_s) { return born_at(place, 0.05, 0.25, at_s(t_s), 99); }

/// A hall with a panel that hides, from the origin, what is 2.5 m ahead between y = 0 and y = 2.5 m.
struct Hall : Watch {
  std::uint64_t allocations = 0;

  Hall() {
    for (int k = 0; k < 30; ++k) see({});
  }
  void see(std::vector<Disc> discs) {
    Room room = with({}, {{{1.5, 0.0}, {1.5, 1.5}}});
    room.discs = std::move(discs);
    const LaserScan seen = scan_of(room, {}, ++scan, kNoiseM);
    const AllocationGuard guard;
    tracker.update(seen, {});
    allocations += guard.calls();
  }
  /// Walks up to the panel and behind it, at 0.6 m/s, until `y`; gives his name.
  std::uint32_t walk_in(double y) {
    std::uint32_t id = 0;
    for (double at = -3.0; at < y; at += 0.04) {
      see({{{2.5, at}, 0.25}});
      if (!tracker.moving().empty()) id = tracker.moving()[0].id;
    }
    return id;
  }
  [[nodiscard]] bool claims(std::uint32_t id) const { return std::ranges::count(tracker.tracks(), id, &Track::id) > 0; }
};

}  // namespace

TEST_CASE("who comes out where and when he should is the one who was hidden and moves") {
  const auto hidden = std::make_unique<OccludedTracks>();
  Target trolley = walker(7, 2.0, 0.0, 3.0);
  trolley.appearance.arc_m = 0.7;
  hidden->remember(trolley);
  Target target = newcomer({2.1, 2.1}, 7.0);  // 4 s at 0.5 m/s: expected at (2, 2)
  REQUIRE(hidden->reidentify(target, at_s(7.0)));
  CHECK(target.estimate.track.id == 7);
  CHECK(target.estimate.track.moving);
  CHECK(target.confirmed());
  CHECK(target.estimate.track.velocity_in_map == Vec2{0.0, 0.5});
  CHECK(target.estimate.track.position_in_map == Vec2{2.1, 2.1});
  CHECK(target.estimate.track.radius_m == 0.3);
  CHECK(target.appearance.arc_m == 0.7);
  CHECK(target.existence.born == at_s(0.0));
  CHECK(hidden->size() == 0);
}

TEST_CASE("of two hidden walkers the nearer to where it should be returns") {
  const auto hidden = std::make_unique<OccludedTracks>();
  hidden->remember(walker(7, 2.0, 0.0, 3.0));
  hidden->remember(walker(8, 2.5, 0.0, 3.0));
  Target target = newcomer({2.3, 2.0}, 7.0);
  REQUIRE(hidden->reidentify(target, at_s(7.0)));
  CHECK(target.estimate.track.id == 8);
  CHECK(hidden->size() == 1);
}

TEST_CASE("who comes out elsewhere is another track") {
  const auto hidden = std::make_unique<OccludedTracks>();
  hidden->remember(walker(7, 2.0, 0.0, 3.0));
  Target target = newcomer({2.0, 0.0}, 7.0);  // where he was last seen, 2 m from where he should be
  CHECK_FALSE(hidden->reidentify(target, at_s(7.0)));
  CHECK(target.estimate.track.id == 99);
  CHECK_FALSE(target.estimate.track.moving);
  CHECK(hidden->size() == 1);
  Target beside = newcomer({2.65, 2.0}, 7.0), near = newcomer({2.55, 2.0}, 7.0);  // 0.6 m is the bound
  CHECK_FALSE(hidden->reidentify(beside, at_s(7.0)));
  CHECK(hidden->reidentify(near, at_s(7.0)));
}

TEST_CASE("who was seen for less than half a second is not remembered") {
  const auto hidden = std::make_unique<OccludedTracks>();
  hidden->remember(walker(7, 2.0, 2.6, 3.0));
  CHECK(hidden->size() == 0);
}

TEST_CASE("the hidden are forgotten after eight seconds or when beams pass over where they should be") {
  const auto hidden = std::make_unique<OccludedTracks>();
  const LaserScan blind, clear = scan_of(rectangle(12.0, 10.0), {}, 1);
  const LineOfSight unseen(blind, {}, {}, {}), through(clear, {}, {}, {});
  hidden->remember(walker(7, 2.0, 0.0, 3.0));
  hidden->update(unseen, at_s(10.9), 0.1);
  CHECK(hidden->size() == 1);
  hidden->update(unseen, at_s(11.1), 0.1);
  CHECK(hidden->size() == 0);

  hidden->remember(walker(7, 2.0, 0.0, 3.0));
  for (int k = 1; k <= 2; ++k) hidden->update(through, at_s(3.0 + 0.14 * k), 0.14);
  CHECK(hidden->size() == 1);  // 0.28 s
  hidden->update(through, at_s(3.42), 0.14);
  CHECK(hidden->size() == 0);
}

TEST_CASE("when more are hidden than fit who went first is forgotten") {
  const auto hidden = std::make_unique<OccludedTracks>();
  for (std::uint32_t k = 0; k <= kMaxOccludedTracks; ++k) hidden->remember(walker(k + 1, 2.0 * k, 0.0, 3.0 + 0.01 * k));
  CHECK(hidden->size() == kMaxOccludedTracks);
  Target first = newcomer({0.0, 0.5}, 4.0), second = newcomer({2.0, 0.5}, 4.0);
  CHECK_FALSE(hidden->reidentify(first, at_s(4.0)));
  CHECK(hidden->reidentify(second, at_s(4.0)));
}

TEST_CASE("who walks on behind a panel for four seconds has his name and moves at the first sight of him") {
  Hall hall;
  const std::uint32_t id = hall.walk_in(2.0);
  REQUIRE(id != 0);
  CHECK_FALSE(hall.claims(id));  // nothing is said of where he is
  bool seen = false;
  for (int k = 0; k < 45 && !seen; ++k) {
    hall.see({{{2.5, 2.0 + 0.04 * k}, 0.25}});
    seen = hall.claims(id);
  }
  REQUIRE(seen);
  CHECK(only_mover(hall.tracker).id == id);
  CHECK(hall.allocations == 0);
}

TEST_CASE("what stands where a hidden walker should come out does not move for long") {
  Hall hall;
  REQUIRE(hall.walk_in(2.0) != 0);
  for (int k = 0; k < 7; ++k) hall.see({});  // he should be at y = 2.3 m now, still hidden
  const Disc post{{2.5, 2.55}, 0.25};
  int moving = 0;
  for (int k = 0; k < 90; ++k) {
    hall.see({post});
    moving += hall.tracker.moving().empty() ? 0 : 1;
  }
  CHECK(moving > 0);    // taken for the walker
  CHECK(moving <= 72);  // the 4.3 s of any walker that stops, and half a second until its speed is slow
  CHECK(hall.tracker.moving().empty());
}
