#include "apps/setup/mount_search.h"
#include "tests/support/catch.h"

using namespace jaywalk;

namespace {

/// 100 steps of 0.1 m along `way`, the robot believing to look along `heading`.
MountCheck after_driving(double way, double heading) {
  MountCheck check;
  for (int k = 0; k <= 100; ++k) {
    const Vec2 p = direction(way) * (0.1 * k);
    check.add({p.x, p.y, heading});
  }
  return check;
}

}  // namespace

TEST_CASE("a robot that drives where it looks has its laser mounted right") {
  CHECK_FALSE(after_driving(0.7, 0.7).missing_yaw().has_value());
  CHECK_FALSE(MountCheck{}.missing_yaw().has_value());
}

TEST_CASE("one that seems to slide 0.7 rad to the right has a laser that looks 0.7 rad to the left") {
  // It looks along 2.3 and goes along 1.6, as the wheelchair's recording does without its mount.
  const auto yaw = after_driving(1.6, 2.3).missing_yaw();
  REQUIRE(yaw.has_value());
  CHECK(*yaw == Approx(0.7));
}
