// Random numbers and angles that are the same everywhere.
#include "planner/cell/draws.h"

#include <algorithm>
#include <cmath>

#include "hal/types/trig.h"
#include "tests/support/catch.h"

using namespace jaywalk;

TEST_CASE("draws are Philox4x32-10: its authors' known answers") {
  cell::Draws zero({0, 0, 0, 0});  // counter 0, key 0: 6627e8d5 e169c58d bc57ac4c 9b00dbd8, read from the end
  CHECK(zero.bits() == 0x9b00dbd8U);
  CHECK(zero.bits() == 0xbc57ac4cU);
  CHECK(zero.bits() == 0xe169c58dU);
  CHECK(zero.bits() == 0x6627e8d5U);
  CHECK(zero.bits() != 0x9b00dbd8U);  // the next block
}

TEST_CASE("what is drawn depends on what it is drawn for alone") {
  cell::Draws a({7, 1, 12, 3}), b({7, 1, 12, 3});
  for (int k = 0; k < 9; ++k) CHECK(a.bits() == b.bits());
  for (const cell::DrawnFor& other : {cell::DrawnFor{8, 1, 12, 3}, {7, 2, 12, 3}, {7, 1, 13, 3}, {7, 1, 12, 4}}) {
    cell::Draws c(other), d({7, 1, 12, 3});
    CHECK(c.bits() != d.bits());
  }
}

TEST_CASE("normal draws have mean 0 and variance 1, waits have the mean of their rate") {
  cell::Draws draws({1, 2, 3, 4});
  double sum = 0.0, squares = 0.0, waits = 0.0;
  constexpr int kCount = 20000;
  for (int k = 0; k < kCount; ++k) {
    const auto x = static_cast<double>(draws.normal());
    sum += x, squares += x * x;
    waits += static_cast<double>(draws.waiting_s(0.5F));
  }
  CHECK(std::fabs(sum / kCount) < 0.03);  // 4 standard errors
  CHECK(squares / kCount == Approx(1.0).margin(0.04));
  CHECK(waits / kCount == Approx(2.0).margin(0.06));
  CHECK(draws.waiting_s(0.0F) > 1e5F);  // never
}

TEST_CASE("single precision angles keep to their stated errors") {
  double worst_heading = 0.0, worst_angle = 0.0;
  for (int k = -4000; k <= 4000; ++k) {
    const float rad = static_cast<float>(k) * 0.0251F;
    const cell::Heading h = cell::heading_at(rad);
    const auto exact = static_cast<double>(rad);
    worst_heading = std::max({worst_heading, std::fabs(static_cast<double>(h.x) - jaywalk::cos(exact)),
                              std::fabs(static_cast<double>(h.y) - jaywalk::sin(exact))});
    const double off = wrap_angle(static_cast<double>(cell::angle_of(3.0F * h.x, 3.0F * h.y)) - exact);
    worst_angle = std::max(worst_angle, std::fabs(off));
    CHECK(std::fabs(wrap_angle(static_cast<double>(cell::wrapped(rad)) - exact)) < 1e-4);
  }
  CHECK(worst_heading < 8e-6);
  CHECK(worst_angle < 3e-5);
  CHECK(cell::angle_of(0.0F, 0.0F) == 0.0F);
}
