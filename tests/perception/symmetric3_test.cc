#include "planner/localization/symmetric3.h"

#include "tests/support/catch.h"

using namespace jaywalk;

TEST_CASE("the inverse of a symmetric matrix undoes it") {
  const Symmetric3 m{4.0, 1.0, 0.5, 3.0, -0.2, 2.0};
  const Row3 v{1.0, -2.0, 3.0};
  const Row3 back = inverse(m) * (m * v);
  CHECK(back.x == Approx(1.0));
  CHECK(back.y == Approx(-2.0));
  CHECK(back.heading == Approx(3.0));
}

TEST_CASE("an outer product adds information along its row only") {
  Symmetric3 m = diagonal(1.0, 1.0, 1.0);
  m.add_outer({2.0, 0.0, 1.0}, 3.0);
  // xx = 1 + 3 x 4, xh = 3 x 2, hh = 1 + 3; yy untouched.
  CHECK(m.xx == 13.0);
  CHECK(m.xh == 6.0);
  CHECK(m.hh == 4.0);
  CHECK(m.yy == 1.0);
  CHECK(m.quadratic({0.0, 5.0, 0.0}) == 25.0);
}
