#include "apps/formats/goal_orders.h"

#include <utility>

namespace jaywalk::exchange {
namespace {

bool is_far_from(Time stamp, Time wall) {
  if (stamp <= Time{} || wall <= Time{}) return false;
  return stamp > wall + GoalOrders::kGood || stamp < wall - GoalOrders::kGood;
}

}  // namespace

GoalOrders::Heard GoalOrders::judge(std::string_view message, Time stamp, std::uint64_t writer,
                                    const Arrival& arrival) {
  if (last_.size() == kMostWriters && !last_.contains(writer)) last_.clear();
  std::string& last = last_[writer];
  if (stamp > Time{} && last == message) return Heard::kRepeated;
  last = message;
  const bool late = is_far_from(stamp, arrival.wall) || is_far_from(arrival.written, arrival.wall);
  return late ? Heard::kLate : Heard::kOrder;
}

}  // namespace jaywalk::exchange
