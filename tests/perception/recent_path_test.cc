#include "planner/perception/recent_path.h"

#include "tests/support/catch.h"

using namespace jaywalk;

TEST_CASE("a straight walk explains its places fully") {
  RecentPath path;
  for (int k = 0; k < 10; ++k) path.add(time_from_seconds(0.1 * k), {0.04 * k, 0.03 * k});
  const StraightWalk walk = path.fit();
  CHECK(walk.places == 10);
  CHECK(walk.duration_s == Approx(0.9));
  CHECK(walk.length_m == Approx(0.45));  // 9 steps of 5 cm
  CHECK(walk.explained == Approx(1.0));
}

TEST_CASE("of one hop in the middle a straight walk explains three quarters") {
  RecentPath path;
  for (int k = 0; k < 10; ++k) path.add(time_from_seconds(0.1 * k), {k < 5 ? 0.0 : 0.4, 0.0});
  // x = -0.2 five times then +0.2; t = -4.5 .. 4.5. Sum t x = 2 x 0.2 x (0.5 + 1.5 + 2.5 + 3.5 + 4.5) = 5.0;
  // sum t^2 = 82.5; sum x^2 = 0.4; explained = 5.0^2 / (82.5 x 0.4) = 0.7576.
  CHECK(path.fit().explained == Approx(0.7576).margin(1e-4));
}

TEST_CASE("only the last ten places count") {
  RecentPath path;
  for (int k = 0; k < 5; ++k) path.add(time_from_seconds(0.1 * k), {5.0 * (k % 2), 0.0});
  for (int k = 5; k < 15; ++k) path.add(time_from_seconds(0.1 * k), {0.1 * k, 0.0});
  CHECK(path.fit().explained == Approx(1.0));
  CHECK(path.fit().length_m == Approx(0.9));
}

TEST_CASE("standing exactly still is no walk") {
  RecentPath path;
  for (int k = 0; k < 10; ++k) path.add(time_from_seconds(0.1 * k), {1.0, 1.0});
  CHECK(path.fit().explained == 0.0);
  CHECK(path.fit().length_m == 0.0);
}
