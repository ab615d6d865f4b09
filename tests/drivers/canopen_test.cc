#include <vector>

#include "drivers/canopen/cia402.h"
#include "tests/drivers/frames.h"
#include "tests/drivers/random_bytes.h"
#include "tests/support/catch.h"

using namespace jaywalk;
using namespace jaywalk::canopen;
using tests::frame;

namespace {

PdoMapping mapping_of(std::initializer_list<MappedObject> objects) {
  PdoMapping mapping;
  for (const MappedObject& object : objects) REQUIRE(mapping.push_back(object));
  return mapping;
}

}  // namespace

TEST_CASE("network management, SYNC and heartbeat have the standard's bytes") {
  CHECK(nmt_frame(NmtCommand::kStart, 5) == frame(0x000, {0x01, 0x05}));
  CHECK(nmt_frame(NmtCommand::kResetNode, 0) == frame(0x000, {0x81, 0x00}));
  CHECK(sync_frame() == frame(0x080, {}));
  CHECK(heartbeat_frame(127, NmtState::kOperational) == frame(0x77F, {0x05}));
}

TEST_CASE("a heartbeat names its node and state") {
  const auto beat = decode_heartbeat(frame(0x705, {0x7F}));
  REQUIRE(beat);
  CHECK(beat->node == 5);
  CHECK(beat->state == NmtState::kPreOperational);
  CHECK_FALSE(decode_heartbeat(frame(0x705, {0x06})));                 // no such state
  CHECK(decode_heartbeat(frame(0x705, {0x05, 0, 0, 0, 0, 0, 0, 0})));  // some drives fill it up
  CHECK_FALSE(decode_heartbeat(frame(0x705, {})));
  CHECK_FALSE(decode_heartbeat(frame(0x700, {0x05})));  // node 0
  CHECK_FALSE(decode_heartbeat(frame(0x780, {0x05})));  // node 128
}

TEST_CASE("an emergency message tells node, code and class") {
  const auto emergency = decode_emergency(frame(0x085, {0x30, 0x81, 0x11, 1, 2, 3, 4, 5}));
  REQUIRE(emergency);
  CHECK(emergency->node == 5);
  CHECK(emergency->error_code == 0x8130);
  CHECK(emergency_class(emergency->error_code) == "monitoring");
  CHECK_FALSE(decode_emergency(sync_frame()));
  CHECK_FALSE(decode_emergency(frame(0x085, {0x30, 0x81})));
}

TEST_CASE("node 1 watched for 100 ms is entry 00010064h") { CHECK(heartbeat_consumer_entry(1, 100) == 0x00010064); }

TEST_CASE("controlword and target velocity are packed least significant byte first") {
  const PdoMapping mapping = mapping_of({{kControlword, 2}, {kTargetVelocity, 4}});
  CHECK(mapping[0].mapping_word() == 0x60400010);
  CHECK(mapping[1].mapping_word() == 0x60FF0020);
  // -1000 is FFFFFC18h.
  const std::vector<std::uint32_t> values{0x000F, static_cast<std::uint32_t>(-1000)};
  const auto packed = pack(mapping, 0x205, values);
  REQUIRE(packed);
  CHECK(*packed == frame(0x205, {0x0F, 0x00, 0x18, 0xFC, 0xFF, 0xFF}));
  const auto unpacked = unpack(mapping, *packed);
  REQUIRE(unpacked);
  CHECK((*unpacked)[0] == 0x000F);
  CHECK(static_cast<std::int32_t>((*unpacked)[1]) == -1000);
}

TEST_CASE("a process frame that is too short for its mapping is refused and a longer one taken") {
  const PdoMapping mapping = mapping_of({{kStatusword, 2}, {kVelocity, 4}});
  CHECK_FALSE(unpack(mapping, frame(0x185, {0x37, 0x02, 0, 0, 0})));
  CHECK(unpack(mapping, frame(0x185, {0x37, 0x02, 0, 0, 0, 0, 9})));
  const PdoMapping fat = mapping_of({{kVelocity, 4}, {kPosition, 4}, {kStatusword, 2}});
  CHECK_FALSE(pack(fat, 0x205, std::vector<std::uint32_t>{1, 2, 3}));
  CHECK_FALSE(pack(mapping, 0x205, std::vector<std::uint32_t>{1}));
}

TEST_CASE("a PDO is switched off, mapped and switched on in that order") {
  ObjectWrites writes;
  REQUIRE(append_setup({0x1400, 0x1600, 0x205, 1, mapping_of({{kControlword, 2}, {kTargetVelocity, 4}})}, writes));
  const std::vector<ObjectWrite> wanted{{{0x1400, 1}, 0x80000205, 4}, {{0x1600, 0}, 0, 1}, {{0x1600, 1}, 0x60400010, 4},
                                        {{0x1600, 2}, 0x60FF0020, 4}, {{0x1600, 0}, 2, 1}, {{0x1400, 2}, 1, 1},
                                        {{0x1400, 1}, 0x00000205, 4}};
  CHECK(std::vector<ObjectWrite>(writes.begin(), writes.end()) == wanted);
}

TEST_CASE("a list of writes that is full says so") {
  ObjectWrites writes;
  const PdoSetup setup{0x1400, 0x1600, 0x205, 1, mapping_of({{kControlword, 2}, {kTargetVelocity, 4}})};
  for (int k = 0; k < 9; ++k) CHECK(append_setup(setup, writes));  // 9 times 7 are 63 of 64
  CHECK_FALSE(append_setup(setup, writes));
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
  CHECK(name(state_of(0x0237)) == "operation enabled");
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

TEST_CASE("any frame is a service message or none") {
  tests::RandomBytes random(3);
  int beats = 0;
  int emergencies = 0;
  const PdoMapping mapping = mapping_of({{kStatusword, 2}, {kVelocity, 4}});
  for (int k = 0; k < 200000; ++k) {
    CanFrame any;
    any.id = static_cast<std::uint32_t>(random.below(0x800));
    any.size = static_cast<std::uint8_t>(random.below(9));
    for (auto& byte : any.bytes) byte = random.byte();
    if (const auto beat = decode_heartbeat(any)) {
      ++beats;
      REQUIRE((beat->node >= 1 && beat->node <= 127));
    }
    if (const auto emergency = decode_emergency(any)) {
      ++emergencies;
      REQUIRE(any.id == 0x080U + emergency->node);
    }
    REQUIRE(unpack(mapping, any).has_value() == (any.size >= 6));
  }
  CHECK(beats > 0);
  CHECK(emergencies > 0);
}
