// jaywalk_dds between a ROS 2 robot's topics and the shared rings, both ends played here.
#include "apps/dds/robot_bridge.h"

#include <ros_topics.h>  // idlc writes it
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <thread>

#include "firmware/robot/robot_devices.h"
#include "hal/types/errors.h"
#include "tests/support/catch.h"

using namespace jaywalk;
using namespace std::chrono_literals;

namespace {

using LaserScanSample = sensor_msgs_msg_dds__LaserScan_;
using OdometrySample = nav_msgs_msg_dds__Odometry_;
using TwistSample = geometry_msgs_msg_dds__Twist_;

RobotFile robot_of(const std::string& text) {
  const auto path = std::filesystem::temp_directory_path() / ("jaywalk_dds_" + std::to_string(::getpid()) + ".toml");
  std::ofstream(path) << text;
  RobotFile robot = load_robot_file(path);
  std::filesystem::remove(path);
  return robot;
}

constexpr const char* kRobot =
    "model = \"p3dx\"\n[laser]\nkind = \"dds\"\nbeams = 271\nrange_m = 10.0\n[drive]\nkind = \"dds\"\n";

std::uint32_t set_up() {
  ::setenv("CYCLONEDDS_URI", "file://" JAYWALK_LOOPBACK, 1);
  const auto folder = std::filesystem::temp_directory_path() / ("jaywalk_dds_run_" + std::to_string(::getpid()));
  std::filesystem::create_directories(folder);
  std::filesystem::permissions(folder, std::filesystem::perms::owner_all);
  ::unsetenv("RUNTIME_DIRECTORY");
  ::setenv("XDG_RUNTIME_DIR", folder.c_str(), 1);
  return static_cast<std::uint32_t>(::getpid() % 200);
}

/// The bridge with its two threads, its rings' other ends and a far end on DDS.
struct Bench {
  std::uint32_t domain = set_up();
  std::unique_ptr<ros::SharedRing> scans = ros::SharedRing::make(ring_path("/scan"), ros::kScanRing),
                                   states = ros::SharedRing::make(ring_path("/odom"), ros::kBaseRing),
                                   orders = ros::SharedRing::make(ring_path("/cmd_vel"), ros::kBaseRing);
  dds::RobotBridge bridge{robot_of(kRobot), domain};
  dds_entity_t far_end = dds_create_participant(domain, nullptr, nullptr);
  dds::Qos qos = dds::qos_keeping(1, true);
  dds_entity_t scan_writer = dds::make_writer(far_end, sensor_msgs_msg_dds__LaserScan__desc, "/scan", qos);
  dds_entity_t odometry_writer = dds::make_writer(far_end, nav_msgs_msg_dds__Odometry__desc, "/odom", qos);
  dds_entity_t reader =
      dds::make_reader(far_end, geometry_msgs_msg_dds__Twist__desc, "/cmd_vel", dds::qos_keeping(100, true));
  std::atomic<bool> ends{false};
  std::thread in{[this] {
    while (!ends) bridge.pass_in(10ms);
  }};
  std::thread out{[this] {
    while (!ends) bridge.pass_out(10ms);
  }};

  ~Bench() {
    ends = true;
    in.join(), out.join();
    dds_delete(far_end);
  }
  void say_scan(std::uint32_t beams = 271) {
    std::vector<float> ranges(beams, 3.0F);
    LaserScanSample scan{};
    char frame[] = "laser";
    scan.header_.frame_id_ = frame;
    scan.angle_min_ = -2.3562F;
    scan.angle_increment_ = 4.7124F / (static_cast<float>(beams) - 1.0F);
    scan.range_min_ = 0.1F;
    scan.range_max_ = 10.0F;
    scan.ranges_ = {beams, beams, ranges.data(), false};
    CHECK(dds_write(scan_writer, &scan) == DDS_RETCODE_OK);
  }
  void say_odometry(double v_mps = 0.0) const {
    OdometrySample odometry{};
    char frame[] = "odom";
    odometry.header_.frame_id_ = odometry.child_frame_id_ = frame;
    odometry.pose_.pose_.orientation_.w_ = 1.0;
    odometry.twist_.twist_.linear_.x_ = v_mps;
    CHECK(dds_write(odometry_writer, &odometry) == DDS_RETCODE_OK);
  }
  void order(float left_radps, float right_radps) const {
    for (const auto& [id, speed] :
         {std::pair{ros::kWheelOrder + 0U, left_radps}, {ros::kWheelOrder + 1U, right_radps}}) {
      const CanFrame frame = ros::to_frame(id, {speed, 0});
      const ros::BaseMessage message{SteadyClock().now().time_since_epoch().count(), id, frame.size, frame.bytes};
      orders->write(std::as_bytes(std::span(&message, 1)));
    }
  }
  /// The next frame of a ring that is `id`.
  std::optional<CanFrame> next_state(std::uint32_t id) const {
    ros::BaseMessage message;
    while (states->read(std::as_writable_bytes(std::span(&message, 1))) == ros::SharedRing::Took::kMessage)
      if (message.id == id) return CanFrame{.id = id, .size = 8, .bytes = message.bytes};
    return std::nullopt;
  }
  std::vector<TwistSample> commands() const {
    std::vector<TwistSample> all;
    dds::take_all<TwistSample>(reader, [&](const TwistSample& twist, const auto&) { all.push_back(twist); });
    return all;
  }
};

/// `act` every 20 ms until `holds`, for ten minutes at most.
template <class Act, class Holds>
bool repeat(Act act, Holds holds) {
  for (int k = 0; k < 30'000; ++k) {
    act();
    std::this_thread::sleep_for(20ms);
    if (holds()) return true;
  }
  return false;
}

}  // namespace

