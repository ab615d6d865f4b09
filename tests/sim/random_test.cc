#include "hal/sim/random.h"

#include "tests/support/catch.h"

using jaywalk::sim::Purpose;
using jaywalk::sim::Random;

TEST_CASE("uniform numbers fill their interval evenly: mean 1/2, variance 1/12") {
  Random random(3, Purpose::kRange);
  double sum = 0.0, squares = 0.0;
  constexpr int kCount = 100000;
  for (int k = 0; k < kCount; ++k) {
    const double u = random.uniform();
    REQUIRE((u >= 0.0 && u < 1.0));
    sum += u;
    squares += (u - 0.5) * (u - 0.5);
  }
  CHECK(sum / kCount == Approx(0.5).margin(0.003));  // three times sqrt(1/12 / 100000) = 0.0009
  CHECK(squares / kCount == Approx(1.0 / 12.0).margin(0.001));
}

TEST_CASE("normal numbers have mean 0, variance 1, and 4.55 percent lie beyond two") {
  Random random(3, Purpose::kRange);
  double sum = 0.0, squares = 0.0;
  int beyond = 0;
  constexpr int kCount = 100000;
  for (int k = 0; k < kCount; ++k) {
    const double n = random.normal();
    sum += n;
    squares += n * n;
    beyond += n > 2.0 || n < -2.0;
  }
  CHECK(sum / kCount == Approx(0.0).margin(0.01));       // three times 1 / sqrt(100000) = 0.003
  CHECK(squares / kCount == Approx(1.0).margin(0.014));  // three times sqrt(2 / 100000) = 0.0045
  CHECK(beyond / 1e5 == Approx(0.0455).margin(0.002));   // three times sqrt(0.0455 / 100000) = 0.0007
}

TEST_CASE("seed, purpose and index each give another stream, the same three give the same") {
  Random a(1, Purpose::kRange), same(1, Purpose::kRange), seed(2, Purpose::kRange), purpose(1, Purpose::kSlip),
      index(1, Purpose::kRange, 1);
  const double first = a.uniform();
  CHECK(first == same.uniform());
  CHECK(first != seed.uniform());
  CHECK(first != purpose.uniform());
  CHECK(first != index.uniform());
}
