#pragma once
// ROS 2's topics on DDS, by Cyclone DDS.
#include <map>
#include <optional>
#include <string>

#include "apps/dds/dds_entities.h"

namespace jaywalk::dds {

/// A participant with a writer for each topic that is passed on ("/scan" is rt/scan, as ROS 2 names it), and, where it
/// takes goals, readers of rt/goal_pose and rt/initialpose. Reliable, the last ten; /map is kept for newcomers. Thread:
/// one.
class DdsTopics {
 public:
  /// `space` goes before every topic that is written, "/jaywalk" say. Throws StartupError where DDS finds no network it
  /// can use.
  DdsTopics(std::uint32_t domain, bool takes_goals, const std::string& space = "");
  ~DdsTopics();
  DdsTopics(const DdsTopics&) = delete;
  DdsTopics& operator=(const DdsTopics&) = delete;

  /// Whether publish() takes messages of this topic. It takes "/scan" and also the scan of a named scanner,
  /// "/scan_rear".
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
