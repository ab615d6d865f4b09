#include "hal/sim/social_walkers.h"
#include "tests/support/catch.h"

using namespace jaywalk;
using namespace jaywalk::sim::social;

// Worked by hand from Helbing and Molnar 1995, V0 = 2.1 m2/s2, sigma = 0.3 m, U0 = 10 m2/s2, R = 0.2 m, tau = 0.5 s.

TEST_CASE("a pedestrian at rest pushes another 0.5 m away by 7 exp(-5/3) = 1.3221 m/s2") {
  CHECK(distance(away_from_walker({0.3, 0.4}, {}), Vec2{0.6, 0.8} * 1.322129) < 1e-6);
}

TEST_CASE("beside the middle of a pedestrian's next 2 s the force is straight sideways, 7 exp(-2) at 0.6 m") {
  // At 1 m/s the foci lie at x = 0 and 2; from (1, y) both are sqrt(1 + y2) away: b = y, its gradient (0, 1).
  const Vec2 force = away_from_walker({1.0, 0.6}, {1.0, 0.0});
  CHECK(force.x == Approx(0.0).margin(1e-12));
  CHECK(force.y == Approx(0.947347).epsilon(1e-6));
}

TEST_CASE("3 m ahead of a pedestrian at 1 m/s the force is 7 exp(-sqrt(3)/0.3) 2/sqrt(3)") {
  // Distances 3 m and 1 m, step 2 m: b = sqrt(16 - 4) / 2 = sqrt(3); gradient 2 x 4 / (4 sqrt(3)) = 1.154701.
  const Vec2 force = away_from_walker({3.0, 0.0}, {1.0, 0.0});
  CHECK(force.x == Approx(7.0 * 0.003108870 * 1.154701).epsilon(1e-5));
  CHECK(force.y == 0.0);
}

TEST_CASE("a wall 0.4 m away pushes by 50 exp(-2) m/s2, and a wish of 1.3 m/s against 0.3 draws by 2 m/s2") {
  CHECK(away_from_wall({0.0, -0.4}).y == Approx(-6.766764).epsilon(1e-6));
  CHECK(towards({1.3, 0.0}, {0.3, 0.0}) == Vec2{2.0, 0.0});
}

TEST_CASE("a force from within 100 degrees of the way is felt whole, from behind by half") {
  CHECK(as_seen({-1.0, 0.0}, {1.0, 0.0}) == Vec2{-1.0, 0.0});
  CHECK(as_seen({1.0, 0.0}, {1.0, 0.0}) == Vec2{0.5, 0.0});
  CHECK(in_sight({1.0, 0.0}, direction(99.0 / 180.0 * kPi)));
  CHECK_FALSE(in_sight({1.0, 0.0}, direction(-101.0 / 180.0 * kPi)));
}

TEST_CASE("lengths are between outlines, a centimetre at least") {
  CHECK(between_outlines({0.0, 2.0}, 0.5) == Vec2{0.0, 1.5});
  CHECK(norm(between_outlines({0.0, 0.4}, 0.5)) == Approx(0.01));
  CHECK(norm(between_outlines({}, 0.5)) == Approx(0.01));
}
