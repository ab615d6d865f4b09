#include "apps/dds/dds_topics.h"

#include <ros_topics.h>  // idlc writes it
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <thread>

#include "apps/formats/ros_topics.h"
#include "apps/view/foxglove_session.h"
#include "tests/support/catch.h"

using namespace jaywalk;

namespace {

/// Says a pose until one is taken, or, where none must be, until the far end has seen a topic of ours and said it ten
/// times more.
template <class Pose>
std::optional<dds::PoseOrder> taken_of(bool takes_goals, const dds_topic_descriptor_t& type, const char* name,
                                       Pose said) {
  ::setenv("CYCLONEDDS_URI", "file://" JAYWALK_LOOPBACK, 1);
  const auto domain = static_cast<std::uint32_t>(::getpid() % 200);
  dds::DdsTopics topics(domain, takes_goals);
  const dds_entity_t far_end = dds_create_participant(domain, nullptr, nullptr);
  dds_qos_t* const qos = dds_create_qos();
  dds_qset_reliability(qos, DDS_RELIABILITY_RELIABLE, DDS_SECS(1));
  const auto topic = [&](const dds_topic_descriptor_t& kind, const char* at) {
    return dds_create_topic(far_end, &kind, at, nullptr, nullptr);
  };
  const dds_entity_t writer = dds_create_writer(far_end, topic(type, name), qos, nullptr);
  const dds_entity_t reader =
      dds_create_reader(far_end, topic(sensor_msgs_msg_dds__LaserScan__desc, "rt/scan"), qos, nullptr);
  dds_delete_qos(qos);
  REQUIRE(writer > 0);
  REQUIRE(reader > 0);
  char frame[] = "map";
  said.header_.frame_id_ = frame;
  std::optional<dds::PoseOrder> taken;
  for (int said_after = 0; !taken && said_after < 10;) {
    CHECK(dds_write(writer, &said) == DDS_RETCODE_OK);
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    taken = topics.take_order();
    dds_subscription_matched_status_t matched{};
    dds_get_subscription_matched_status(reader, &matched);
    said_after += !takes_goals && matched.current_count > 0 ? 1 : 0;
  }
  dds_delete(far_end);
  return taken;
}

std::optional<dds::PoseOrder> goal_taken(bool takes_goals) {
  return taken_of(takes_goals, geometry_msgs_msg_dds__PoseStamped__desc, "rt/goal_pose",
                  geometry_msgs_msg_dds__PoseStamped_{});
}

}  // namespace

