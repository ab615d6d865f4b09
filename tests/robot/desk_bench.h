#pragma once
#include <string>

#include "firmware/robot/operator_desk.h"
#include "tests/drivers/hand_clock.h"

namespace jaywalk::tests {

/// A desk, and the loop behind it as far as a test tells.
struct DeskBench {
  explicit DeskBench(const GoalRules& rules = {0.25, 0.05}) : goal_rules(rules) {
    tell([](RunStatus&) {});
  }
  template <class Change>
  void tell(Change change) {
    status.running = status.proved = true;
    change(status);
    desk.tell(status);
  }
  /// Takes a goal, which is the loop's then.
  bool takes(const std::string& goal) { return desk.obey(goal) == "going\n" && desk.latest().has_goal; }
  void latch() {
    tell([](RunStatus& s) { s.latched = true, s.reasons = Reason::kLatched | Reason::kDrive; });
  }
  void unlatch() {
    tell([](RunStatus& s) { s.latched = false, s.reasons = Reason::kNone; });
  }

  HandClock clock;
  GoalRules goal_rules;
  int restarts = 0;
  std::string restart_fails;
  bool bus_answers = true;
  OperatorDesk desk{clock, goal_rules, [this] {
                      ++restarts;
                      if (bus_answers) tell([](RunStatus& s) { s.bus.state = CanState::kActive, s.speed_mps = 0.0; });
                      return restart_fails;
                    }};
  RunStatus status;
};

}  // namespace jaywalk::tests
