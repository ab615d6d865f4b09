#include "firmware/robot/operator_desk.h"
#include "hal/types/errors.h"
#include "tests/support/catch.h"

using namespace jaywalk;

TEST_CASE("a dead man whose link may die unnoticed is refused at start with what to do about it") {
  panel::JoystickState state;
  state.connected = state.needs_renewal = true;
  PanelWiring wiring{.joystick = {.path = "/dev/input/pad"}};
  try {
    refuse_unrenewed(state, wiring);
    FAIL("not refused");
  } catch (const StartupError& error) {
    CHECK(
        std::string(error.what()) ==
        "/dev/input/pad: is on Bluetooth, whose link may die with the dead man held; give [panel] dead_man_renew_s, 2 "
        "say, or use a cable");
  }
  wiring.needs_dead_man = false;
  CHECK_NOTHROW(refuse_unrenewed(state, wiring));
  state.needs_renewal = false;
  wiring.needs_dead_man = true;
  CHECK_NOTHROW(refuse_unrenewed(state, wiring));
}
