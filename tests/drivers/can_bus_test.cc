#include <chrono>

#include "drivers/can/in_process_bus.h"
#include "tests/drivers/hand_clock.h"
#include "tests/support/catch.h"

using namespace jaywalk;
using namespace std::chrono_literals;

namespace {

CanFrame numbered(std::uint8_t number) {
  CanFrame frame;
  frame.id = 0x181;
  frame.size = 1;
  frame.bytes[0] = number;
  return frame;
}

int count_waiting(CanBus& bus) {
  ReceivedFrame received;
  int count = 0;
  while (bus.receive(received)) ++count;
  return count;
}

}  // namespace

TEST_CASE("what one port sends every other port receives and the sender does not") {
  tests::HandClock clock;
  InProcessBus bus(clock, 1);
  CHECK(bus.port(0).send(numbered(7)));
  ReceivedFrame received;
  REQUIRE(bus.port(1).receive(received));
  CHECK(received.frame == numbered(7));
  CHECK(received.stamp == clock.now());
  CHECK(count_waiting(bus.port(7)) == 1);
  CHECK(count_waiting(bus.port(0)) == 0);
}

TEST_CASE("a delayed frame arrives when its time has come and none overtakes another") {
  tests::HandClock clock;
  InProcessBus bus(clock, 1);
  bus.set_faults({.loss = 0.0, .delay = 5ms});
  CHECK(bus.port(0).send(numbered(1)));
  bus.set_faults({.loss = 0.0, .delay = 0ms});
  CHECK(bus.port(0).send(numbered(2)));
  ReceivedFrame received;
  clock.sleep_until(Time{4ms});
  CHECK_FALSE(bus.port(1).receive(received));
  clock.sleep_until(Time{5ms});
  REQUIRE(bus.port(1).receive(received));
  CHECK(received.frame == numbered(1));
  CHECK(received.stamp == Time{5ms});
  REQUIRE(bus.port(1).receive(received));
  CHECK(received.frame == numbered(2));
}

TEST_CASE("losses are as many as ordered and the same for the same seed") {
  const auto survivors = [](std::uint64_t seed) {
    tests::HandClock clock;
    InProcessBus bus(clock, seed);
    bus.set_faults({.loss = 0.25, .delay = 0ms});
    std::vector<int> arrived;
    ReceivedFrame received;
    for (int k = 0; k < 2000; ++k) {
      CHECK(bus.port(0).send(numbered(static_cast<std::uint8_t>(k))));
      if (bus.port(1).receive(received)) arrived.push_back(k);
    }
    return arrived;
  };
  // 2000 draws of 0.75: 1500 expected, standard deviation sqrt(2000 * 0.75 * 0.25) = 19.4; five of them are 97.
  const auto first = survivors(11);
  CHECK(first.size() > 1403);
  CHECK(first.size() < 1597);
  CHECK(first == survivors(11));
  CHECK(first != survivors(12));
}

TEST_CASE("a full receive queue loses the newest frame and counts it") {
  tests::HandClock clock;
  InProcessBus bus(clock, 1);
  for (std::size_t k = 0; k < InProcessBus::kQueue + 3; ++k) {
    CHECK(bus.port(0).send(numbered(static_cast<std::uint8_t>(k))));
  }
  CHECK(bus.port(1).health().frames_lost == 3);
  ReceivedFrame received;
  REQUIRE(bus.port(1).receive(received));
  CHECK(received.frame == numbered(0));
  CHECK(count_waiting(bus.port(1)) == InProcessBus::kQueue - 1);
}

TEST_CASE("a port that is bus-off neither sends nor receives and says so") {
  tests::HandClock clock;
  InProcessBus bus(clock, 1);
  CHECK(bus.port(1).send(numbered(1)));
  bus.port(0).set_state(CanState::kBusOff);
  CHECK(count_waiting(bus.port(0)) == 0);
  CHECK_FALSE(bus.port(0).send(numbered(2)));
  CHECK(bus.port(1).send(numbered(3)));
  CHECK(bus.port(0).health().bus_off_count == 1);
  CHECK(name(bus.port(0).health().state) == "bus-off");
  bus.port(0).set_state(CanState::kActive);
  CHECK(count_waiting(bus.port(0)) == 0);
  CHECK(bus.port(0).send(numbered(4)));
  CHECK(count_waiting(bus.port(1)) == 1);
}

TEST_CASE("an error passive port still takes part") {
  tests::HandClock clock;
  InProcessBus bus(clock, 1);
  bus.port(0).set_state(CanState::kPassive);
  CHECK(bus.port(0).send(numbered(1)));
  CHECK(bus.port(0).health().error_frames == 1);
}

TEST_CASE("sends find the queue full as often as ordered") {
  tests::HandClock clock;
  InProcessBus bus(clock, 1);
  bus.port(0).refuse_sends(2);
  CHECK_FALSE(bus.port(0).send(numbered(1)));
  CHECK_FALSE(bus.port(0).send(numbered(1)));
  CHECK(bus.port(0).send(numbered(1)));
}

TEST_CASE("what is no frame is refused") {
  tests::HandClock clock;
  InProcessBus bus(clock, 1);
  CanFrame wide = numbered(1);
  wide.id = 0x800;  // one more than 11 bits hold
  CHECK_FALSE(bus.port(0).send(wide));
  wide.extended = true;
  CHECK(bus.port(0).send(wide));
  CanFrame fat = numbered(1);
  fat.size = 9;
  CHECK_FALSE(bus.port(0).send(fat));
}
