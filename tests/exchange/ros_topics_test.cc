// A run's topics: frames by REP 105, stamps of the wall clock where there was one.
#include "apps/formats/ros_topics.h"

#include <cmath>
#include <cstring>
#include <map>
#include <memory>

#include "apps/formats/ros_input.h"
#include "tests/support/catch.h"
#include "tests/support/text.h"

namespace jaywalk::exchange {
namespace {

using namespace std::chrono_literals;

constexpr Duration kWall = std::chrono::seconds(1'700'000'000);

/// A tick's record, and the messages told of it.
struct Told {
  const RobotModel model = p3dx();
  std::unique_ptr<TickRecord> t = std::make_unique<TickRecord>();
  std::map<std::size_t, std::vector<std::string>> messages;
  std::vector<Time> stamps;
  RosTopics topics{[this](std::size_t topic, Time stamp, std::string message) {
                     messages[topic].push_back(std::move(message));
                     stamps.push_back(stamp);
                   },
                   kWall};

  /// The wheels have rolled straight on for `rolled_m`, the robot is believed at `map_from_robot`.
  void roll(double seconds, double rolled_m, const Pose2& map_from_robot) {
    t->now = t->wheels.stamp = time_from_seconds(seconds);
    ++t->wheels.sequence;
    t->wheels.left_rad = t->wheels.right_rad = rolled_m / model.drive.wheel_radius_m;
    t->pose.map_from_robot = map_from_robot;
  }
  void tell() { topics.add(*t, {}, t->path, model); }
};

TEST_CASE("map, odom, base_link and laser stand in one another as REP 105 has it, the pose in the map among them") {
  Told told;
  for (int k = 0; k < 50; ++k) told.roll(1.0 + 0.02 * k, 0.01 * k, {3.0, 4.0 + 0.01 * k, kPi / 2}), told.tell();
  REQUIRE(told.messages[kTf].size() == 50);
  const auto frames = read_transforms(told.messages[kTf].back(), Wire::kCdr);
  REQUIRE((frames && frames->size() == 2));
  CHECK((frames->at(0).parent == "map" && frames->at(0).child == "odom"));
  CHECK((frames->at(1).parent == "odom" && frames->at(1).child == "base_link"));
  const SpatialFrame map_from_robot = frames->at(0).parent_from_child * frames->at(1).parent_from_child;
  CHECK(map_from_robot.translation().x() == Approx(3.0));
  CHECK(map_from_robot.translation().y() == Approx(4.49));
  CHECK(heading_of(map_from_robot) == Approx(kPi / 2));
  const auto odometry = read_odometry(told.messages[kOdom].back(), Wire::kCdr);
  REQUIRE(odometry);
  CHECK(odometry->child_frame == "base_link");
  CHECK(odometry->pose.x == Approx(0.49));
  CHECK(odometry->pose.y == Approx(0.0).margin(1e-9));
  double variance_about_z = 0.0;  // of the twist: the last of all
  std::memcpy(&variance_about_z, told.messages[kOdom].back().data() + told.messages[kOdom].back().size() - 8, 8);
  CHECK(variance_about_z == 0.03);
  REQUIRE(told.messages[kTfStatic].size() == 1);
  const auto fixed = read_transforms(told.messages[kTfStatic].front(), Wire::kCdr);
  REQUIRE((fixed && fixed->size() == 1));
  CHECK((fixed->at(0).parent == "base_link" && fixed->at(0).child == "laser"));
}

TEST_CASE("the first map is told once something of it is known") {
  Told told;
  EvidenceMap map(64, 0.1, {0.0, 0.0});
  told.topics.add_map(map, Time{1s});
  CHECK(told.messages[kMap].empty());
  map.add({2, 3}, EvidenceMap::kMax);
  told.topics.add_map(map, Time{1s});
  CHECK(told.messages[kMap].size() == 1);
}

TEST_CASE("all stamps are the wall clock's where it is known") {
  Told told;
  told.roll(2.0, 0.0, {});
  told.tell();
  for (const Time stamp : told.stamps) CHECK(stamp == time_from_seconds(2.0) + kWall);
  CHECK(read_odometry(told.messages[kOdom].front(), Wire::kCdr)->stamp == time_from_seconds(2.0) + kWall);
}

TEST_CASE("each of two scanners has a topic and a frame of its own, and one alone the plain ones") {
  RobotModel model = p3dx();
  CHECK(of_scanner("/scan", model, 0) == "/scan");
  LaserModel rear = model.laser;
  rear.robot_from_laser = {-0.2, 0.0, kPi};
  model.laser.robot_from_laser = {0.2, 0.0, 0.0};
  REQUIRE(model.other_lasers.push_back(rear));
  CHECK(of_scanner("/scan", model, 0) == "/scan_front");
  CHECK(of_scanner("/scan", model, 1) == "/scan_rear");
  Told told;
  LaserScan& scan = told.t->scan;
  scan.sequence = 1, scan.beam_count = 3, scan.range_max_m = 9.0F;
  REQUIRE(told.t->other_scans.push_back(scan));
  for (const std::uint32_t sequence : {1U, 1U, 2U}) {
    told.roll(1.0, 0.0, {});
    told.t->other_scans[0].sequence = sequence;
    told.topics.add(*told.t, {}, told.t->path, model);
  }
  CHECK(told.messages[kScan].size() == 1);
  CHECK(told.messages[kOtherScans].size() == 2);  // each as it is new
  CHECK(holds(told.messages[kScan].front(), "laser_front"));
  CHECK(holds(told.messages[kOtherScans].front(), "laser_rear"));
  const auto fixed = read_transforms(told.messages[kTfStatic].front(), Wire::kCdr);
  REQUIRE((fixed && fixed->size() == 2));
  CHECK(fixed->at(1).child == "laser_rear");
  CHECK(fixed->at(1).parent_from_child.translation().x() == Approx(-0.2));
}

TEST_CASE("without wheels odom is the map") {
  Told told;
  told.t->now = time_from_seconds(1.0);
  told.t->pose.map_from_robot = {1.0, 2.0, 0.5};
  told.tell();
  const auto frames = read_transforms(told.messages[kTf].front(), Wire::kCdr);
  REQUIRE(frames);
  CHECK(frames->at(0).parent_from_child.translation().norm() == 0.0);
  CHECK(frames->at(1).parent_from_child.translation().x() == Approx(1.0));
}

}  // namespace
}  // namespace jaywalk::exchange
