#pragma once
// ROS 2's topics on DDS, by Cyclone DDS, and the entities that both jobs of jaywalk_dds make of it.
#include <dds/dds.h>

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "apps/formats/ros_robot.h"

namespace jaywalk::dds {
/// Handle that the call `what` of DDS returned. Throws StartupError for a negative one, which is an error.
dds_entity_t checked(dds_entity_t entity, const std::string& what);

using Qos = std::unique_ptr<dds_qos_t, decltype(&dds_delete_qos)>;
/// Keeps the last `depth`; volatile.
[[nodiscard]] Qos qos_keeping(std::int32_t depth, bool reliable);

/// `topic` as ROS 2 shows it, "/scan"; on DDS it is rt/scan. Throw StartupError.
[[nodiscard]] dds_entity_t make_writer(dds_entity_t participant, const dds_topic_descriptor_t& type,
                                       const std::string& topic, const Qos& qos);
[[nodiscard]] dds_entity_t make_reader(dds_entity_t participant, const dds_topic_descriptor_t& type,
                                       const std::string& topic, const Qos& qos);

/// Arrival of a sample that was taken just now: `ours` (by the loop's clock), the wall clock's time and the sender's
/// stamp.
[[nodiscard]] exchange::Arrival arrival_of(const dds_sample_info_t& about, Time ours = kNever);

/// `use(sample, about)` for each that waits at a reader of the type T.
template <class T, class Use>
void take_all(dds_entity_t reader, Use use) {
  void* sample = nullptr;
  dds_sample_info_t about;
  while (dds_take(reader, &sample, &about, 1, 1) > 0) {
    if (about.valid_data) use(*static_cast<const T*>(sample), about);
    dds_return_loan(reader, &sample, 1);
    sample = nullptr;
  }
}

/// A stamp of a message's header.
template <class Stamp>
[[nodiscard]] Time time_of(const Stamp& stamp) {
  return Time{std::chrono::seconds(stamp.sec_) + std::chrono::nanoseconds(stamp.nanosec_)};
}

/// A pose that came, in CDR: a goal of /goal_pose, or of /initialpose the place where the robot is.
struct PoseOrder {
  bool is_place = false;
  std::string message;
};
/// Order as the control socket takes it, "goto X Y H" or "here X Y H"; empty where the pose is not in the frame map.
[[nodiscard]] std::string words_of(const PoseOrder& order);

/// Reads /goal_pose and /initialpose; of what is repeated or late nothing is an order (exchange::GoalOrders).
class PoseReader {
 public:
  explicit PoseReader(dds_entity_t participant);
  /// The newest order that came, a place before a goal.
  [[nodiscard]] std::optional<PoseOrder> take();

 private:
  template <class Message>
  std::optional<PoseOrder> newest(dds_entity_t reader);

  dds_entity_t goals_, places_;
  exchange::GoalOrders orders_;
};

/// A participant with a writer for each topic that is passed on ("/scan" is rt/scan), and, where it takes goals,
/// readers of rt/goal_pose and rt/initialpose. Reliable, the last ten; /map is kept for newcomers. Thread: one.
class DdsTopics {
 public:
  /// `space` goes before every topic that is written, "/jaywalk" say. Throws StartupError where DDS finds no network.
  DdsTopics(std::uint32_t domain, bool takes_goals, const std::string& space = "");
  ~DdsTopics();
  DdsTopics(const DdsTopics&) = delete;
  DdsTopics& operator=(const DdsTopics&) = delete;

  /// Whether publish() takes messages of this topic; "/scan_rear", of a named scanner, as well as "/scan".
  [[nodiscard]] static bool passes(const std::string& topic);
  /// `message`: CDR behind its encapsulation header. False where its bytes do not fit the topic's type: it is not sent.
  bool publish(const std::string& topic, std::string message);
  /// See PoseReader::take(); none where none are taken.
  [[nodiscard]] std::optional<PoseOrder> take_order();

 private:
  dds_entity_t participant_;
  std::string space_;
  std::optional<PoseReader> poses_;
  std::map<std::string, dds_entity_t> writers_;
};

}  // namespace jaywalk::dds
