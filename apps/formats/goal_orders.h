#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <string_view>

#include "apps/formats/ros_robot.h"

namespace jaywalk::exchange {

/// Which of the goals that come on a topic are orders.
///
/// A node may publish its goal again and again: the same stamp and pose of the same writer are the same order, given
/// once. Where nobody sets stamps all are passed on, and the robot's program tells what is repeated (SaidGoals). A
/// message that was held up is none: what was asked for then may be unwanted now.
class GoalOrders {
 public:
  enum class Heard : std::uint8_t { kOrder, kRepeated, kLate };
  /// As long as a person waits for an answer. Clocks that differ by more make every goal late: synchronise them.
  static constexpr Duration kGood = std::chrono::seconds(2);

  /// `message`: all of it, its stamp included; `stamp`: the header's, 0 where nobody set it; `writer`: tells it from
  /// others.
  [[nodiscard]] Heard judge(std::string_view message, Time stamp, std::uint64_t writer, const Arrival& arrival);

 private:
  static constexpr std::size_t kMostWriters = 64;  ///< all are forgotten for one more
  std::map<std::uint64_t, std::string> last_;
};

}  // namespace jaywalk::exchange
