// Where movers may be: in their futures, in memory, and out of sight.
#include "planner/prediction/futures.h"

#include <bit>
#include <cmath>
#include <cstring>
#include <memory>
#include <vector>

#include "planner/prediction/mover_history.h"
#include "tests/motion/guided.h"
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
  return {.id = id,
          .stamp = stamp,
          .position_in_map = place,
          .velocity_in_map = velocity,
          .covariance = {1e-4, 1e-5, 1e-3},
          .radius_m = 0.27,
          .moving = norm(velocity) > 0.15,
          .is_pedestrian = norm(velocity) > 0.0,
          .still_since = stamp,
          .hits = 20,
          .last_seen = stamp};
}

LaserScan open_scan() {
  LaserScan scan;
  scan.beam_count = 361;
  scan.first_angle_rad = -3.14159F;
  scan.angle_step_rad = 0.0174533F;
  scan.range_min_m = 0.05F, scan.range_max_m = 25.0F;
  scan.range_m.fill(20.0F);
  return scan;
}

}  // namespace

TEST_CASE("who walks in the open goes on: after a second most futures are where the velocity leads") {
  test::Guided g;
  (void)g.towards({-3.0, -3.0}, {5.0, 5.0});
  Futures futures;
  const MoverBelief b = walking(1, 0.0F, 1.0F, 0.5F, 0.0F);
  futures.draw({&b, 1}, {}, {}, g.guide(), 1);
  const MoverAt& at = futures.at(5, 0);
  int near = 0;
  for (int k = 0; k < kFutures; ++k) near += std::hypot(at.x[k] - 0.5F, at.y[k] - 1.0F) < 0.15F ? 1 : 0;
  CHECK(near >= 28);  // of 32: a few stop, at 0.03 a second
  CHECK(std::popcount(at.walks) >= 28);
}

TEST_CASE("nobody walks through a wall, in any future") {
  test::Guided g;
  g.wall({2.0, -4.0}, {2.0, 6.0});
  (void)g.towards({-3.0, -3.0}, {1.0, 5.0});
  Futures futures;
  const MoverBelief b = walking(1, 0.0F, 1.0F, 0.8F, 0.0F);
  futures.draw({&b, 1}, {}, {}, g.guide(), 1);
  for (int step = 0; step < kFutureSteps; ++step) {
    for (const float x : futures.at(step, 0).x) CHECK(x < 2.0F);
  }
}

TEST_CASE("two who meet turn away from each other: futures are joint") {
  test::Guided g;
  (void)g.towards({-3.0, -3.0}, {5.0, 5.0});
  Futures futures;
  const MoverBelief both[] = {walking(1, 0.0F, 1.0F, 0.5F, 0.0F), walking(2, 3.0F, 1.0F, -0.5F, 0.0F)};
  futures.draw(both, {}, {}, g.guide(), 1);
  int apart = 0;
  for (int k = 0; k < kFutures; ++k) {  // after 3 s both would be at (1.5, 1)
    const float dx = futures.at(15, 0).x[k] - futures.at(15, 1).x[k];
    apart += std::hypot(dx, futures.at(15, 0).y[k] - futures.at(15, 1).y[k]) > 0.5F ? 1 : 0;
  }
  CHECK(apart >= 28);
}

TEST_CASE("who stands sets out in some futures, somewhere") {
  test::Guided g;
  (void)g.towards({-3.0, -3.0}, {5.0, 5.0});
  Futures futures;
  MoverBelief b = walking(1, 0.0F, 1.0F, 0.0F, 0.0F);
  b.velocity_std = 0.01F;
  b.stood_s = 20.0F;
  futures.draw({&b, 1}, {}, {}, g.guide(), 1);
  CHECK(futures.at(0, 0).walks == 0U);
  const int late = std::popcount(futures.at(kFutureSteps - 1, 0).walks);
  CHECK(late > 10);  // 1 - e^-1 of 32: 20
  CHECK(late < 30);
  CHECK(futures.at(kFutureSteps - 1, 0).spread > 1.0F);
}

TEST_CASE("futures depend on who and when, not on the others' number: the same bits") {
  test::Guided g;
  (void)g.towards({-3.0, -3.0}, {5.0, 5.0});
  Futures one, two;
  const MoverBelief both[] = {walking(1, 0.0F, 1.0F, 0.5F, 0.0F), walking(2, -3.0F, -2.0F, -0.5F, 0.0F)};
  one.draw({both, 1}, {}, {}, g.guide(), 9);
  two.draw(both, {}, {}, g.guide(), 9);  // too far off to meet
  CHECK(std::memcmp(one.at(10, 0).x, two.at(10, 0).x, sizeof one.at(10, 0).x) == 0);
  two.draw(both, {}, {}, g.guide(), 10);
  CHECK(std::memcmp(one.at(10, 0).x, two.at(10, 0).x, sizeof one.at(10, 0).x) != 0);
}

