#include "hal/types/trig.h"

#include <cmath>
#include <limits>

#include "tests/support/catch.h"

using namespace jaywalk;

TEST_CASE("sine and cosine agree with libm to 1e-14 up to ten thousand radians") {
  for (int k = -200000; k <= 200000; k += 37) {
    const double a = k * 0.05;
    REQUIRE(std::fabs(jaywalk::sin(a) - std::sin(a)) < 1e-14);
    REQUIRE(std::fabs(jaywalk::cos(a) - std::cos(a)) < 1e-14);
  }
}

TEST_CASE("atan2 agrees with libm in every quadrant and at every edge") {
  for (int k = 0; k < 6300; ++k) {
    const double a = (k - 3150) * 0.001 * (kPi / 3.15);
    const double x = 3.0 * std::cos(a), y = 3.0 * std::sin(a);
    REQUIRE(std::fabs(jaywalk::atan2(y, x) - std::atan2(y, x)) < 1e-14);
  }
  CHECK(jaywalk::atan2(0.0, 0.0) == 0.0);
  CHECK(jaywalk::atan2(0.0, -1.0) == Approx(kPi));
  CHECK(jaywalk::atan2(-1.0, 0.0) == Approx(-kPi / 2));
  CHECK(jaywalk::atan2(1e-300, 1.0) == Approx(1e-300));
}

TEST_CASE("exp and log agree with libm to 1e-14 and undo each other") {
  for (double x = -690.0; x < 690.0; x += 0.73) {
    REQUIRE(jaywalk::exp(x) == Approx(std::exp(x)).epsilon(1e-14));
    REQUIRE(std::fabs(jaywalk::log(jaywalk::exp(x)) - x) < 2e-13);
  }
  for (double x = 1e-12; x < 1e12; x *= 1.37) {
    REQUIRE(std::fabs(jaywalk::log(x) - std::log(x)) < 1e-14);
  }
  CHECK(jaywalk::exp(0.0) == 1.0);
  CHECK(jaywalk::log(1.0) == 0.0);
  CHECK(jaywalk::log(0.0) == -std::numeric_limits<double>::infinity());
  CHECK(std::isnan(jaywalk::log(-1.0)));
}

TEST_CASE("wrapped angles lie above -pi and up to pi") {
  CHECK(wrap_angle(kPi) == kPi);
  CHECK(wrap_angle(-kPi) == kPi);
  CHECK(wrap_angle(3.0 * kPi / 2) == Approx(-kPi / 2));
  CHECK(wrap_angle(-7.0) == Approx(-7.0 + 2 * kPi));
  CHECK(wrap_angle(0.25) == 0.25);
}
