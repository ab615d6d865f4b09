#include "apps/dds/dds_topics.h"

#include <dds/ddsi/ddsi_cdrstream.h>
#include <dds/ddsi/q_protocol.h>
#include <ros_topics.h>  // idlc writes it

#include <array>
#include <memory>

#include "apps/formats/ros_topics.h"

namespace jaywalk::dds {
namespace {

struct PassedOn {
  exchange::RosTopicNumber number;
  const dds_topic_descriptor_t* type;
  bool kept = false;  ///< for readers that come later
  [[nodiscard]] const char* topic() const { return exchange::kRosTopics[number].name; }
};
const std::array<PassedOn, 7> kPassedOn{{{exchange::kScan, &sensor_msgs_msg_dds__LaserScan__desc},
                                         {exchange::kOdom, &nav_msgs_msg_dds__Odometry__desc},
                                         {exchange::kTf, &tf2_msgs_msg_dds__TFMessage__desc},
                                         {exchange::kTfStatic, &tf2_msgs_msg_dds__TFMessage__desc, true},
                                         {exchange::kMap, &nav_msgs_msg_dds__OccupancyGrid__desc, true},
                                         {exchange::kPlan, &nav_msgs_msg_dds__Path__desc},
                                         {exchange::kTracks, &visualization_msgs_msg_dds__MarkerArray__desc}}};
/// How a topic is published; null where it is not. "/scan_rear", the topic of a named scanner, is published as "/scan".
const PassedOn* passed_on(const std::string& topic) {
  for (const PassedOn& one : kPassedOn)
    if (topic == one.topic()) return &one;
  return topic.starts_with("/scan_") ? passed_on(exchange::kRosTopics[exchange::kScan].name) : nullptr;
}

constexpr std::size_t kEncapsulation = 4;
constexpr std::int32_t kDepth = 10;

Qos qos_of(bool kept) {
  Qos qos = qos_keeping(kept ? 1 : kDepth, true);
  if (kept) dds_qset_durability(qos.get(), DDS_DURABILITY_TRANSIENT_LOCAL);
  return qos;
}

}  // namespace

DdsTopics::DdsTopics(std::uint32_t domain, bool takes_goals, const std::string& space)
    : participant_(checked(dds_create_participant(domain, nullptr, nullptr), "no participant")), space_(space) {
  for (const PassedOn& one : kPassedOn)
    writers_[one.topic()] = make_writer(participant_, *one.type, space + one.topic(), qos_of(one.kept));
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
