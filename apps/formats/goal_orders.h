#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <string_view>

#include "apps/formats/ros_robot.h"

namespace jaywalk::exchange {

/// Filter of the goals on a topic: repeated and late messages are no orders.
///
/// A node may publish its goal again and again: messages of one writer with the same stamp and pose are one order.
/// Messages without a stamp are all orders here; the robot's program recognises repeated ones (SaidGoals). A late
/// message is no order: its goal may be unwanted by now.
class GoalOrders {
 public:
  enum class Heard : std::uint8_t { kOrder, kRepeated, kLate };
  /// Greatest age of an order: a person waits no longer for an answer. Clocks that differ by more make every goal late.
  static constexpr Duration kGood = std::chrono::seconds(2);

  /// Judges a message. `message`: its bytes, with the stamp; `stamp`: of its header, 0: not set; `writer`: identity of
  /// its publisher.
  [[nodiscard]] Heard judge(std::string_view message, Time stamp, std::uint64_t writer, const Arrival& arrival);

 private:
  static constexpr std::size_t kMostWriters = 64;  ///< all are forgotten for one more
  std::map<std::uint64_t, std::string> last_;
};

}  // namespace jaywalk::exchange
