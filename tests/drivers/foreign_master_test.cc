// A second program that commands the same drives: refused at arming, a latched fault at once later (SAFETY 16).
#include <chrono>
#include <vector>

#include "tests/drivers/frames.h"
#include "tests/drivers/odrive_bench.h"
#include "tests/drivers/vesc_bench.h"

using namespace jaywalk;
using namespace std::chrono_literals;

namespace {

CanFrame extended(std::uint32_t id, std::initializer_list<std::uint8_t> bytes) {
  CanFrame made = tests::frame(id, bytes);
  made.extended = true;
  return made;
}

CanFrame remote(std::uint32_t id) {
  CanFrame made = tests::frame(id, {});
  made.remote = true;
  return made;
}

/// What only a master sends to nodes 3 and 4: every command that sets, and a request that feeds the watchdog.
std::vector<CanFrame> to_odrives() {
  std::vector<CanFrame> frames{remote(0x069), remote(0x081)};
  for (const std::uint32_t number :
       {0x02U, 0x04U, 0x07U, 0x0BU, 0x0CU, 0x0DU, 0x0EU, 0x0FU, 0x16U, 0x18U, 0x19U, 0x1BU, 0x1FU}) {
    frames.push_back(tests::frame(3 << 5 | number, {0, 0, 0, 0, 0, 0, 0, 0}));
    frames.push_back(tests::frame(4 << 5 | number, {0, 0, 0, 0}));
  }
  return frames;
}

/// Speeds, currents and questions to controllers 23, 24 and to all; and answers that were not asked for.
std::vector<CanFrame> to_vescs() {
  std::vector<CanFrame> frames;
  for (const std::uint32_t number : {0U, 1U, 2U, 3U, 4U, 5U, 6U, 7U, 8U, 10U, 11U, 12U, 13U, 17U, 21U, 31U}) {
    for (const std::uint32_t whom : {23U, 24U, 255U}) frames.push_back(extended(number << 8 | whom, {0, 0, 0, 0}));
  }
  frames.push_back(extended(0x05FE, {0, 17, 1, 2, 3, 4, 23, 0}));     // settings
  frames.push_back(extended(0x08FE, {23, 1, 50, 0, 0, 0x80, 0, 0}));  // a fault code
  frames.push_back(extended(0x08FE, {99, 1, 50, 0, 0, 0x80, 0, 0}));  // of another controller
  frames.push_back(extended(0x12FE, {23}));                           // "here I am"
  frames.push_back(extended(0x09FE, {0, 0, 0, 0, 0, 0, 0, 0}));       // a status under our own number
  return frames;
}

template <class Bench>
void refuses_at_arming(const std::vector<CanFrame>& frames) {
  for (const CanFrame& frame : frames) {
    CAPTURE(frame);
    Bench bench;
    CHECK(bench.bus.port(3).send(frame) == SendResult::kQueued);
    CHECK(bench.armed().starts_with("CAN: another program commands the drives: frame "));
    bench.drive(0.0, 0.0, 10);
    bench.drive(2.0, 2.0, 20);
    CHECK(bench.is_at_rest());
  }
}

template <class Bench>
void latches_while_driving(const std::vector<CanFrame>& frames) {
  for (const CanFrame& frame : frames) {
    CAPTURE(frame);
    Bench bench;
    bench.bring_to_two_radps();
    CHECK(bench.bus.port(3).send(frame) == SendResult::kQueued);
    bench.drive(2.0, 2.0, 1);
    CHECK(bench.wheels.trouble == DriveTrouble::kForeignMaster);
    CHECK(bench.base.foreign_frame() == frame);
    bench.drive(2.0, 2.0, 150);
    CHECK(bench.is_at_rest());
    bench.base.reset();
    bench.drive(0.0, 0.0, 60);
    bench.drive(2.0, 2.0, 50);
    CHECK(bench.base.trouble() == DriveTrouble::kNone);  // it was one frame
    CHECK_FALSE(bench.is_at_rest());
  }
}

}  // namespace

TEST_CASE("ODrives that hear another master are not armed") {
  refuses_at_arming<tests::OdriveBench>(to_odrives());
  tests::OdriveBench bench;
  CHECK(bench.bus.port(3).send(tests::frame(0x06D, {0, 0, 0x80, 0x3F, 0, 0, 0, 0})) == SendResult::kQueued);
  CHECK(bench.armed() ==
        "CAN: another program commands the drives: frame 06Dh 00 00 80 3F 00 00 00 00; end that program, or take it "
        "off this bus");
}

TEST_CASE("a frame of another master to an ODrive is a latched fault in the next tick") {
  latches_while_driving<tests::OdriveBench>(to_odrives());
}

TEST_CASE("VESCs that hear another master are not armed") { refuses_at_arming<tests::VescBench>(to_vescs()); }

TEST_CASE("a frame of another master to a VESC is a latched fault in the next tick") {
  latches_while_driving<tests::VescBench>(to_vescs());
}

TEST_CASE("frames of others that mean neither drive are no foreign master") {
  tests::OdriveBench odrives;
  odrives.bring_to_two_radps();
  for (const CanFrame& frame : {tests::frame(0x0AD, {0, 0, 0, 0}),  // a speed for node 5
                                tests::frame(0x074, {0, 0, 0, 0}),  // node 3's motor current
                                extended(0x006D, {0, 0, 0, 0})}) {  // no ODrive frame
    CHECK(odrives.bus.port(3).send(frame) == SendResult::kQueued);
  }
  odrives.drive(2.0, 2.0, 10);
  CHECK(odrives.base.trouble() == DriveTrouble::kNone);

  tests::VescBench vescs;
  vescs.bring_to_two_radps();
  for (const CanFrame& frame : {extended(0x0319, {0, 0, 0, 0}),              // a speed for controller 25
                                extended(0x0E17, {0, 0, 0, 0, 0, 0, 0, 0}),  // status message 2 of controller 23
                                tests::frame(0x317, {0, 0, 0, 0})}) {        // no VESC frame
    CHECK(vescs.bus.port(3).send(frame) == SendResult::kQueued);
  }
  vescs.drive(2.0, 2.0, 10);
  CHECK(vescs.base.trouble() == DriveTrouble::kNone);
}

TEST_CASE("another master with our own number that asks a VESC is found by the answers") {
  tests::VescBench bench;
  bench.bring_to_two_radps();
  // Each of our questions is answered once; its questions are heard as well, but here its answers alone.
  for (int k = 0; k < 3; ++k) {
    CHECK(bench.bus.port(3).send(extended(0x08FE, {24, 1, 50, 0, 0, 0x80, 0, 0})) == SendResult::kQueued);
  }
  bench.drive(2.0, 2.0, 1);
  CHECK(bench.base.trouble() == DriveTrouble::kForeignMaster);
}
