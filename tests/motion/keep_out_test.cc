#include <memory>

#include "planner/mapping/known_map.h"
#include "planner/motion/robot_body.h"
#include "tests/motion/guided.h"
#include "tests/support/catch.h"

using namespace jaywalk;

namespace {

MapZone box(Vec2 low, Vec2 high, ZoneKind kind = ZoneKind::kKeepOut, double speed_mps = 0.0) {
  return {kind, {low, {high.x, low.y}, high, {low.x, high.y}}, speed_mps};
}

constexpr Vec2 kGoal{4.0, 0.0};

/// Open ground with a zone on it.
test::Guided zoned(const MapZone& zone) {
  return test::Guided(std::make_shared<const KeepOutField>(std::span(&zone, 1)));
}

/// The way from a place to where the guide has no time left, 0.2 m at a time to the nearest in time of 16 directions;
/// `visit` each place. False when that takes more than `most_m`.
template <class Visit>
bool goes(const Guide& guide, Vec2 at, double most_m, const Visit& visit) {
  for (double gone = 0.0; gone < most_m; gone += 0.2) {
    Vec2 best = at;
    for (int k = 0; k < 16; ++k) {
      const Vec2 p = at + direction(2.0 * kPi * k / 16.0) * 0.2;
      const auto seconds = [&guide](Vec2 q) {
        return guide.time_to_go(static_cast<float>(q.x), static_cast<float>(q.y));
      };
      if (seconds(p) < seconds(best)) best = p;
    }
    if (best == at) return false;
    visit(at = best);
    if (distance(at, kGoal) < 0.3) return true;
  }
  return false;
}

}  // namespace

TEST_CASE("distances to keep-out zones are to a zone 5 cm wider than drawn, between nodes too") {
  const std::vector<MapZone> zones{box({0, 0}, {2, 1}), box({5, 0}, {6, 1}, ZoneKind::kSpeed, 0.3)};
  const KeepOutField field(zones);
  const KeepOut view = field.view();
  CHECK(view.distance(3.0F, 0.52F) == Approx(0.95F).margin(1e-4));
  CHECK(view.distance(2.33F, 0.5F) == Approx(0.28F).margin(1e-4));
  CHECK(view.distance(1.0F, 0.3F) == Approx(-0.35F).margin(1e-4));
  CHECK(view.distance(2.3F, 1.4F) == Approx(0.45F).margin(0.005));  // to the corner, 0.5 m: curved between nodes
  CHECK(view.distance(5.5F, 0.5F) == KeepOut::kFar_m);              // a speed zone
  CHECK(view.distance(-50.0F, 80.0F) == KeepOut::kFar_m);
  CHECK(KeepOut{}.distance(0.0F, 0.0F) == KeepOut::kFar_m);
}

TEST_CASE("the way to the goal leads round a keep-out zone, and what walks may walk through it") {
  const MapZone zone = box({0.0, -2.0}, {1.0, 2.0});
  test::Guided ground = zoned(zone);
  const Guide& guide = ground.towards({-2.0, 0.0}, kGoal);
  double nearest = 1e9;
  REQUIRE(goes(guide, {-2.0, 0.0}, 15.0, [&](Vec2 p) { nearest = std::min(nearest, signed_distance(zone, p)); }));
  CHECK(nearest > 0.2);  // the body's narrowest half
  CHECK(guide.distance(0.5F, 0.0F) == Guide::kFar_m);
  CHECK(guide.room(0.5F, 0.0F) == Approx(-0.55F).margin(1e-4));
  const motion::BodyDiscs body = motion::BodyDiscs::covering(p3dx().footprint, 0.02);
  // The foremost of three discs, 0.170 m apart from -0.301 m to 0.210 m: its middle is 0.1248 m ahead of the axle, its
  // radius hypot(0.0852, 0.2125) = 0.2289 m.
  CHECK(body.clearance(guide, -0.5F, 0.0F, {1.0F, 0.0F}) == Approx(0.45 - 0.1248 - 0.2289).margin(1e-3));
}

TEST_CASE("a robot in a keep-out zone has a way out of it, from outside none leads in") {
  const MapZone zone = box({-3.0, -2.0}, {1.0, 2.0});
  test::Guided ground = zoned(zone);
  const Guide& inside = ground.towards({0.0, 0.0}, kGoal);
  bool came_out = false, went_back = false;
  CHECK(goes(inside, {0.0, 0.0}, 8.0, [&](Vec2 p) {
    const bool out = signed_distance(zone, p) > 0.0;
    went_back = went_back || (came_out && !out);
    came_out = came_out || out;
  }));
  CHECK(came_out);
  CHECK_FALSE(went_back);
  const Guide& outside = ground.towards({2.0, 0.0}, kGoal);
  CHECK(outside.time_to_go(0.0F, 0.0F) == Guide::kNoWay_s);
}

TEST_CASE("a guide whose zones are far away has the bytes of one without") {
  test::Guided ground = zoned(box({60.0, 60.0}, {61.0, 61.0})), plain;
  const Guide& with = ground.towards({-2.0, 0.0}, kGoal);
  const Guide& without = plain.towards({-2.0, 0.0}, kGoal);
  for (float x = -3.5F; x < 5.5F; x += 0.25F) {
    CHECK(with.time_to_go(x, 1.0F) == without.time_to_go(x, 1.0F));
    CHECK(with.room(x, 1.0F) == without.room(x, 1.0F));
  }
}

TEST_CASE("a speed zone holds where the circle about the body touches it, and slows down before") {
  const std::vector<MapZone> zones{box({3.0, -1.0}, {5.0, 1.0}, ZoneKind::kSpeed, 0.2), box({8.0, 0.0}, {9.0, 1.0})};
  const auto speed_at = [&](Vec2 robot) { return motion::zone_speed(zones, p3dx(), robot); };
  // The circle has 0.3685 m, and 0.05 m are added: it touches from x = 2.5816 on.
  CHECK(speed_at({2.5, 0.0}).here_mps > 100.0);
  CHECK(speed_at({2.6, 0.0}).here_mps == 0.2);
  CHECK(speed_at({4.0, 0.9}).here_mps == 0.2);
  CHECK(speed_at({2.5, 0.0}).ahead_mps == 0.2);  // nearer than 0.1 m
  // 1 m before it touches, 0.1 m off: v^2 = 0.04 + 0.5 * 0.9 = 0.49.
  CHECK(speed_at({1.5816, 0.0}).ahead_mps == Approx(0.7).margin(1e-3));
  CHECK(speed_at({8.5, 0.5}).here_mps > 100.0);
}
