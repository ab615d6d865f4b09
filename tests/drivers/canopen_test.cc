#include <chrono>
#include <vector>

#include "drivers/canopen/cia402.h"
#include "drivers/canopen/drive_base.h"
#include "drivers/wired_drive.h"
#include "tests/drivers/frames.h"
#include "tests/support/catch.h"

using namespace jaywalk;
using namespace jaywalk::canopen;
using tests::frame;

TEST_CASE("network management, SYNC and heartbeat have the standard's bytes") {
  CHECK(nmt_frame(NmtCommand::kStart, 5) == frame(0x000, {0x01, 0x05}));
  CHECK(nmt_frame(NmtCommand::kPreOperational, 0) == frame(0x000, {0x80, 0x00}));
  CHECK(sync_frame() == frame(0x080, {}));
  CHECK(heartbeat_frame(127, NmtState::kOperational) == frame(0x77F, {0x05}));
}

TEST_CASE("a heartbeat names its node and state") {
  CHECK(heartbeat_in(frame(0x705, {0x7F}), 5) == NmtState::kPreOperational);
  CHECK_FALSE(heartbeat_in(frame(0x705, {0x7F}), 6));
  CHECK_FALSE(heartbeat_in(frame(0x705, {0x06}), 5));                 // no such state
  CHECK(heartbeat_in(frame(0x705, {0x05, 0, 0, 0, 0, 0, 0, 0}), 5));  // some drives fill it up
  CHECK_FALSE(heartbeat_in(frame(0x705, {}), 5));
}

TEST_CASE("an emergency message tells node and code, and its class is named") {
  CHECK(emergency_in(frame(0x085, {0x30, 0x81, 0x11, 1, 2, 3, 4, 5}), 5) == 0x8130);
  CHECK_FALSE(emergency_in(frame(0x085, {0x30, 0x81, 0x11, 1, 2, 3, 4, 5}), 6));
  CHECK(describe({DriveFaultKind::kEmergency, 5, 0x8131}) == "node 5: emergency 8131h (monitoring)");
  CHECK_FALSE(emergency_in(sync_frame(), 5));
  CHECK_FALSE(emergency_in(frame(0x085, {0x30, 0x81}), 5));
}

TEST_CASE("controlword and target velocity are packed least significant byte first") {
  // -1000 is FFFFFC18h.
  CHECK(command_frame(5, 0x000F, -1000) == frame(0x205, {0x0F, 0x00, 0x18, 0xFC, 0xFF, 0xFF}));
}

TEST_CASE("a process frame that is too short for its mapping is refused and a longer one taken") {
  WheelAxis axis({.node = 5, .per_rad = 100.0}, std::chrono::milliseconds(50));
  axis.take({frame(0x185, {0x37, 0x02, 0x18, 0xFC, 0xFF, 0xFF}), Time{}});
  CHECK_FALSE(axis.is_enabled());
  CanFrame request = frame(0x185, {});
  request.remote = true;
  request.size = 8;
  axis.take({request, Time{}});
  CHECK(axis.feedback().stamp == kNever);
  axis.take({frame(0x185, {0x37, 0x02, 0x18, 0xFC, 0xFF, 0xFF, 3, 9}), Time{}});
  CHECK(axis.follows_speeds());
  CHECK(axis.feedback().speed_radps == -10.0);  // -1000 counts/s
  axis.take({frame(0x285, {1, 2, 3}), Time{}});
  CHECK_FALSE(axis.is_complete());
  axis.take({frame(0x285, {1, 2, 3, 4, 5}), Time{}});
  CHECK(axis.is_complete());
}

TEST_CASE("a PDO is switched off, mapped and switched on in that order") {
  const ArmingProof::Lines items = proof_items(5, {});
  const std::vector<ObjectWrite> wanted{{{0x1400, 1}, 0x80000205, 4}, {{0x1600, 0}, 0, 1}, {{0x1600, 1}, 0x60400010, 4},
                                        {{0x1600, 2}, 0x60FF0020, 4}, {{0x1600, 0}, 2, 1}, {{0x1400, 2}, 1, 1},
                                        {{0x1400, 1}, 0x00000205, 4}};
  const std::size_t first = behaviour_items({}).size();
  REQUIRE(items.size() >= first + wanted.size());
  for (std::size_t k = 0; k < wanted.size(); ++k) {
    CHECK(items[first + k].wanted == wanted[k]);
    const bool is_identifier = wanted[k].address == ObjectAddress{0x1400, 1};
    CHECK((items[first + k].demand == ProofDemand::kIdentifier) == is_identifier);
  }
}

TEST_CASE("statuswords of the standard's table name their states") {
  CHECK(state_of(0x0000) == DriveState::kNotReady);
  CHECK(state_of(0x0250) == DriveState::kSwitchOnDisabled);
  CHECK(state_of(0x0231) == DriveState::kReadyToSwitchOn);
  CHECK(state_of(0x0233) == DriveState::kSwitchedOn);
  CHECK(state_of(0x0237) == DriveState::kOperationEnabled);
  CHECK(state_of(0x0217) == DriveState::kQuickStopActive);
  CHECK(state_of(0x020F) == DriveState::kFaultReactionActive);
  CHECK(state_of(0x0218) == DriveState::kFault);
  CHECK(state_of(0x0201) == DriveState::kUnknown);  // ready, yet with the quick stop bit down: not in the table
}

TEST_CASE("a drive is enabled in three steps and never out of a fault or a quick stop by itself") {
  const auto towards = [](DriveState state) { return controlword_towards(DriveGoal::kEnabled, state, false); };
  CHECK(towards(DriveState::kSwitchOnDisabled) == 0x06);
  CHECK(towards(DriveState::kReadyToSwitchOn) == 0x07);
  CHECK(towards(DriveState::kSwitchedOn) == 0x0F);
  CHECK(towards(DriveState::kOperationEnabled) == 0x0F);
  CHECK(towards(DriveState::kQuickStopActive) == 0x00);
  CHECK(towards(DriveState::kFault) == 0x00);
  CHECK(towards(DriveState::kUnknown) == 0x00);
  CHECK(controlword_towards(DriveGoal::kEnabled, DriveState::kFault, true) == 0x80);
}

TEST_CASE("a quick stop is asked for in every state but a fault, known or not") {
  CHECK(controlword_towards(DriveGoal::kQuickStop, DriveState::kOperationEnabled, false) == 0x02);
  CHECK(controlword_towards(DriveGoal::kQuickStop, DriveState::kQuickStopActive, false) == 0x02);
  CHECK(controlword_towards(DriveGoal::kQuickStop, DriveState::kSwitchedOn, false) == 0x02);
  CHECK(controlword_towards(DriveGoal::kQuickStop, DriveState::kUnknown, false) == 0x02);
  CHECK(controlword_towards(DriveGoal::kQuickStop, DriveState::kFault, false) == 0x00);
  CHECK(controlword_towards(DriveGoal::kOff, DriveState::kOperationEnabled, false) == 0x00);
}

TEST_CASE("no statusword enables a drive that is not switched on") {
  for (std::uint32_t word = 0; word <= 0xFFFF; ++word) {
    const DriveState state = state_of(static_cast<std::uint16_t>(word));
    if (controlword_towards(DriveGoal::kEnabled, state, true) != 0x0F) continue;
    REQUIRE((word & 0x2B) == 0x23);  // ready, switched on, no fault, no quick stop
  }
}
