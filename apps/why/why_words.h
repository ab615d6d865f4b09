#pragma once
#include <string>
#include <vector>

#include "apps/why/why_decision.h"
#include "firmware/control_loop.h"
#include "firmware/recording/tick_record.h"

namespace jaywalk {

/// What the last decision weighed.
struct Weighed {
  Resolve resolve;
  std::vector<motion::Alternative> alternatives;  ///< cheapest first; none without a decision
};

/// A moment in plain sentences, a line each: what the robot did, saw, expected, wanted, was permitted and why, and what
/// would have come of driving on.
[[nodiscard]] std::string why_words(const TickRecord& tick, const ControlLoop& loop, const RobotModel& model,
                                    const Weighed& weighed);

/// "stop_zone" as a person says it: "something stands in the way". Every reason of the set, joined by "; ".
[[nodiscard]] std::string in_words(Reason reasons);

}  // namespace jaywalk
