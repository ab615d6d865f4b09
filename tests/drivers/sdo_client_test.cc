#include "drivers/canopen/sdo_client.h"

#include <chrono>
#include <string>

#include "drivers/can/in_process_bus.h"
#include "tests/drivers/frames.h"
#include "tests/drivers/hand_clock.h"
#include "tests/support/catch.h"

using namespace jaywalk;
using namespace jaywalk::canopen;
using namespace std::chrono_literals;
using tests::frame;

namespace {

/// A client of node 5 on a bus whose other end the test holds.
struct Bench {
  tests::HandClock clock;
  InProcessBus bus{clock, 1};
  SdoClient client{bus.port(0), 5, 50ms};

  CanFrame asked() {
    ReceivedFrame received;
    REQUIRE(bus.port(1).receive(received));
    return received.frame;
  }
  bool is_silent() {
    ReceivedFrame received;
    return !bus.port(1).receive(received);
  }
  void answer(const CanFrame& answered) { client.on_frame(answered, clock.now()); }
  [[nodiscard]] std::string text() const { return {client.value().begin(), client.value().end()}; }
};

}  // namespace

TEST_CASE("a heartbeat time of 100 ms is read in one answer") {
  Bench bench;
  REQUIRE(bench.client.read({0x1017, 0}, bench.clock.now()));
  CHECK(bench.asked() == frame(0x605, {0x40, 0x17, 0x10, 0, 0, 0, 0, 0}));
  CHECK(bench.client.status() == SdoStatus::kBusy);
  CHECK_FALSE(bench.client.read({0x1018, 0}, bench.clock.now()));
  bench.answer(frame(0x585, {0x4B, 0x17, 0x10, 0, 0x64, 0, 0, 0}));  // 2 bytes: 0064h = 100
  REQUIRE(bench.client.status() == SdoStatus::kDone);
  REQUIRE(bench.client.value().size() == 2);
  CHECK(wire::little_endian<std::uint16_t>(bench.client.value()) == 100);
}

TEST_CASE("an answer that does not tell its size has four bytes") {
  Bench bench;
  REQUIRE(bench.client.read({0x1000, 0}, bench.clock.now()));
  bench.answer(frame(0x585, {0x42, 0x00, 0x10, 0, 0x92, 0x01, 0x02, 0}));
  REQUIRE(bench.client.value().size() == 4);
  CHECK(wire::little_endian<std::uint32_t>(bench.client.value()) == 0x00020192);
}

TEST_CASE("one, two and four bytes are written in one frame") {
  Bench bench;
  REQUIRE(bench.client.write({{0x6060, 0}, 3, 1}, bench.clock.now()));
  CHECK(bench.asked() == frame(0x605, {0x2F, 0x60, 0x60, 0, 3, 0, 0, 0}));
  bench.answer(frame(0x585, {0x60, 0x60, 0x60, 0, 0, 0, 0, 0}));
  CHECK(bench.client.status() == SdoStatus::kDone);
  REQUIRE(bench.client.write({{0x1017, 0}, 0x00010064, 2}, bench.clock.now()));
  CHECK(bench.asked() == frame(0x605, {0x2B, 0x17, 0x10, 0, 0x64, 0, 0, 0}));
  bench.answer(frame(0x585, {0x60, 0x17, 0x10, 0, 0, 0, 0, 0}));
  REQUIRE(bench.client.write({{0x1016, 1}, 0x00010064, 4}, bench.clock.now()));
  CHECK(bench.asked() == frame(0x605, {0x23, 0x16, 0x10, 1, 0x64, 0, 1, 0}));
}

TEST_CASE("eight letters are read in two segments") {
  Bench bench;
  REQUIRE(bench.client.read({0x1008, 0}, bench.clock.now()));
  CHECK(bench.asked() == frame(0x605, {0x40, 0x08, 0x10, 0, 0, 0, 0, 0}));
  bench.answer(frame(0x585, {0x41, 0x08, 0x10, 0, 8, 0, 0, 0}));
  CHECK(bench.asked() == frame(0x605, {0x60, 0, 0, 0, 0, 0, 0, 0}));
  bench.answer(frame(0x585, {0x00, 'j', 'a', 'y', 'w', 'a', 'l', 'k'}));
  CHECK(bench.asked() == frame(0x605, {0x70, 0, 0, 0, 0, 0, 0, 0}));
  bench.answer(frame(0x585, {0x1D, '!', 0, 0, 0, 0, 0, 0}));  // toggle 10h, 6 unused: 0Ch, last: 01h
  REQUIRE(bench.client.status() == SdoStatus::kDone);
  CHECK(bench.text() == "jaywalk!");
}

