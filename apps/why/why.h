#pragma once
// `jaywalk why`: one moment of a recording in words, tables and a picture.
#include <string>
#include <vector>

#include "apps/report/picture/scene.h"
#include "firmware/control_loop.h"
#include "firmware/recording/tick_record.h"
#include "planner/motion/goal_rollouts.h"

namespace jaywalk {

/// A decision that was gone on with since: what it proposed, and when it was made.
struct Resolve {
  motion::Proposal proposal = motion::Proposal::kFollow;
  Time at = kNever;

  /// After each tick.
  void note(const motion::Decision& decision) {
    if (decision.trajectory.proposal != motion::Proposal::kLast && decision.at != at)
      *this = {decision.trajectory.proposal, decision.at};
  }
};

/// The decision as a picture shows it. Throws nothing but std::bad_alloc.
[[nodiscard]] DecisionScene scene_of(const motion::GoalRollouts& motion,
                                     const std::vector<motion::Alternative>& alternatives);

/// A table of everything that a decision weighed, cheapest first: what it proposes, what it costs term by term (s),
/// where it ends. Throws StartupError when the file cannot be made.
void write_alternatives(const std::vector<motion::Alternative>& alternatives, const std::string& file);

/// What the last decision weighed.
struct Weighed {
  Resolve resolve;
  std::vector<motion::Alternative> alternatives;  ///< cheapest first; none without a decision
};

/// A moment in plain sentences, a line each: what the robot did, saw, expected, wanted, was permitted and why, and what
/// would have come of driving on.
[[nodiscard]] std::string why_words(const TickRecord& tick, const ControlLoop& loop, const RobotModel& model,
                                    const Weighed& weighed);

}  // namespace jaywalk
