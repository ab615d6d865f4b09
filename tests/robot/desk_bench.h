#pragma once
#include <string>

#include "firmware/robot/operator_desk.h"
#include "tests/drivers/hand_clock.h"

namespace jaywalk::tests {

/// A desk, and the loop behind it as far as a test tells.
struct DeskBench {
  DeskBench() {
    tell([](RunStatus&) {});
  }
  template <class Change>
  void tell(Change change) {
    status.running = status.proved = true;
    change(status);
    desk.tell(status);
  }
  void latch() {
    tell([](RunStatus& s) { s.latched = true, s.reasons = Reason::kLatched | Reason::kDrive; });
  }
  void unlatch() {
    tell([](RunStatus& s) { s.latched = false, s.reasons = Reason::kNone; });
  }

  HandClock clock;
  int restarts = 0;
  std::string restart_fails;
  bool bus_answers = true;
  OperatorDesk desk{clock, {0.25, 0.05}, [this] {
                      ++restarts;
                      if (bus_answers) tell([](RunStatus& s) { s.bus.state = CanState::kActive, s.speed_mps = 0.0; });
                      return restart_fails;
                    }};
  RunStatus status;
};

}  // namespace jaywalk::tests