TEST_CASE("a drive that refuses is quoted by name") {
  Bench bench;
  REQUIRE(bench.client.write({{0x6007, 0}, 3, 2}, bench.clock.now()));
  bench.answer(frame(0x585, {0x80, 0x07, 0x60, 0, 0x00, 0x00, 0x02, 0x06}));  // 06020000h
  CHECK(bench.client.status() == SdoStatus::kAbortedByDrive);
  CHECK(bench.client.abort_code() == 0x06020000);
  CHECK(abort_name(bench.client.abort_code()) == "no such object");
  CHECK(abort_name(0x12345678) == "unknown reason");
}

TEST_CASE("silence ends a transfer after its time and the drive is told") {
  Bench bench;
  REQUIRE(bench.client.read({0x6041, 0}, bench.clock.now()));
  CHECK(bench.asked().bytes[0] == 0x40);
  bench.clock.sleep_until(Time{49ms});
  bench.client.poll(bench.clock.now());
  CHECK(bench.client.status() == SdoStatus::kBusy);
  bench.clock.sleep_until(Time{50ms});
  bench.client.poll(bench.clock.now());
  CHECK(bench.client.status() == SdoStatus::kAbortedHere);
  CHECK(bench.client.abort_code() == kAbortTimeout);
  CHECK(bench.asked() == frame(0x605, {0x80, 0x41, 0x60, 0, 0, 0, 0x04, 0x05}));
}

TEST_CASE("other nodes and late answers about other objects change nothing") {
  Bench bench;
  REQUIRE(bench.client.read({0x1017, 0}, bench.clock.now()));
  CHECK(bench.asked().bytes[0] == 0x40);
  bench.clock.sleep_until(Time{49ms});
  bench.answer(frame(0x586, {0x4B, 0x17, 0x10, 0, 0x64, 0, 0, 0}));
  bench.answer(frame(0x585, {0x4B, 0x16, 0x10, 0, 0x64, 0, 0, 0}));
  bench.answer(frame(0x585, {0x80, 0x16, 0x10, 0, 0, 0, 4, 5}));
  CHECK(bench.client.status() == SdoStatus::kBusy);
  CHECK(bench.is_silent());
  bench.clock.sleep_until(Time{50ms});
  bench.client.poll(bench.clock.now());
  CHECK(bench.client.abort_code() == kAbortTimeout);  // they did not buy it time either
}

TEST_CASE("a repeated toggle bit, a wrong length and a value too long end the transfer by name") {
  Bench bench;
  REQUIRE(bench.client.read({0x1008, 0}, bench.clock.now()));
  bench.answer(frame(0x585, {0x41, 0x08, 0x10, 0, 14, 0, 0, 0}));
  bench.answer(frame(0x585, {0x10, 1, 2, 3, 4, 5, 6, 7}));
  CHECK(bench.client.abort_code() == kAbortToggle);
  REQUIRE(bench.client.read({0x1008, 0}, bench.clock.now()));
  bench.answer(frame(0x585, {0x41, 0x08, 0x10, 0, 14, 0, 0, 0}));
  bench.answer(frame(0x585, {0x01, 1, 2, 3, 4, 5, 6, 7}));  // the last already: 7 of 14
  CHECK(bench.client.abort_code() == kAbortLength);
  REQUIRE(bench.client.read({0x1008, 0}, bench.clock.now()));
  bench.answer(frame(0x585, {0x41, 0x08, 0x10, 0, 1, 1, 0, 0}));  // 257 bytes
  CHECK(bench.client.abort_code() == kAbortNoMemory);
  REQUIRE(bench.client.read({0x1008, 0}, bench.clock.now()));
  bench.answer(frame(0x585, {0x40, 0x08, 0x10, 0, 0, 0, 0, 0}));  // does not say how long, and goes on and on
  for (int k = 0; k < 40; ++k)
    bench.answer(frame(0x585, {static_cast<std::uint8_t>(k % 2 == 0 ? 0x00 : 0x10), 0, 0, 0, 0, 0, 0, 0}));
  CHECK(bench.client.abort_code() == kAbortNoMemory);
}

TEST_CASE("a bus that takes no frame ends the transfer") {
  Bench bench;
  bench.bus.port(0).set_state(CanState::kBusOff);
  REQUIRE(bench.client.read({0x1017, 0}, bench.clock.now()));
  CHECK(bench.client.status() == SdoStatus::kNotSent);
}
