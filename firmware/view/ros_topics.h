#pragma once
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "firmware/view/foxglove_session.h"
#include "firmware/view/view_snapshot.h"
#include "hal/types/robot_model.h"

namespace jaywalk::view {

/// A run's topics as ROS 2's messages, those of the MCAP export (docs/outputs.md), for subscribers of the live stream.
/// Each message is made only where its channel is wanted. Thread: the one that shows snapshots.
class RosTopics {
 public:
  using Push = std::function<void(std::size_t channel, Time stamp, std::string message)>;

  /// Numbered as they stand here.
  [[nodiscard]] static std::vector<FoxgloveChannel> channels();

  explicit RosTopics(Push push) : push_(std::move(push)) {}

  /// `wanted`: a bit a channel. A channel that was not wanted before is told whatever it last said.
  void add(const ViewSnapshot& snapshot, const RobotModel& model, std::uint32_t wanted);
  /// Whether the map is due: every kMapEvery.
  [[nodiscard]] bool is_map_due(Time now, std::uint32_t wanted) const;
  void add_map(const EvidenceMap& map, Time now);

 private:
  void forget(std::uint32_t channels);
  void add_scan(const ViewSnapshot& snapshot, std::uint32_t wanted);
  void add_goal(const TickRecord& t, std::uint32_t wanted);

  Push push_;
  std::uint32_t wanted_ = 0;  ///< last time
  std::uint32_t scan_seen_ = 0, plan_seen_ = 0;
  OperatorInput goal_seen_;
  Time mapped_ = kNever, told_ = kNever;
};

}  // namespace jaywalk::view
