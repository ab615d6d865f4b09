#include "planner/motion/robot_body.h"

#include "hal/types/robot_model.h"
#include "tests/support/catch.h"

using namespace jaywalk;
using namespace jaywalk::motion;

TEST_CASE("a body's gap to a place is that of its rectangle") {
  const Footprint f = p3dx().footprint;
  const RobotBody body = robot_body(f, p3dx().limits, p3dx().laser, 1.0);
  CHECK(body.gap(0.0F, 0.0F) == 0.0F);
  CHECK(body.gap(static_cast<float>(f.front_m) + 0.3F, static_cast<float>(f.half_width_m) + 0.4F) == Approx(0.5F));
  CHECK(body.gap(-static_cast<float>(f.rear_m) - 0.2F, 0.0F) == Approx(0.2F));
  CHECK(body.gap(0.0F, -static_cast<float>(f.half_width_m) - 0.1F) == Approx(0.1F));
}
