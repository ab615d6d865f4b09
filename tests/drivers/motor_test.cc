#include <cmath>

#include "drivers/motor/odrive.h"
#include "drivers/motor/vesc.h"
#include "tests/drivers/frames.h"
#include "tests/drivers/random_bytes.h"
#include "tests/support/allocation_guard.h"
#include "tests/support/catch.h"

using namespace jaywalk;
using tests::frame;

namespace {

CanFrame extended(CanFrame made) {
  made.extended = true;
  return made;
}

}  // namespace

TEST_CASE("ODrive commands of node 3 begin at 060h") {
  CHECK(odrive::set_axis_state(3, odrive::kClosedLoop) == frame(0x067, {8, 0, 0, 0}));
  CHECK(odrive::set_velocity_mode(3, true) == frame(0x06B, {2, 0, 0, 0, 2, 0, 0, 0}));
  CHECK(odrive::set_velocity_mode(3, false) == frame(0x06B, {2, 0, 0, 0, 1, 0, 0, 0}));
  // -2.5 is C0200000h: sign, 2^1, 1.25.
  CHECK(odrive::set_velocity(3, -2.5F) == frame(0x06D, {0x00, 0x00, 0x20, 0xC0, 0, 0, 0, 0}));
  CHECK(odrive::emergency_stop(3) == frame(0x062, {}));
  CHECK(odrive::clear_errors(3) == frame(0x078, {0}));
}

TEST_CASE("an ODrive heartbeat shows the watchdog error and the state") {
  const auto message = odrive::decode(frame(0x061, {0x00, 0x00, 0x00, 0x01, 1, 0, 0, 0}));
  REQUIRE(message);
  CHECK(message->node == 3);
  const auto* heartbeat = std::get_if<odrive::Heartbeat>(&message->content);
  REQUIRE(heartbeat != nullptr);
  CHECK((heartbeat->active_errors & odrive::kWatchdogExpired) != 0);
  CHECK(heartbeat->axis_state == 1);
  CHECK_FALSE(odrive::decode(frame(0x061, {0, 0, 0, 1})));
}

TEST_CASE("ODrive estimates are turns and turns a second and must be finite") {
  // 1.5 is 3FC00000h, -0.25 is BE800000h.
  const auto message = odrive::decode(frame(0x069, {0, 0, 0xC0, 0x3F, 0, 0, 0x80, 0xBE}));
  REQUIRE(message);
  const auto* estimates = std::get_if<odrive::EncoderEstimates>(&message->content);
  REQUIRE(estimates != nullptr);
  CHECK(estimates->position_turns == 1.5F);
  CHECK(estimates->velocity_turns_per_s == -0.25F);
  CHECK_FALSE(odrive::decode(frame(0x069, {0, 0, 0xC0, 0x7F, 0, 0, 0x80, 0xBE})));  // not a number
  CHECK_FALSE(odrive::decode(extended(frame(0x069, {0, 0, 0xC0, 0x3F, 0, 0, 0x80, 0xBE}))));
}

TEST_CASE("51 A to VESC 23 are the bytes that others measured") {
  CHECK(vesc::set_current(0x17, 51000) == extended(frame(0x0117, {0x00, 0x00, 0xC7, 0x38})));
  CHECK(vesc::set_erpm(0x17, -3000) == extended(frame(0x0317, {0xFF, 0xFF, 0xF4, 0x48})));  // 2^32 - 3000
  CHECK(vesc::set_brake_current(0x17, 1000) == extended(frame(0x0217, {0x00, 0x00, 0x03, 0xE8})));
}

TEST_CASE("a VESC's status tells its speed") {
  // -3000 is FFFFF448h; current and duty cycle follow.
  const auto message = vesc::decode(extended(frame(0x0904, {0xFF, 0xFF, 0xF4, 0x48, 0x00, 0xFF, 0xFE, 0x0C})));
  REQUIRE(message);
  CHECK(message->controller == 4);
  const auto* status = std::get_if<vesc::Status>(&message->content);
  REQUIRE(status != nullptr);
  CHECK(status->erpm == -3000);
}

TEST_CASE("a VESC's travel decodes to what others measured, and shorter messages are none") {
  const auto travel = vesc::decode(extended(frame(0x1B04, {0x00, 0x00, 0x00, 0x0C, 0x00, 0xEF, 0x00, 0x00})));
  REQUIRE(travel);
  REQUIRE(std::holds_alternative<vesc::Travel>(travel->content));
  CHECK(std::get<vesc::Travel>(travel->content).sixths_of_electrical_turn == 12);
  CHECK_FALSE(vesc::decode(frame(0x104, {0, 0, 0, 0, 0, 0, 0, 0})));
  CHECK_FALSE(vesc::decode(extended(frame(0x0904, {0, 0, 0, 0, 0, 0, 0}))));
  CHECK_FALSE(vesc::decode(extended(frame(0x1B04, {0, 0, 0, 0, 0}))));
}

TEST_CASE("any frame is an ODrive or VESC message with finite numbers or none without the heap") {
  tests::RandomBytes random(61);
  int of_odrive = 0;
  int of_vesc = 0;
  std::uint64_t heap_calls = 0;
  for (int k = 0; k < 200000; ++k) {
    CanFrame any;
    any.extended = random.below(2) == 0;
    any.id = static_cast<std::uint32_t>(random.below(any.extended ? 0x2000 : 0x800));
    any.size = static_cast<std::uint8_t>(random.below(9));
    for (std::uint8_t k_byte = 0; k_byte < any.size; ++k_byte) any.bytes[k_byte] = random.byte();
    const AllocationGuard guard;
    const auto from_odrive = odrive::decode(any);
    const auto from_vesc = vesc::decode(any);
    heap_calls += guard.calls();
    of_odrive += from_odrive ? 1 : 0;
    of_vesc += from_vesc ? 1 : 0;
    if (!from_odrive) continue;
    const auto* estimates = std::get_if<odrive::EncoderEstimates>(&from_odrive->content);
    if (estimates != nullptr)
      REQUIRE(std::isfinite(estimates->position_turns + estimates->velocity_turns_per_s * 0.0F));
  }
  CHECK(of_odrive > 0);
  CHECK(of_vesc > 0);
  CHECK(heap_calls == 0);
}
