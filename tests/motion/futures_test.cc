// Where movers may be: in their futures, in memory, and out of sight.
#include "planner/prediction/futures.h"

#include <bit>
#include <cmath>
#include <cstring>
#include <memory>
#include <vector>

#include "planner/prediction/mover_history.h"
#include "tests/motion/guided.h"
#include "tests/motion/track_past.h"
#include "tests/safety/scans.h"
#include "tests/support/catch.h"

using namespace jaywalk;
using namespace jaywalk::motion;

namespace {

MoverBelief walking(std::uint32_t id, float x, float y, float vx, float vy) {
  return {.id = id,
          .x = x,
          .y = y,
          .vx = vx,
          .vy = vy,
          .position_std = 0.02F,
          .velocity_std = 0.02F,
          .radius_m = 0.27F,
          .usual_mps = 0.5F,
          .is_pedestrian = true};
}

/// A step of Seen with one track.
Track track_at(std::uint32_t id, Vec2 place, Vec2 velocity, Time stamp) {
  Track track = tests::TrackPast().of(place, velocity, stamp);
  track.id = id;
  track.is_pedestrian = norm(velocity) > 0.0;
  return track;
}

/// Futures on open ground, or before a wall at x = 2 m.
struct Drawn {
  explicit Drawn(std::span<const MoverBelief> movers, std::uint32_t draw = 1, bool walled = false) {
    if (walled) ground.wall({2.0, -4.0}, {2.0, 6.0});
    futures.draw(movers, {}, {}, ground.towards({-3.0, -3.0}, {5.0, 5.0}), draw);
  }

  test::Guided ground;
  Futures futures;
};

/// What is remembered of movers by a robot that stands at (0, -3), in the open.
struct Memory {
  void update(Time now, std::span<const Track> tracks, std::span<const StandingPedestrian> standing = {}) {
    const Pose2 robot{0.0, -3.0, 0.0};
    history.update({.now = now,
                    .map_from_robot = robot,
                    .tracks = tracks,
                    .standing = standing,
                    .still = ground.map(),
                    .scans = SeenFrom{&scan, robot},
                    .guide = guide});
  }

  test::Guided ground;
  const Guide& guide = ground.towards({0.0, -3.0}, {5.0, 5.0});
  LaserScan scan = tests::scan_of(
      {.robot_from_laser = {}, .fov_rad = 2.0 * kPi, .beams = 361, .range_min_m = 0.05, .range_max_m = 25.0}, 20.0F);
  MoverHistory history;
};

}  // namespace

TEST_CASE("who walks in the open goes on: after a second most futures are where the velocity leads") {
  const MoverBelief b = walking(1, 0.0F, 1.0F, 0.5F, 0.0F);
  const Drawn drawn({&b, 1});
  const MoverAt& at = drawn.futures.at(5, 0);
  int near = 0;
  for (int k = 0; k < kFutures; ++k) near += std::hypot(at.x[k] - 0.5F, at.y[k] - 1.0F) < 0.15F ? 1 : 0;
  CHECK(near >= 28);  // of 32: a few stop, at 0.03 a second
  CHECK(std::popcount(at.walks) >= 28);
}

TEST_CASE("nobody walks through a wall, in any future") {
  const MoverBelief b = walking(1, 0.0F, 1.0F, 0.8F, 0.0F);
  const Drawn drawn({&b, 1}, 1, true);
  for (int step = 0; step < kFutureSteps; ++step) {
    for (const float x : drawn.futures.at(step, 0).x) CHECK(x < 2.0F);
  }
}

TEST_CASE("two who meet turn away from each other: futures are joint") {
  const MoverBelief both[] = {walking(1, 0.0F, 1.0F, 0.5F, 0.0F), walking(2, 3.0F, 1.0F, -0.5F, 0.0F)};
  const Drawn drawn(both);
  const MoverAt &one = drawn.futures.at(15, 0), &other = drawn.futures.at(15, 1);
  int apart = 0;  // after 3 s both would be at (1.5, 1)
  for (int k = 0; k < kFutures; ++k) apart += std::hypot(one.x[k] - other.x[k], one.y[k] - other.y[k]) > 0.5F ? 1 : 0;
  CHECK(apart >= 28);
}

TEST_CASE("who stands sets out in some futures, somewhere") {
  MoverBelief b = walking(1, 0.0F, 1.0F, 0.0F, 0.0F);
  b.velocity_std = 0.01F;
  b.stood_s = 20.0F;
  const Drawn drawn({&b, 1});
  const Futures& futures = drawn.futures;
  CHECK(futures.at(0, 0).walks == 0U);
  const int late = std::popcount(futures.at(kFutureSteps - 1, 0).walks);
  CHECK(late > 10);  // 1 - e^-1 of 32: 20
  CHECK(late < 30);
  CHECK(futures.at(kFutureSteps - 1, 0).spread > 1.0F);
}