TEST_CASE("a ROS 2 robot's scans and odometry reach the rings, in the model's beams and wheels") {
  Bench bench;
  ros::ScanMessage scan;
  const auto has_scan = [&] {
    return bench.scans->read(std::as_writable_bytes(std::span(&scan, 1))) == ros::SharedRing::Took::kMessage;
  };
  REQUIRE(repeat([&] { bench.say_scan(); }, has_scan));
  CHECK(scan.beam_count == 271);
  CHECK(scan.range_m[135] == 3.0F);
  REQUIRE(repeat([&] { bench.say_scan(900); }, has_scan));
  CHECK(scan.beam_count == 271);
  REQUIRE(repeat([&] { bench.say_scan(0); }, [&] { return has_scan() && scan.beam_count == 0; }));  // told, not hidden
  std::optional<CanFrame> wheel;
  REQUIRE(
      repeat([&] { bench.say_odometry(0.39); }, [&] { return (wheel = bench.next_state(ros::kWheel)).has_value(); }));
  CHECK(ros::wheel_in(*wheel)->speed_radps == Approx(4.0F));  // of a wheel of 0.0975 m
  std::optional<CanFrame> listeners;
  REQUIRE(repeat([&] { bench.say_odometry(); },
                 [&] { return (listeners = bench.next_state(ros::kListeners)) && listeners->bytes[0] == 1; }));
}

TEST_CASE("wheel orders are a Twist, silence and an alarm are zero, and then nothing") {
  Bench bench;
  std::vector<TwistSample> all;
  REQUIRE(repeat([&] { bench.order(3.0F, 5.0F); }, [&] { return !(all = bench.commands()).empty(); }));
  CHECK(all.back().linear_.x_ == Approx(0.39));           // 4 rad/s of a wheel of 0.0975 m
  CHECK(all.back().angular_.z_ == Approx(0.195 / 0.33));  // the wheels are 0.33 m apart
  REQUIRE(repeat([] {}, [&] { return !(all = bench.commands()).empty() && all.back().linear_.x_ == 0.0; }));
  REQUIRE(repeat([] { std::this_thread::sleep_for(300ms); }, [&] { return bench.commands().empty(); }));
  bench.order(1e9F, 1.0F);  // no robot's
  bench.order(std::numeric_limits<float>::quiet_NaN(), 1.0F);
  std::this_thread::sleep_for(50ms);
  CHECK(bench.commands().empty());
  bench.order(2.0F, 2.0F);
  bench.orders->raise_alarm();
  CHECK(repeat([] {}, [&] { return !(all = bench.commands()).empty() && all.back().linear_.x_ == 0.0; }));
}

TEST_CASE("two publishers of a topic are none, and another node's commands are told") {
  Bench bench;
  REQUIRE(repeat([&] { bench.say_odometry(); }, [&] { return bench.next_state(ros::kWheel).has_value(); }));
  const dds_entity_t second = dds::make_writer(bench.far_end, nav_msgs_msg_dds__Odometry__desc, "/odom", bench.qos);
  const auto is_silent = [&] {
    while (bench.next_state(ros::kWheel)) {
    }
    bench.say_odometry();
    std::this_thread::sleep_for(100ms);
    return !bench.next_state(ros::kWheel).has_value();
  };
  CHECK(repeat([] {}, is_silent));
  dds_delete(second);
  CHECK(repeat([&] { bench.say_odometry(); }, [&] { return bench.next_state(ros::kWheel).has_value(); }));
  const dds_entity_t rival = dds::make_writer(bench.far_end, geometry_msgs_msg_dds__Twist__desc, "/cmd_vel", bench.qos);
  const TwistSample twist{};
  CHECK(repeat([&] { static_cast<void>(dds_write(rival, &twist)); },
               [&] { return bench.next_state(ros::kOtherMaster).has_value(); }));
}

TEST_CASE("a robot's program that is started anew is found, one without ROS 2 devices refused") {
  Bench bench;
  REQUIRE(repeat([&] { bench.say_odometry(); }, [&] { return bench.next_state(ros::kWheel).has_value(); }));
  bench.states = ros::SharedRing::make(ring_path("/odom"), ros::kBaseRing);
  CHECK(repeat([&] { bench.say_odometry(); }, [&] { return bench.next_state(ros::kWheel).has_value(); }));
  const RobotFile other = robot_of(
      "model = \"p3dx\"\n[laser]\nkind = \"sick-cola-b\"\nhost = \"10.0.0.2\"\n[drive]\nkind = \"odrive\"\ncan = "
      "\"can0\"\nmotor_turns_per_wheel_turn = 10.0\n");
  CHECK_THROWS_AS(dds::RobotBridge(other, bench.domain), StartupError);
}
