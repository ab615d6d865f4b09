// Two scanners whose views overlap a little: a body is followed from one into the other.
#include <algorithm>
#include <set>

#include "planner/localization/localizer.h"
#include "planner/scan/scan_points.h"
#include "tests/perception/watch.h"
#include "tests/support/catch.h"

using namespace jaywalk;
using namespace jaywalk::test;

namespace {

/// At the ends of a robot of a metre, 200 degrees each.
const std::array<Pose2, 2> kMounts{Pose2{0.5, 0.0, 0.0}, Pose2{-0.5, 0.0, kPi}};
constexpr Fan kFan{.beams = 601, .first_rad = -100.0 * kPi / 180.0, .step_rad = 200.0 * kPi / 180.0 / 600};

LaserScan seen_by(std::size_t scanner, const Room& room, const Pose2& robot, double at_s, std::uint32_t sequence) {
  LaserScan scan = scan_of(room, robot * kMounts[scanner], sequence, 0.005, kFan);
  scan.scanner = static_cast<std::uint8_t>(scanner);
  scan.stamp = time_from_seconds(at_s);
  return scan;
}

struct Eyes {
  Tracker tracker{
      {.robot_from_laser = kMounts[0], .map_side_cells = 256, .map_centre = {}, .robot_from_others = others()}};
  std::array<std::uint32_t, 2> sequence{};

  static OfOthers<Pose2> others() {
    OfOthers<Pose2> mounts;
    (void)mounts.push_back(kMounts[1]);
    return mounts;
  }
  /// One scanner's next, taken at `at_s`.
  void see(std::size_t scanner, double at_s, const Room& room, const Pose2& robot = {}) {
    tracker.update(seen_by(scanner, room, robot, at_s, ++sequence[scanner]), robot);
  }
};

Room with_disc(Vec2 centre) { return with({{centre, 0.27}}); }

/// Where a walker is that passes the robot from ahead to behind at 1.2 m/s.
Vec2 passing(double t_s) { return {4.0 - 1.2 * t_s, 1.6}; }

}  // namespace

TEST_CASE("a walker who passes from one scanner's view into the other's stays the same and moving") {
  Eyes eyes;
  for (std::uint32_t k = 0; k < 60; ++k) eyes.see(k % 2U, k / 30.0, rectangle(12.0, 10.0));
  std::set<std::uint32_t> ids;
  int lost = 0;
  for (std::uint32_t k = 0; k < 180; ++k) {
    const double t_s = k / 30.0;
    eyes.see(k % 2U, 2.0 + t_s, with_disc(passing(t_s)));
    if (t_s < 1.0) continue;
    for (const Track& track : eyes.tracker.moving()) ids.insert(track.id);
    lost += track_near(eyes.tracker.moving(), passing(t_s), 0.2) == nullptr ? 1 : 0;
  }
  CHECK(ids.size() == 1);
  CHECK(lost == 0);
}

TEST_CASE("a scan that does not look at a walker says nothing of him: he is followed as if it had not been") {
  Eyes with_rear, alone;
  const auto both = [&](double at_s, const Room& room) {
    with_rear.see(0, at_s, room);
    alone.see(0, at_s, room);
    with_rear.see(1, at_s + 1.0 / 30.0, room);
  };
  for (int k = 0; k < 30; ++k) both(k / 15.0, rectangle(12.0, 10.0));
  int first_with_rear = -1, first_alone = -1;
  for (int k = 0; k < 30; ++k) {
    both(2.0 + k / 15.0, with_disc({3.0, -2.0 + 0.08 * k}));
    if (first_with_rear < 0 && !with_rear.tracker.moving().empty()) first_with_rear = k;
    if (first_alone < 0 && !alone.tracker.moving().empty()) first_alone = k;
  }
  REQUIRE(first_alone > 0);
  CHECK(first_with_rear >= 0);
  CHECK(first_with_rear <= first_alone + 2);
  CHECK(only_mover(with_rear.tracker).velocity_in_map.y == Approx(1.2).margin(0.15));
}

