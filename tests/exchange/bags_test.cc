#include "apps/formats/ros_input.h"
#include "tests/exchange/made_bags.h"
#include "tests/recording/scratch.h"
#include "tests/support/catch.h"
#include "tests/support/text.h"

namespace jaywalk::exchange {
namespace {

using namespace tests;

void check_drive(const sim::RecordedLog& log) {
  REQUIRE(log.scans.size() == 10);
  CHECK(log.scans[1].stamp == Time{std::chrono::milliseconds(1'600'000'000'100)});
  CHECK(log.scans[0].angle_step_rad == 1.57079637F);
  CHECK(log.scans[0].range_max_m == 25.0F);
  CHECK(log.range_m[29] == 3.0F + 0.1F * 9.0F);
  REQUIRE(log.odometry.size() == 10);
  CHECK(log.odometry[9].pose.x == Approx(0.9));
  CHECK(log.odometry[9].twist == Twist2{1.0, 0.25});
  CHECK(log.robot_from_laser == Pose2{0.2, 0.0, 0.0});
  CHECK(log.refused.empty());
}

std::string refusal(const std::string& path, const BagOptions& options = {}) {
  return refusal_of([&] { return load_bag(path, options); });
}

TransformMessage lies(const std::string& parent, const std::string& child, double x, double y, double yaw) {
  return {parent, child, spatial_frame(x, y, 0.3, {0.0, 0.0, sin(yaw / 2), cos(yaw / 2)})};
}

TEST_CASE("one drive reads the same from every format and packing") {
  const Scratch scratch;
  for (const auto& [method, each] : {std::pair{"", false}, {"zstd", false}, {"lz4", false}, {"", true}, {"zstd", true}})
    check_drive(load_bag(scratch.write("a.mcap", mcap_of(made_drive(false), method, each)), {}));
  for (const std::string method : {"", "bz2", "lz4"})
    check_drive(load_bag(scratch.write("a.bag", ros1_bag_of(made_drive(true), method)), {}));
  for (const std::string name : {"whole.db3", "each.db3"}) {
    write_sqlite(scratch.path(name), made_drive(false), name == "each.db3");
    check_drive(load_bag(scratch.path(name), {}));
  }
}

TEST_CASE("a ROS 2 bag's folder holds files that are packed whole, or message by message") {
  const Scratch scratch;
  write_sqlite(scratch.path("plain.db3"), made_drive(false), false);
  scratch.write("a.db3.zstd", packed("zstd", scratch.read("plain.db3")));
  const auto metadata = [&](const std::string& file, const std::string& mode) {
    scratch.write("metadata.yaml", "rosbag2_bagfile_information:\n  relative_file_paths:\n    - " + file +
                                       "\n  compression_format: zstd\n  compression_mode: " + mode + "\n");
  };
  metadata("a.db3.zstd", "FILE");
  check_drive(load_bag(scratch.folder(), {}));
  write_sqlite(scratch.path("each.db3"), made_drive(false), true);
  metadata("each.db3", "MESSAGE");
  check_drive(load_bag(scratch.folder(), {}));
  metadata("../../etc/passwd", "");
  CHECK(holds(refusal(scratch.folder()), "passwd: no such file"));
  scratch.write("metadata.yaml", "rosbag2_bagfile_information: [\n");
  CHECK(holds(refusal(scratch.folder()), "metadata.yaml:"));
}

TEST_CASE("topics are told by their types, and more than one of a type is an error that lists them") {
  const Scratch scratch;
  std::vector<MadeMessage> drive = made_drive(false);
  const std::string none = refusal(scratch.write("a.mcap", mcap_of({{"/chatter", "std_msgs/String", 1, "x"}}, "")));
  CHECK(holds(none, "no topic of type sensor_msgs/LaserScan in it; there are: /chatter (std_msgs/String)"));
  drive.push_back({"/rear", "sensor_msgs/LaserScan", 1, scan_bytes(false, 1'000'000'000, "rear", {1.0F, 1.0F, 1.0F})});
  drive.push_back({"/fused", "nav_msgs/Odometry", 1, odometry_bytes(false, 1'000'000'000, 0.0)});
  const std::string file = scratch.write("b.mcap", mcap_of(drive, ""));
  CHECK(holds(refusal(file), "2 topics of type sensor_msgs/LaserScan: /rear, /scan; choose one with --scan-topic"));
  CHECK(holds(refusal(file, {.scan_topic = "/scan"}), "/fused, /odom; choose one with --odom-topic"));
  CHECK(holds(refusal(file, {.scan_topic = "/front"}),
              "no topic /front of type sensor_msgs/LaserScan; there are /rear, /scan"));
  check_drive(load_bag(file, {.scan_topic = "/scan", .odom_topic = "/odom"}));
}

TEST_CASE("a laser whose frame nothing joins to the robot's is where the model or the user says") {
  std::vector<MadeMessage> drive = made_drive(false);
  drive.front().bytes = frames_bytes(false, {{"elsewhere", "camera", 1.0, 1.0}});
  const sim::RecordedLog log = read_as_mcap(drive, {.otherwise = {0.7, 0.0, 0.0}});
  CHECK(log.robot_from_laser == Pose2{0.7, 0.0, 0.0});
  CHECK(holds(log.complaint(), "no transform from base_link to laser says it"));
  CHECK(read_as_mcap(drive, {.robot_from_laser = Pose2{0.1, 0.2, 0.3}}).robot_from_laser == Pose2{0.1, 0.2, 0.3});
}

TEST_CASE("a laser upside down counts its beams the other way, and one that looks at the floor is refused") {
  std::vector<MadeMessage> drive = made_drive(false);
  drive.front().bytes =
      frames_bytes(false, {{"base_link", "laser", 0.2, 0.0, {1.0, 0.0, 0.0, 0.0}}});  // half a turn about x
  const sim::RecordedLog log = read_as_mcap(drive);
  CHECK(log.scans[0].angle_step_rad == -1.57079637F);
  CHECK(log.robot_from_laser.heading == Approx(0.0).margin(1e-12));
  drive.front().bytes = frames_bytes(false, {{"base_link", "laser", 0.2, 0.0, {0.0, 0.7071, 0.0, 0.7071}}});
  CHECK(holds(refusal_of([&] { return read_as_mcap(drive); }), "does not look about level"));
}

TEST_CASE("scans of more beams than are taken are thinned out evenly") {
  std::vector<float> ranges(4097);
  for (std::size_t k = 0; k < ranges.size(); ++k) ranges[k] = static_cast<float>(k) * 0.001F;
  // 4097 beams at 90 degrees are no fan, but every third of them is what counts: 1366.
  const std::vector<MadeMessage> one{{"/scan", "sensor_msgs/LaserScan", 5, scan_bytes(false, 0, "laser", ranges)}};
  const sim::RecordedLog log = read_as_mcap(one);
  CHECK(log.scans[0].beams == 1366);
  CHECK(log.range_m[2] == 6 * 0.001F);
  CHECK(log.scans[0].stamp == Time{Duration{5}});  // its header has none: when it was recorded
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
