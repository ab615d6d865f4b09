#include <memory>

#include "hal/types/geometry.h"
#include "hal/types/robot_model.h"
#include "tests/support/catch.h"

using namespace jaywalk;

namespace {

constexpr double kDeg = kPi / 180.0;

/// 1 m all round, a beam a degree; from -180 degrees on, or the other way round from 180.
std::unique_ptr<LaserScan> all_round(float step_sign = 1.0F) {
  auto scan = std::make_unique<LaserScan>();
  scan->beam_count = 360;
  scan->first_angle_rad = step_sign * static_cast<float>(-kPi);
  scan->angle_step_rad = step_sign * static_cast<float>(kDeg);
  scan->range_max_m = 10.0F;
  scan->range_m.fill(1.0F);
  return scan;
}

Blanking sector(double from_deg, double to_deg) {
  Blanking sectors;
  (void)sectors.push_back({from_deg * kDeg, to_deg * kDeg});
  return sectors;
}

}  // namespace

TEST_CASE("a sector runs counter-clockwise, behind the laser too") {
  CHECK(BlankedSector{-0.2, 0.3}.width_rad() == Approx(0.5));
  const BlankedSector behind{kPi - 0.1, -kPi + 0.2};
  CHECK(behind.width_rad() == Approx(0.3));
  CHECK(behind.off_rad(kPi - 0.05) == 0.0);
  CHECK(behind.off_rad(-kPi + 0.15) == 0.0);
  CHECK(behind.off_rad(-kPi + 0.5) == Approx(0.3));
  CHECK(behind.off_rad(kPi - 0.5) == Approx(0.4));
  CHECK(BlankedSector{0.3, -0.2}.off_rad(1.0) == 0.0);  // the long way round
}

TEST_CASE("beams into a sector, its rim included, are too near to be measured, whichever way the laser turns") {
  const auto [from_deg, to_deg] = GENERATE(table<double, double>({{10.0, 20.0}, {175.0, -175.0}}));
  for (const float sign : {1.0F, -1.0F}) {
    const auto scan = all_round(sign);
    blank(sector(from_deg, to_deg), *scan);
    std::size_t own = 0;
    for (std::size_t k = 0; k < scan->beam_count; ++k) {
      CHECK(scan->is_hit(k) != scan->too_near(k));
      own += scan->too_near(k) ? 1U : 0U;
    }
    CHECK(own == 11);
    CHECK_FALSE(scan->found_nothing(sign > 0.0F ? 195 : 165));
  }
}

TEST_CASE("no sector blanks nothing, and counts beyond what a scan holds do no harm") {
  const auto scan = all_round();
  blank({}, *scan);
  scan->beam_count = 5000;
  blank(sector(0.0, 5.0), *scan);
  for (std::size_t k = 0; k < 180; ++k) CHECK(scan->is_hit(k));
}