TEST_CASE("walls on all sides are mapped from where each scanner is") {
  Eyes eyes;
  for (std::uint32_t k = 0; k < 60; ++k) eyes.see(k % 2U, k / 30.0, rectangle(12.0, 10.0));
  const EvidenceMap& still = eyes.tracker.still();
  for (const Vec2 wall : {Vec2{5.99, 1.0}, Vec2{-5.99, 1.0}, Vec2{3.0, 4.99}, Vec2{-3.0, -4.99}})
    CHECK(still.occupied(still.cell_at(wall)));
  for (const Vec2 free : {Vec2{3.0, 1.0}, Vec2{-3.0, -1.0}}) CHECK(still.seen_free(still.cell_at(free)));
  CHECK(eyes.tracker.moving().empty());
}

TEST_CASE("a slow sweep that comes after a later one is taken at its own time") {
  Eyes eyes;
  for (std::uint32_t k = 0; k < 60; ++k) eyes.see(k % 2U, k / 30.0, rectangle(12.0, 10.0));
  // Beside the robot, in both views; the front's scans come 60 ms after they were taken, and so after the rear's.
  const auto place = [](double t_s) { return Vec2{-1.5 + 1.2 * t_s, 2.0}; };
  for (int k = 1; k < 40; ++k) {
    const double t_s = k / 15.0;
    eyes.see(1, 2.0 + t_s, with_disc(place(t_s)));
    eyes.see(0, 2.0 + t_s - 0.06, with_disc(place(t_s - 0.06)));
    if (k < 15) continue;
    const Track& track = only_mover(eyes.tracker);
    CHECK(track.stamp == time_from_seconds(2.0 + t_s));
    CHECK(distance(track.position_in_map, place(t_s)) < 0.08);
    CHECK(track.velocity_in_map.x == Approx(1.2).margin(0.15));
  }
}

TEST_CASE("a scan of another scanner may be older than the newest, and a clock that is set back may not") {
  ScanOrder order;
  LaserScan a, b;
  b.scanner = 1;
  const auto behind = [&](LaserScan& scan, double at_s) {
    scan.stamp = time_from_seconds(at_s);
    return order.behind_s(scan);
  };
  CHECK(behind(a, 1.0) == 0.0);
  CHECK(behind(b, 0.95) == Approx(-0.05));
  CHECK(behind(a, 1.1) == 0.0);
  CHECK(order.before() == time_from_seconds(1.0));
  CHECK(behind(b, 1.04) == Approx(-0.06));
  CHECK(behind(b, 1.2) == 0.0);
  CHECK(behind(a, 0.5) == 0.0);  // its own clock went back
}

TEST_CASE("the pose is held by whichever scanner sees walls, each from its own mount") {
  const DriveModel drive{.wheel_radius_m = 0.1, .track_width_m = 0.4, .max_wheel_speed_radps = 20.0};
  Localizer localizer({.map_from_robot_at_start = {},
                       .drive = drive,
                       .robot_from_laser = kMounts[0],
                       .robot_from_others = Eyes::others()});
  Eyes eyes;
  const Room room = rectangle(12.0, 10.0);
  WheelState wheels{.sequence = 1};
  std::array<std::uint32_t, 2> sequence{};
  double off_m = 0.0;
  for (std::uint32_t k = 0; k < 300; ++k) {
    const double t_s = k / 30.0, drove_m = 0.2 * std::max(0.0, t_s - 2.0);
    const Pose2 robot{drove_m, 0.0, 0.0};
    wheels.stamp = time_from_seconds(t_s), ++wheels.sequence;
    wheels.left_rad = drove_m / 0.1, wheels.right_rad = 1.03 * drove_m / 0.1;  // drifts to the left by wheels alone
    const std::size_t scanner = k % 2U;
    const LaserScan scan = seen_by(scanner, room, robot, t_s, ++sequence[scanner]);
    (void)localizer.update(wheels, scan, {}, eyes.tracker.still(), {});
    const Pose2 at_scan = localizer.map_from_robot_at_scan(scanner);
    off_m = std::max(off_m, distance(at_scan.position(), robot.position()));
    eyes.tracker.update(scan, at_scan, localizer.twist());
  }
  CHECK(off_m < 0.05);
}