TEST_CASE("one scan that drops a walker's velocity to nothing is not believed") {
  test::Guided g;
  (void)g.towards({0.0, -3.0}, {5.0, 5.0});
  MoverHistory memory;
  const LaserScan scan = open_scan();
  for (int k = 0; k < 12; ++k) {
    const Time now = time_from_seconds(0.1 * k);
    const Track t = track_at(3, {0.05 * k, 2.0}, {k == 11 ? 0.02 : 0.5, 0.0}, now);
    memory.update({.now = now,
                   .stamp = now,
                   .map_from_robot = {0.0, -3.0, 0.0},
                   .tracks = {&t, 1},
                   .standing = {},
                   .still = g.map(),
                   .scans = SeenFrom{&scan, {0.0, -3.0, 0.0}},
                   .guide = g.guide()});
  }
  REQUIRE(memory.beliefs().size() == 1);
  CHECK(memory.beliefs()[0].vx == Approx(0.5F));
  CHECK(memory.masked().size() == 1);
}

TEST_CASE("a pedestrian that has stood for more than four seconds stands, known by a track or by two legs alone") {
  test::Guided g;
  (void)g.towards({0.0, -3.0}, {5.0, 5.0});
  const LaserScan scan = open_scan();
  const Time now = time_from_seconds(10.0);
  const auto standing_after = [&](double stood_s, bool is_track) {
    MoverHistory memory;
    const Time since = now - duration_from_seconds(stood_s);
    Track track = track_at(3, {1.0, 2.0}, {}, now);
    track.still_since = since, track.is_pedestrian = true;
    const StandingPedestrian legs{{1.0, 2.0}, 0.25, now, since};
    memory.update({.now = now,
                   .stamp = now,
                   .map_from_robot = {0.0, -3.0, 0.0},
                   .tracks = {&track, is_track ? 1U : 0U},
                   .standing = {&legs, is_track ? 0U : 1U},
                   .still = g.map(),
                   .scans = SeenFrom{&scan, {0.0, -3.0, 0.0}},
                   .guide = g.guide()});
    REQUIRE(memory.beliefs().size() == 1);
    return std::vector<StandingPedestrian>(memory.standing().begin(), memory.standing().end());
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
  test::Guided g;
  (void)g.towards({0.0, -3.0}, {5.0, 5.0});
  MoverHistory memory;
  LaserScan scan = open_scan();
  const auto update = [&](double t, std::span<const Track> tracks) {
    const Time now = time_from_seconds(t);
    memory.update({.now = now,
                   .stamp = now,
                   .map_from_robot = {0.0, -3.0, 0.0},
                   .tracks = tracks,
                   .standing = {},
                   .still = g.map(),
                   .scans = SeenFrom{&scan, {0.0, -3.0, 0.0}},
                   .guide = g.guide()});
  };
  scan.range_m.fill(1.0F);  // nothing farther off is seen
  for (int k = 0; k < 20; ++k) {
    const Track t = track_at(3, {0.05 * k, 2.0}, {0.5, 0.0}, time_from_seconds(0.1 * k));
    update(0.1 * k, {&t, 1});
  }
  CHECK(memory.hidden().empty());
  update(2.0, {});
  CHECK(memory.hidden().size() == kFutures);
  update(3.0, {});
  CHECK(memory.hidden().size() == kFutures);
  scan.range_m.fill(20.0F);  // now everything is, and nobody is there
  update(3.1, {});
  update(3.2, {});
  CHECK(memory.hidden().empty());
}

namespace {

/// What is remembered after five posts stood there for five seconds, the last of which walks off if it `leaves`.
MoverHistory among_posts(bool leaves) {
  test::Guided g;
  (void)g.towards({0.0, -3.0}, {5.0, 5.0});
  MoverHistory memory;
  const LaserScan scan = open_scan();
  for (int k = 0; k <= 50; ++k) {
    const Time now = time_from_seconds(0.1 * k);
    std::vector<Track> posts;
    for (std::uint32_t id = 1; id <= 5; ++id) posts.push_back(track_at(id, {0.8 * id - 2.0, -1.0}, {}, now));
    if (leaves && k > 20) posts.back() = track_at(5, {2.0, -1.0 + 0.05 * (k - 20)}, {0.0, 0.5}, now);
    memory.update({.now = now,
                   .stamp = now,
                   .map_from_robot = {0.0, -3.0, 0.0},
                   .tracks = posts,
                   .standing = {},
                   .still = g.map(),
                   .scans = SeenFrom{&scan, {0.0, -3.0, 0.0}},
                   .guide = g.guide()});
  }
  return memory;
}

}  // namespace

TEST_CASE("what is new and stands walks off as often as those before it did: a fifth at first, worth five of them") {
  const TurningModel at_first;
  CHECK(at_first.walks_off_hz() == Approx(0.05F));  // 1 of 5 in 4 s
  const auto posts = std::make_unique<MoverHistory>(among_posts(false));
  CHECK(posts->turning().newcomers == 5.0F);
  CHECK(posts->turning().walks_off_hz() == Approx(0.025F));  // 1 of 10
  const auto one_left = std::make_unique<MoverHistory>(among_posts(true));
  CHECK(one_left->turning().newcomers == 5.0F);
  CHECK(one_left->turning().walks_off_hz() == Approx(0.05F));  // 2 of 10
}