TEST_CASE("a run's topics lie below the namespace that they are given") {
  ::setenv("CYCLONEDDS_URI", "file://" JAYWALK_LOOPBACK, 1);
  const auto domain = static_cast<std::uint32_t>(::getpid() % 200);
  const dds::DdsTopics topics(domain, false, "/jaywalk");
  const dds_entity_t far_end = dds_create_participant(domain, nullptr, nullptr);
  const auto publishers_of = [&](const char* topic, int most_looks) {
    const dds_entity_t reader =
        dds::make_reader(far_end, sensor_msgs_msg_dds__LaserScan__desc, topic, dds::qos_keeping(1, false));
    dds_subscription_matched_status_t matched{};
    for (int looks = 0; looks < most_looks && matched.current_count == 0; ++looks) {
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
      dds_get_subscription_matched_status(reader, &matched);
    }
    return matched.current_count;
  };
  CHECK(publishers_of("/jaywalk/scan", 30'000) == 1);  // for ten minutes
  CHECK(publishers_of("/scan", 100) == 0);
  dds_delete(far_end);
}

TEST_CASE("the scans of a second scanner have a topic of their own") {
  ::setenv("CYCLONEDDS_URI", "file://" JAYWALK_LOOPBACK, 1);
  const auto domain = static_cast<std::uint32_t>(::getpid() % 200);
  dds::DdsTopics topics(domain, false, "/jaywalk");
  const dds_entity_t far_end = dds_create_participant(domain, nullptr, nullptr);
  const dds_entity_t reader =
      dds::make_reader(far_end, sensor_msgs_msg_dds__LaserScan__desc, "/jaywalk/scan_rear", dds::qos_keeping(1, true));
  LaserScan scan;
  scan.beam_count = 3;
  REQUIRE(dds::DdsTopics::passes("/scan_rear"));
  REQUIRE_FALSE(dds::DdsTopics::passes("/scanned"));
  void* samples[1] = {nullptr};
  dds_sample_info_t info[1];
  dds_return_t taken = 0;
  for (int looks = 0; looks < 30'000 && taken == 0; ++looks) {
    CHECK(topics.publish("/scan_rear", exchange::laser_scan(scan, Time{}, "laser_rear")));
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    taken = dds_take(reader, samples, info, 1, 1);
  }
  REQUIRE(taken == 1);
  const auto& came = *static_cast<const sensor_msgs_msg_dds__LaserScan_*>(samples[0]);
  CHECK(std::string(came.header_.frame_id_) == "laser_rear");
  CHECK(came.ranges_._length == 3);
  dds_return_loan(reader, samples, taken);
  dds_delete(far_end);
}

TEST_CASE("/joint_states on DDS has both wheels, their angles and speeds") {
  ::setenv("CYCLONEDDS_URI", "file://" JAYWALK_LOOPBACK, 1);
  const auto domain = static_cast<std::uint32_t>(::getpid() % 200);
  dds::DdsTopics topics(domain, false);
  const dds_entity_t far_end = dds_create_participant(domain, nullptr, nullptr);
  const dds_entity_t reader =
      dds::make_reader(far_end, sensor_msgs_msg_dds__JointState__desc, "/joint_states", dds::qos_keeping(1, true));
  WheelState wheels;
  wheels.left_rad = 1.5, wheels.right_rad = -2.5, wheels.left_radps = 0.25, wheels.right_radps = 4.0;
  bool came = false;
  for (int looks = 0; looks < 30'000 && !came; ++looks) {
    CHECK(topics.publish("/joint_states", view::joint_states(wheels, Time{std::chrono::milliseconds(2250)})));
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    dds::take_all<sensor_msgs_msg_dds__JointState_>(reader, [&](const auto& told, const auto&) {
      came = true;
      CHECK(told.header_.stamp_.sec_ == 2);
      CHECK(told.header_.stamp_.nanosec_ == 250'000'000);
      REQUIRE((told.name_._length == 2 && told.position_._length == 2 && told.velocity_._length == 2));
      CHECK(std::string(told.name_._buffer[0]) == "left_wheel_joint");
      CHECK(std::string(told.name_._buffer[1]) == "right_wheel_joint");
      CHECK((told.position_._buffer[0] == 1.5 && told.position_._buffer[1] == -2.5));
      CHECK((told.velocity_._buffer[0] == 0.25 && told.velocity_._buffer[1] == 4.0));
      CHECK(told.effort_._length == 0);
    });
  }
  CHECK(came);
  dds_delete(far_end);
}

TEST_CASE("a goal on DDS is taken where goals were asked for, and nowhere else") {
  CHECK_FALSE(goal_taken(true)->is_place);
  CHECK_FALSE(goal_taken(false));
}

TEST_CASE("RViz's pose estimate on DDS is taken as the place where the robot is") {
  geometry_msgs_msg_dds__PoseWithCovarianceStamped_ estimate{};
  estimate.pose_.pose_.position_.x_ = 3.0;
  estimate.pose_.pose_.orientation_.z_ = 1.0;
  const auto taken = taken_of(true, geometry_msgs_msg_dds__PoseWithCovarianceStamped__desc, "rt/initialpose", estimate);
  REQUIRE(taken);
  CHECK(taken->is_place);
  CHECK(dds::words_of(*taken) == "here 3 0 3.1415926535897931");
}
