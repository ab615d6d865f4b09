#include "apps/dds/dds_entities.h"

#include <ros_topics.h>  // idlc writes it

#include <chrono>
#include <cstdio>
#include <utility>

#include "apps/formats/wire_reader.h"
#include "apps/view/goal_message.h"
#include "firmware/robot/goal_order.h"
#include "hal/types/errors.h"

namespace jaywalk::dds {
namespace {

constexpr std::int32_t kPoseDepth = 10;

dds_entity_t make_topic(dds_entity_t participant, const dds_topic_descriptor_t& type, const std::string& topic) {
  return checked(dds_create_topic(participant, &type, ("rt" + topic).c_str(), nullptr, nullptr), topic);
}

const geometry_msgs_msg_dds__Pose_& pose_in(const geometry_msgs_msg_dds__PoseStamped_& goal) { return goal.pose_; }
const geometry_msgs_msg_dds__Pose_& pose_in(const geometry_msgs_msg_dds__PoseWithCovarianceStamped_& place) {
  return place.pose_.pose_;
}

/// Header and pose.
template <class Message>
std::string in_cdr(const Message& message) {
  exchange::CdrWriter out;
  const auto& [at, turned] = pose_in(message);
  out.i32(message.header_.stamp_.sec_).u32(message.header_.stamp_.nanosec_).text(message.header_.frame_id_);
  out.f64(at.x_).f64(at.y_).f64(at.z_).f64(turned.x_).f64(turned.y_).f64(turned.z_).f64(turned.w_);
  return out.message();
}

}  // namespace

Time wall_time() { return Time(std::chrono::system_clock::now().time_since_epoch()); }

dds_entity_t checked(dds_entity_t entity, const std::string& what) {
  if (entity >= 0) return entity;
  throw StartupError("DDS: " + what + ": " + dds_strretcode(-entity),
                     "set CYCLONEDDS_URI to a network interface that is up");
}

Qos qos_keeping(std::int32_t depth, bool reliable) {
  Qos qos(dds_create_qos(), &dds_delete_qos);
  // A reader that hangs holds nothing up.
  dds_qset_reliability(qos.get(), reliable ? DDS_RELIABILITY_RELIABLE : DDS_RELIABILITY_BEST_EFFORT, DDS_MSECS(0));
  dds_qset_history(qos.get(), DDS_HISTORY_KEEP_LAST, depth);
  dds_qset_durability(qos.get(), DDS_DURABILITY_VOLATILE);
  return qos;
}

dds_entity_t make_writer(dds_entity_t participant, const dds_topic_descriptor_t& type, const std::string& topic,
                         const Qos& qos) {
  return checked(dds_create_writer(participant, make_topic(participant, type, topic), qos.get(), nullptr), topic);
}

dds_entity_t make_reader(dds_entity_t participant, const dds_topic_descriptor_t& type, const std::string& topic,
                         const Qos& qos) {
  return checked(dds_create_reader(participant, make_topic(participant, type, topic), qos.get(), nullptr), topic);
}

std::string words_of(const PoseOrder& order) {
  const auto pose = view::goal_from_cdr(order.message);
  if (!pose) return "";
  return (order.is_place ? "here " : "goto ") + jaywalk::words_of(GoalOrder{pose->goal_in_map, pose->heading_rad});
}

PoseReader::PoseReader(dds_entity_t participant)
    : goals_(make_reader(participant, geometry_msgs_msg_dds__PoseStamped__desc, "/goal_pose",
                         qos_keeping(kPoseDepth, true))),
      places_(make_reader(participant, geometry_msgs_msg_dds__PoseWithCovarianceStamped__desc, "/initialpose",
                          qos_keeping(kPoseDepth, true))) {}

template <class Message>
std::optional<PoseOrder> PoseReader::newest(dds_entity_t reader) {
  std::optional<PoseOrder> newest;
  take_all<Message>(reader, [&](const Message& pose, const dds_sample_info_t& about) {
    using Heard = exchange::GoalOrders::Heard;
    const auto& stamp = pose.header_.stamp_;
    const Time stamped{std::chrono::seconds(stamp.sec_) + std::chrono::nanoseconds(stamp.nanosec_)};
    std::string message = in_cdr(pose);
    const Heard heard =
        orders_.judge(message, stamped, about.publication_handle, {kNever, wall_time(), written(about)});
    if (heard == Heard::kOrder) newest = {.is_place = reader == places_, .message = std::move(message)};
    if (heard == Heard::kLate)
      std::fputs("jaywalk_dds: a pose is not taken: it comes late, or clocks differ: synchronise them\n", stderr);
  });
  return newest;
}

std::optional<PoseOrder> PoseReader::take() {
  const auto place = newest<geometry_msgs_msg_dds__PoseWithCovarianceStamped_>(places_);
  return place ? place : newest<geometry_msgs_msg_dds__PoseStamped_>(goals_);
}

}  // namespace jaywalk::dds
