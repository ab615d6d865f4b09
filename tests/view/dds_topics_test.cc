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

/// A participant at the other end, over loopback alone.
struct FarEnd {
  static std::uint32_t domain_on_loopback() {
    ::setenv("CYCLONEDDS_URI", "file://" JAYWALK_LOOPBACK, 1);
    return static_cast<std::uint32_t>(::getpid() % 200);
  }
  ~FarEnd() { dds_delete(participant); }

  std::uint32_t domain = domain_on_loopback();
  dds_entity_t participant = dds_create_participant(domain, nullptr, nullptr);
};

/// Says a pose until one is taken, or, where none must be, until the far end has seen a topic of ours and said it ten
/// times more.
template <class Pose>
std::optional<dds::PoseOrder> taken_of(bool takes_goals, const dds_topic_descriptor_t& type, const char* name,
                                       Pose said) {
  const FarEnd far_end;
  dds::DdsTopics topics(far_end.domain, takes_goals);
  const dds::Qos qos = dds::qos_keeping(1, true);
  const auto topic = [&](const dds_topic_descriptor_t& kind, const char* at) {
    return dds_create_topic(far_end.participant, &kind, at, nullptr, nullptr);
  };
  const dds_entity_t writer = dds_create_writer(far_end.participant, topic(type, name), qos.get(), nullptr);
  const dds_entity_t reader = dds_create_reader(
      far_end.participant, topic(sensor_msgs_msg_dds__LaserScan__desc, "rt/scan"), qos.get(), nullptr);
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
  return taken;
}

std::optional<dds::PoseOrder> goal_taken(bool takes_goals) {
  return taken_of(takes_goals, geometry_msgs_msg_dds__PoseStamped__desc, "rt/goal_pose",
                  geometry_msgs_msg_dds__PoseStamped_{});
}

/// Publishes a message again and again until it has come, for ten minutes; `look` checks what came.
template <class Message, class Look>
void check_comes(const dds_topic_descriptor_t& type, const std::string& space, const std::string& topic,
                 const std::string& message, const Look& look) {
  const FarEnd far_end;
  dds::DdsTopics topics(far_end.domain, false, space);
  const dds_entity_t reader = dds::make_reader(far_end.participant, type, space + topic, dds::qos_keeping(1, true));
  bool came = false;
  for (int looks = 0; looks < 30'000 && !came; ++looks) {
    CHECK(topics.publish(topic, message));
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    dds::take_all<Message>(reader, [&](const Message& told, const auto&) {
      came = true;
      look(told);
    });
  }
  CHECK(came);
}

}  // namespace

TEST_CASE("a run's topics lie below the namespace that they are given") {
  const FarEnd far_end;
  const dds::DdsTopics topics(far_end.domain, false, "/jaywalk");
  const auto publishers_of = [&](const char* topic, int most_looks) {
    const dds_entity_t reader =
        dds::make_reader(far_end.participant, sensor_msgs_msg_dds__LaserScan__desc, topic, dds::qos_keeping(1, false));
    dds_subscription_matched_status_t matched{};
    for (int looks = 0; looks < most_looks && matched.current_count == 0; ++looks) {
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
      dds_get_subscription_matched_status(reader, &matched);
    }
    return matched.current_count;
  };
  CHECK(publishers_of("/jaywalk/scan", 30'000) == 1);  // for ten minutes
  CHECK(publishers_of("/scan", 100) == 0);
}

TEST_CASE("the scans of a second scanner have a topic of their own") {
  LaserScan scan;
  scan.beam_count = 3;
  REQUIRE(dds::DdsTopics::passes("/scan_rear"));
  REQUIRE_FALSE(dds::DdsTopics::passes("/scanned"));
  check_comes<sensor_msgs_msg_dds__LaserScan_>(sensor_msgs_msg_dds__LaserScan__desc, "/jaywalk", "/scan_rear",
                                               exchange::laser_scan(scan, Time{}, "laser_rear"), [](const auto& told) {
                                                 CHECK(std::string(told.header_.frame_id_) == "laser_rear");
                                                 CHECK(told.ranges_._length == 3);
                                               });
}

TEST_CASE("/joint_states on DDS has both wheels, their angles and speeds") {
  WheelState wheels;
  wheels.left_rad = 1.5, wheels.right_rad = -2.5, wheels.left_radps = 0.25, wheels.right_radps = 4.0;
  check_comes<sensor_msgs_msg_dds__JointState_>(
      sensor_msgs_msg_dds__JointState__desc, "", "/joint_states",
      view::joint_states(wheels, Time{std::chrono::milliseconds(2250)}), [](const auto& told) {
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
