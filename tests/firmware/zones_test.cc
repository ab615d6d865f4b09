// Keep-out and speed zones, driven from start to goal: the body by the world's truth, not by what the robot believes.
#include <cmath>

#include "tests/firmware/simulated_drive.h"
#include "tests/support/catch.h"

using namespace jaywalk;

namespace {

MapZone box(Vec2 low, Vec2 high, ZoneKind kind = ZoneKind::kKeepOut, double speed_mps = 0.0) {
  return {kind, {low, {high.x, low.y}, high, {low.x, high.y}}, speed_mps};
}

/// From the nearest point of the body to the zone: points every few centimetres along the outline, corners too.
double body_to_zone_m(const MapZone& zone, const Pose2& pose, const Footprint& f) {
  constexpr int kPoints = 12;
  const Transform2 map_from_robot(pose);
  double least = 1e9;
  for (int k = 0; k <= kPoints; ++k) {
    const double x = -f.rear_m + (f.front_m + f.rear_m) * k / kPoints, y = f.half_width_m * (2.0 * k / kPoints - 1.0);
    for (const Vec2 p : {Vec2{x, f.half_width_m}, Vec2{x, -f.half_width_m}, Vec2{f.front_m, y}, Vec2{-f.rear_m, y}})
      least = std::min(least, signed_distance(zone, map_from_robot * p));
  }
  return least;
}

struct Driven {
  bool arrived = false;
  double nearest_m = 1e9;       ///< body to the first zone
  double fastest_inside = 0.0;  ///< while the body touches the last zone
};

Driven drive(const RobotModel& model, const std::function<void(sim::Scenario&)>& edit = {}, double limit_s = 150.0) {
  std::vector<MapZone> zones;
  SimulatedDrive drive("zones", 1, [&](sim::Scenario& s) {
    s.model = model;
    s.model.limits.max_speed_mps = 0.6;
    if (edit) edit(s);
    zones = s.zones;
  });
  Driven done;
  done.arrived = drive.arrives(limit_s, [&](const TickRecord&) {
    const sim::Truth& truth = drive.truth();
    done.nearest_m = std::min(done.nearest_m, body_to_zone_m(zones.front(), truth.map_from_robot, model.footprint));
    if (body_to_zone_m(zones.back(), truth.map_from_robot, model.footprint) < 0.0)
      done.fastest_inside = std::max(done.fastest_inside, std::fabs(truth.twist.v_mps));
  });
  CHECK(drive.truth().contacts == 0);
  return done;
}

}  // namespace

TEST_CASE("a robot drives round a keep-out zone and slowly through a speed zone") {
  const RobotModel model = GENERATE(p3dx(), wheelchair());
  INFO(model.name);
  const Driven done = drive(model);
  CHECK(done.arrived);
  CHECK(done.nearest_m > 0.0);
  CHECK(done.fastest_inside > 0.2);
  CHECK(done.fastest_inside < 0.26);  // 0.25 m/s, and the wheels' slip
}

TEST_CASE("a robot that starts in a keep-out zone leaves it") {
  const RobotModel model = GENERATE(p3dx(), wheelchair());
  INFO(model.name);
  const auto in_zone = [](sim::Scenario& s) {
    s.zones = {box({0.8, 1.5}, {4.0, 5.0}), box({30.0, 0.0}, {31.0, 1.0}, ZoneKind::kSpeed, 0.3)};
    s.goal = {8.0, 7.0};
  };
  CHECK(drive(model, in_zone, 90.0).arrived);
}

TEST_CASE("where a keep-out zone closes the only way the robot stays outside") {
  const RobotModel model = GENERATE(p3dx(), wheelchair());
  INFO(model.name);
  const auto closed = [](sim::Scenario& s) {
    s.zones = {box({4.0, 0.0}, {6.0, 14.0}), box({30.0, 0.0}, {31.0, 1.0}, ZoneKind::kSpeed, 0.3)};
  };
  const Driven done = drive(model, closed, 25.0);
  CHECK_FALSE(done.arrived);
  CHECK(done.nearest_m > 0.0);
}

TEST_CASE("a robot that is driven by a stick stops before a keep-out zone, and is as slow as a speed zone wants") {
  const RobotModel model = GENERATE(p3dx(), wheelchair());
  INFO(model.name);
  const MapZone closed = box({2.9, 0.0}, {3.4, 2.6}), slow = box({0.0, 0.0}, {2.9, 2.6}, ZoneKind::kSpeed, 0.2);
  SimulatedDrive drive("stick_wall", 1, [&](sim::Scenario& s) {
    s.model = model;
    s.zones = {closed, slow};
  });
  double nearest_m = 1e9, fastest_mps = 0.0;
  drive.drive(12.0, [&](const TickRecord&) {
    const sim::Truth& truth = drive.truth();
    nearest_m = std::min(nearest_m, body_to_zone_m(closed, truth.map_from_robot, model.footprint));
    fastest_mps = std::max(fastest_mps, std::fabs(truth.twist.v_mps));
    return false;
  });
  CHECK(nearest_m > 0.0);
  CHECK(nearest_m < 0.4);  // it came there
  CHECK(fastest_mps > 0.15);
  CHECK(fastest_mps < 0.21);
}
