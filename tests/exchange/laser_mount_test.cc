#include "apps/formats/ros_input.h"
#include "tests/support/catch.h"

namespace jaywalk::exchange {
namespace {

TransformMessage lies(const std::string& parent, const std::string& child, double x, double y, double yaw) {
  return {parent, child, spatial_frame(x, y, 0.3, {0.0, 0.0, sin(yaw / 2), cos(yaw / 2)})};
}

TEST_CASE("frames one in another are joined, up and down the tree") {
  // A mast 1 m ahead of the body's middle, turned a quarter to the left; the laser 0.5 m ahead on it: (1, 0.5) and
  // a quarter. The footprint lies 0.1 m ahead of the body: from it the laser is at (0.9, 0.5).
  FrameTree frames;
  frames.add(lies("/body", "/mast", 1.0, 0.0, kPi / 2));
  frames.add(lies("mast", "laser", 0.5, 0.0, 0.0));
  frames.add(lies("body", "footprint", 0.1, 0.0, 0.0));
  const auto mount = level_mount(*frames.find("footprint", "/laser"));
  REQUIRE(mount);
  CHECK(mount->robot_from_laser.x == Approx(0.9));
  CHECK(mount->robot_from_laser.y == Approx(0.5));
  CHECK(mount->robot_from_laser.heading == Approx(kPi / 2));
  CHECK_FALSE(mount->upside_down);
  CHECK(frames.find("laser", "laser")->matrix().isIdentity());
}

TEST_CASE("frames that nothing joins, that move, or that go in circles, say nothing") {
  FrameTree frames;
  frames.add(lies("odom", "base", 0.0, 0.0, 0.0));
  frames.add(lies("base", "laser", 0.2, 0.0, 0.0));
  CHECK(frames.find("odom", "laser"));
  frames.add(lies("odom", "base", 1.0, 0.0, 0.0));
  frames.add(lies("base", "laser", 0.2, 0.0, 0.0));
  CHECK_FALSE(frames.find("odom", "laser"));
  CHECK(frames.find("base", "laser"));
  CHECK_FALSE(frames.find("base", "camera"));
  frames.add(lies("a", "b", 0.0, 0.0, 0.0));
  frames.add(lies("b", "a", 0.0, 0.0, 0.0));
  CHECK_FALSE(frames.find("base", "a"));
}

}  // namespace
}  // namespace jaywalk::exchange