TEST_CASE("futures depend on who and when, not on the others' number: the same bits") {
  const MoverBelief both[] = {walking(1, 0.0F, 1.0F, 0.5F, 0.0F), walking(2, -3.0F, -2.0F, -0.5F, 0.0F)};
  const Drawn one({both, 1}, 9), two(both, 9), later(both, 10);  // too far off to meet
  const auto same = [&one](const Drawn& other) {
    return std::memcmp(one.futures.at(10, 0).x, other.futures.at(10, 0).x, sizeof(MoverAt::x)) == 0;
  };
  CHECK(same(two));
  CHECK_FALSE(same(later));
}

TEST_CASE("one scan that drops a walker's velocity to nothing is not believed") {
  Memory memory;
  for (int k = 0; k < 12; ++k) {
    const Time now = time_from_seconds(0.1 * k);
    const Track t = track_at(3, {0.05 * k, 2.0}, {k == 11 ? 0.02 : 0.5, 0.0}, now);
    memory.update(now, {&t, 1});
  }
  REQUIRE(memory.history.beliefs().size() == 1);
  CHECK(memory.history.beliefs()[0].vx == Approx(0.5F));
  CHECK(memory.history.masked().size() == 1);
}

TEST_CASE("a pedestrian that has stood for more than four seconds stands, known by a track or by two legs alone") {
  const Time now = time_from_seconds(10.0);
  const auto standing_after = [now](double stood_s, bool is_track) {
    Memory memory;
    const Time since = now - duration_from_seconds(stood_s);
    Track track = track_at(3, {1.0, 2.0}, {}, now);
    track.still_since = since, track.is_pedestrian = true;
    const StandingPedestrian legs{{1.0, 2.0}, 0.25, now, since};
    memory.update(now, {&track, is_track ? 1U : 0U}, {&legs, is_track ? 0U : 1U});
    REQUIRE(memory.history.beliefs().size() == 1);
    return std::vector<StandingPedestrian>(memory.history.standing().begin(), memory.history.standing().end());
  };
  for (const bool is_track : {true, false}) {
    CHECK(standing_after(3.5, is_track).empty());
    const std::vector<StandingPedestrian> standing = standing_after(4.5, is_track);
    REQUIRE(standing.size() == 1);
    CHECK(distance(standing[0].position_in_map, {1.0, 2.0}) < 0.01);
    CHECK(standing[0].radius_m == Approx(is_track ? 0.27 : 0.25));
  }
}

TEST_CASE("a walker out of sight lives on, until his places are seen to be empty") {
  Memory memory;
  memory.scan.range_m.fill(1.0F);  // nothing farther off is seen
  for (int k = 0; k < 20; ++k) {
    const Track t = track_at(3, {0.05 * k, 2.0}, {0.5, 0.0}, time_from_seconds(0.1 * k));
    memory.update(t.stamp, {&t, 1});
  }
  CHECK(memory.history.hidden().empty());
  memory.update(time_from_seconds(2.0), {});
  CHECK(memory.history.hidden().size() == 1);
  memory.update(time_from_seconds(3.0), {});
  CHECK(memory.history.hidden().size() == 1);
  memory.scan.range_m.fill(20.0F);  // now everything is, and nobody is there
  memory.update(time_from_seconds(3.1), {});
  memory.update(time_from_seconds(3.2), {});
  CHECK(memory.history.hidden().empty());
}

namespace {

/// What is remembered after five posts stood there for five seconds, the last of which walks off if it `leaves`.
TurningModel among_posts(bool leaves) {
  Memory memory;
  for (int k = 0; k <= 50; ++k) {
    const Time now = time_from_seconds(0.1 * k);
    std::vector<Track> posts;
    for (std::uint32_t id = 1; id <= 5; ++id) posts.push_back(track_at(id, {0.8 * id - 2.0, -1.0}, {}, now));
    if (leaves && k > 20) posts.back() = track_at(5, {2.0, -1.0 + 0.05 * (k - 20)}, {0.0, 0.5}, now);
    memory.update(now, posts);
  }
  return memory.history.turning();
}

}  // namespace

TEST_CASE("what is new and stands walks off as often as those before it did: a fifth at first, worth five of them") {
  const TurningModel at_first;
  CHECK(at_first.walks_off_hz() == Approx(0.05F));  // 1 of 5 in 4 s
  const TurningModel posts = among_posts(false), one_left = among_posts(true);
  CHECK(posts.newcomers == 5.0F);
  CHECK(posts.walks_off_hz() == Approx(0.025F));  // 1 of 10
  CHECK(one_left.newcomers == 5.0F);
  CHECK(one_left.walks_off_hz() == Approx(0.05F));  // 2 of 10
}
