#include "bench/tracking/relative_pose.h"

#include <cmath>

#include "tests/support/catch.h"

using namespace jaywalk;
using namespace jaywalk::bench;

namespace {

/// `metres` along +x in steps of 0.1 m; the estimate is `scale` times as far, in a frame of its own.
std::vector<PosePair> straight(int metres, double scale, double turn_rad_per_m) {
  std::vector<PosePair> drive;
  const Pose2 elsewhere{3.0, -2.0, 1.0};
  for (int k = 0; k <= 10 * metres; ++k) {
    const double x = 0.1 * k;
    drive.push_back({elsewhere * Pose2{scale * x, 0.0, turn_rad_per_m * x}, {x, 0.0, 0.0}});
  }
  return drive;
}

}  // namespace

TEST_CASE("wheels one percent too large are one percent wrong wherever the frames lie") {
  const RelativeError error = relative_error(straight(12, 1.01, 0.0), 10.0, 1.0);
  CHECK(error.stretches == 3);  // from 0, 1 and 2 m
  CHECK(error.translation_percent == Approx(1.0).epsilon(1e-3));
  CHECK(error.heading_deg == Approx(0.0).margin(1e-9));
}

TEST_CASE("a heading that drifts by a milliradian a metre is 0.573 degrees off after ten") {
  CHECK(relative_error(straight(11, 1.0, 0.001), 10.0, 1.0).heading_deg == Approx(0.573).epsilon(1e-2));
}

TEST_CASE("a drive shorter than the stretch tells nothing") {
  const RelativeError error = relative_error(straight(9, 1.0, 0.0), 10.0, 1.0);
  CHECK(error.stretches == 0);
  CHECK(std::isnan(error.translation_percent));
}

TEST_CASE("standing noise is no way") {
  std::vector<PosePair> drive(1000);
  for (std::size_t k = 0; k < drive.size(); ++k) drive[k].truth.x = k % 2 == 0 ? 0.0 : 0.04;
  CHECK(relative_error(drive, 10.0, 1.0).stretches == 0);
}

TEST_CASE("the greatest step error is that of the worst step, seen from where the true one leads") {
  // The second step turns by 0.1 rad and goes 0.3 m where the truth goes straight on for 0.5 m.
  const std::vector<PosePair> drive = {
      {{}, {}}, {{1.0, 0.0, 0.0}, {1.0, 0.0, 0.0}}, {{1.3, 0.0, 0.1}, {1.5, 0.0, 0.0}}};
  CHECK(greatest_step_error(drive).translation_m == Approx(0.2));
  CHECK(greatest_step_error(drive).heading_deg == Approx(5.7296));
}
