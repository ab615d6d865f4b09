#include "apps/dds/dds_topics.h"

#include <dds/ddsi/ddsi_cdrstream.h>
#include <dds/ddsi/q_protocol.h>
#include <ros_topics.h>  // idlc writes it

#include <array>
#include <chrono>
#include <cstdio>
#include <utility>

#include "apps/formats/ros_topics.h"
#include "apps/formats/wire_reader.h"
#include "apps/view/view_orders.h"
#include "firmware/robot/goal_order.h"
#include "hal/types/errors.h"

namespace jaywalk::dds {
namespace {
constexpr std::int32_t kDepth = 10;  ///< messages that are kept, as ROS 2 does

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

struct PassedOn {
  const char* topic;
  const dds_topic_descriptor_t* type;
  bool kept = false;  ///< for readers that come later
};
constexpr const char* name_of(exchange::RosTopicNumber number) { return exchange::kRosTopics[number].name; }
const std::array<PassedOn, 9> kPassedOn{{{name_of(exchange::kScan), &sensor_msgs_msg_dds__LaserScan__desc},
                                         {name_of(exchange::kOdom), &nav_msgs_msg_dds__Odometry__desc},
                                         {name_of(exchange::kTf), &tf2_msgs_msg_dds__TFMessage__desc},
                                         {name_of(exchange::kTfStatic), &tf2_msgs_msg_dds__TFMessage__desc, true},
                                         {name_of(exchange::kMap), &nav_msgs_msg_dds__OccupancyGrid__desc, true},
                                         {name_of(exchange::kPlan), &nav_msgs_msg_dds__Path__desc},
                                         {name_of(exchange::kTracks), &visualization_msgs_msg_dds__MarkerArray__desc},
                                         {name_of(exchange::kClock), &rosgraph_msgs_msg_dds__Clock__desc},
                                         {"/joint_states", &sensor_msgs_msg_dds__JointState__desc}}};
/// How a topic is published; null where it is not. "/scan_rear", the topic of a named scanner, is published as "/scan".
const PassedOn* passed_on(const std::string& topic) {
  for (const PassedOn& one : kPassedOn)
    if (topic == one.topic) return &one;
  return topic.starts_with("/scan_") ? passed_on(name_of(exchange::kScan)) : nullptr;
}

constexpr std::size_t kEncapsulation = 4;

Qos qos_of(bool kept) {
  Qos qos = qos_keeping(kept ? 1 : kDepth, true);
  if (kept) dds_qset_durability(qos.get(), DDS_DURABILITY_TRANSIENT_LOCAL);
  return qos;
}

}  // namespace

exchange::Arrival arrival_of(const dds_sample_info_t& about, Time ours) {
  return {ours, Time(std::chrono::system_clock::now().time_since_epoch()), Time(Duration(about.source_timestamp))};
}

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
  return pose ? (order.is_place ? "here " : "goto ") + jaywalk::words_of(*pose) : "";
}

PoseReader::PoseReader(dds_entity_t participant)
    : goals_(
          make_reader(participant, geometry_msgs_msg_dds__PoseStamped__desc, "/goal_pose", qos_keeping(kDepth, true))),
      places_(make_reader(participant, geometry_msgs_msg_dds__PoseWithCovarianceStamped__desc, "/initialpose",
                          qos_keeping(kDepth, true))) {}

template <class Message>
std::optional<PoseOrder> PoseReader::newest(dds_entity_t reader) {
  std::optional<PoseOrder> newest;
  take_all<Message>(reader, [&](const Message& pose, const dds_sample_info_t& about) {
    using Heard = exchange::GoalOrders::Heard;
    const Time stamped = time_of(pose.header_.stamp_);
    std::string message = in_cdr(pose);
    const Heard heard = orders_.judge(message, stamped, about.publication_handle, arrival_of(about));
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

DdsTopics::DdsTopics(std::uint32_t domain, bool takes_goals, const std::string& space)
    : participant_(checked(dds_create_participant(domain, nullptr, nullptr), "no participant")), space_(space) {
  for (const PassedOn& one : kPassedOn)
    writers_[one.topic] = make_writer(participant_, *one.type, space + one.topic, qos_of(one.kept));
  if (takes_goals) poses_.emplace(participant_);
}

DdsTopics::~DdsTopics() { dds_delete(participant_); }

bool DdsTopics::passes(const std::string& topic) { return passed_on(topic) != nullptr; }

bool DdsTopics::publish(const std::string& topic, std::string message) {
  const PassedOn* const passed = passed_on(topic);
  if (passed == nullptr || message.size() < kEncapsulation) return false;
  char* const body = message.data() + kEncapsulation;
  const auto size = static_cast<std::uint32_t>(message.size() - kEncapsulation);
  std::uint32_t read = 0;
  if (dds_stream_normalize_data(body, &read, size, false, CDR_ENC_VERSION_1, passed->type->m_ops) == nullptr)
    return false;
  const auto freed = [passed](void* sample) { dds_sample_free(sample, passed->type, DDS_FREE_ALL); };
  const std::unique_ptr<void, decltype(freed)> sample(dds_alloc(passed->type->m_size), freed);
  dds_istream_t in;
  dds_istream_init(&in, size, body, CDR_ENC_VERSION_1);
  (void)dds_stream_read(&in, static_cast<char*>(sample.get()), passed->type->m_ops);
  const auto [writer, is_new] = writers_.try_emplace(topic);
  if (is_new) writer->second = make_writer(participant_, *passed->type, space_ + topic, qos_of(passed->kept));
  return dds_write(writer->second, sample.get()) == DDS_RETCODE_OK;
}

std::optional<PoseOrder> DdsTopics::take_order() { return poses_ ? poses_->take() : std::nullopt; }

}  // namespace jaywalk::dds
