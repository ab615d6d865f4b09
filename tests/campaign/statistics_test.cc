#include "apps/campaign/statistics.h"

#include <cmath>
#include <limits>

#include "apps/campaign/campaign_folder.h"
#include "tests/support/catch.h"

using namespace jaywalk::campaign;

TEST_CASE("the interval of a share is Wilson's") {
  // 33 of 40, z = 1.96, z^2 = 3.8416: centre (33 + 1.9208) / 43.8416 = 0.79652; half width 1.96 / 43.8416 *
  // sqrt(33 * 7 / 40 + 0.9604) = 0.044706 * sqrt(6.7354) = 0.11602
  const Interval interval = wilson(33, 40);
  CHECK(interval.low == Approx(0.68050).margin(1e-4));
  CHECK(interval.high == Approx(0.91254).margin(1e-4));
}

TEST_CASE("all of few runs is not certainty, and no runs say nothing") {
  CHECK(wilson(2, 2).low == Approx(2.0 / 5.8416).margin(1e-4));  // n / (n + z^2)
  CHECK(wilson(2, 2).high == 1.0);
  CHECK(wilson(0, 2).low == 0.0);
  CHECK(wilson(0, 0).low == 0.0);
  CHECK(wilson(0, 0).high == 1.0);
}

TEST_CASE("medians and quantiles leave out what nobody knows") {
  const double unknown = std::numeric_limits<double>::quiet_NaN();
  CHECK(median({3.0, unknown, 1.0, 2.0}) == 2.0);
  CHECK(median({4.0, 1.0}) == 2.5);
  CHECK(quantile({1.0, 2.0, 3.0, 4.0}, 0.5) == 2.0);
  CHECK(quantile({1.0, 2.0, 3.0, 4.0}, 0.95) == 4.0);
  CHECK(quantile({unknown, 7.0}, 1.0) == 7.0);
  CHECK(mean({1.0, unknown, 3.0}) == 2.0);
  CHECK(std::isnan(median({unknown})));
  CHECK(std::isnan(mean({})));
}

TEST_CASE("numbers are written alike everywhere") {
  CHECK(fixed(1.005, 1) == "1.0");
  CHECK(fixed(-2.0, 0) == "-2");
  CHECK(fixed(std::numeric_limits<double>::quiet_NaN(), 2) == "-");
}

TEST_CASE("digests are those of FNV-1a") {
  CHECK(digest_of_text("") == "cbf29ce484222325");   // the offset
  CHECK(digest_of_text("a") == "af63dc4c8601ec8c");  // published test vector
}
