#include "apps/dds/dds_topics.h"

#include <dds/ddsi/ddsi_cdrstream.h>
#include <dds/ddsi/q_protocol.h>
#include <ros_topics.h>  // idlc writes it

#include <array>
#include <memory>

#include "apps/formats/cdr_writer.h"
#include "apps/formats/ros_topics.h"
#include "hal/types/errors.h"

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
constexpr std::size_t kEncapsulation = 4;
constexpr std::int32_t kDepth = 10;

/// Negative codes are DDS's errors.
dds_entity_t checked(dds_entity_t entity, const std::string& what) {
  if (entity >= 0) return entity;
  throw StartupError("DDS: " + what + ": " + dds_strretcode(-entity),
                     "set CYCLONEDDS_URI to a network interface that is up");
}

std::unique_ptr<dds_qos_t, decltype(&dds_delete_qos)> qos_of(bool kept) {
  std::unique_ptr<dds_qos_t, decltype(&dds_delete_qos)> qos(dds_create_qos(), &dds_delete_qos);
  dds_qset_reliability(qos.get(), DDS_RELIABILITY_RELIABLE, DDS_MSECS(0));  // a reader that hangs holds nothing up
  dds_qset_history(qos.get(), DDS_HISTORY_KEEP_LAST, kept ? 1 : kDepth);
  dds_qset_durability(qos.get(), kept ? DDS_DURABILITY_TRANSIENT_LOCAL : DDS_DURABILITY_VOLATILE);
  return qos;
}

std::string in_cdr(const geometry_msgs_msg_dds__PoseStamped_& goal) {
  exchange::CdrWriter out;
  const auto& at = goal.pose_.position_;
  const auto& turned = goal.pose_.orientation_;
  out.i32(goal.header_.stamp_.sec_).u32(goal.header_.stamp_.nanosec_).text(goal.header_.frame_id_);
  out.f64(at.x_).f64(at.y_).f64(at.z_).f64(turned.x_).f64(turned.y_).f64(turned.z_).f64(turned.w_);
  return out.message();
}

}  // namespace

DdsTopics::DdsTopics(std::uint32_t domain, bool takes_goals)
    : participant_(checked(dds_create_participant(domain, nullptr, nullptr), "no participant")) {
  for (const PassedOn& one : kPassedOn) {
    const auto qos = qos_of(one.kept);
    const std::string name = "rt" + std::string(one.topic());
    const dds_entity_t topic = checked(dds_create_topic(participant_, one.type, name.c_str(), nullptr, nullptr), name);
    writers_[one.topic()] = checked(dds_create_writer(participant_, topic, qos.get(), nullptr), name);
  }
  if (!takes_goals) return;
  const dds_entity_t topic = checked(
      dds_create_topic(participant_, &geometry_msgs_msg_dds__PoseStamped__desc, "rt/goal_pose", nullptr, nullptr),
      "rt/goal_pose");
  goals_ = checked(dds_create_reader(participant_, topic, qos_of(false).get(), nullptr), "rt/goal_pose");
}

DdsTopics::~DdsTopics() { dds_delete(participant_); }

std::set<std::string> DdsTopics::topics() {
  std::set<std::string> all;
  for (const PassedOn& one : kPassedOn) all.insert(one.topic());
  return all;
}

bool DdsTopics::publish(const std::string& topic, std::string message) {
  const PassedOn* passed = nullptr;
  for (const PassedOn& one : kPassedOn)
    if (topic == one.topic()) passed = &one;
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
  return dds_write(writers_.at(topic), sample.get()) == DDS_RETCODE_OK;
}

std::optional<std::string> DdsTopics::take_goal() {
  std::optional<std::string> newest;
  void* sample = nullptr;
  dds_sample_info_t about;
  while (goals_ && dds_take(*goals_, &sample, &about, 1, 1) > 0) {
    if (about.valid_data) newest = in_cdr(*static_cast<const geometry_msgs_msg_dds__PoseStamped_*>(sample));
    dds_return_loan(*goals_, &sample, 1);
    sample = nullptr;
  }
  return newest;
}

}  // namespace jaywalk::dds
