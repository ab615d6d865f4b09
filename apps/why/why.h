#pragma once
// `jaywalk why`: one moment of a recording in words, tables and a picture.
#include <string>
#include <vector>

#include "apps/report/picture/scene.h"
#include "apps/why/recorded_run.h"
#include "planner/motion/goal_rollouts.h"

namespace jaywalk {

/// A decision that was gone on with since.
struct Resolve {
  motion::Proposal proposal = motion::Proposal::kFollow;
  Time at = kNever;
};

/// The decision as a picture shows it. Throws nothing but std::bad_alloc.
[[nodiscard]] DecisionScene scene_of(const motion::GoalRollouts& motion,
                                     const std::vector<motion::Alternative>& alternatives);

/// A table of all that a decision weighed, in the order given. Throws StartupError when the file cannot be made.
void write_alternatives(const std::vector<motion::Alternative>& alternatives, const std::string& file);

/// What the last decision weighed.
struct Weighed {
  Resolve resolve;
  std::vector<motion::Alternative> alternatives;  ///< cheapest first; none without a decision
};

/// A moment in plain sentences, a line each: what the robot did, saw, expected, wanted, was permitted and why, and what
/// would have come of driving on.
[[nodiscard]] std::string why_words(const RelivedRun& run, const Weighed& weighed);

}  // namespace jaywalk
