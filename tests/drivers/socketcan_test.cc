#include "drivers/can/socketcan.h"

#include <linux/can/error.h>
#include <sys/socket.h>

#include <array>
#include <string>

#include "tests/drivers/hand_clock.h"
#include "tests/drivers/random_bytes.h"
#include "tests/support/allocation_guard.h"
#include "tests/support/catch.h"
#include "tests/support/text.h"

using namespace jaywalk;
using namespace std::chrono_literals;

namespace {

/// A pair of datagram sockets: one end stands for the kernel's raw CAN socket, the test writes into the other.
struct SocketPair {
  SocketPair() {
    std::array<int, 2> ends{};
    REQUIRE(::socketpair(AF_UNIX, SOCK_DGRAM | SOCK_NONBLOCK, 0, ends.data()) == 0);
    driver = wire::FileDescriptor(ends[0]);
    kernel = wire::FileDescriptor(ends[1]);
  }
  void inject(const can_frame& frame) const { REQUIRE(::send(kernel.get(), &frame, sizeof frame, 0) == sizeof frame); }

  wire::FileDescriptor driver;
  wire::FileDescriptor kernel;
};

can_frame error_frame(canid_t error_class, std::uint8_t controller_status) {
  can_frame frame{};
  frame.can_id = CAN_ERR_FLAG | error_class;
  frame.can_dlc = CAN_ERR_DLC;
  frame.data[1] = controller_status;
  return frame;
}

}  // namespace

TEST_CASE("an extended frame has the kernel's bytes") {
  CanFrame frame;
  frame.id = 0x12345678;
  frame.extended = true;
  frame.size = 2;
  frame.bytes = {0xAB, 0xCD};
  const can_frame raw = to_kernel(frame);
  CHECK(raw.can_id == 0x92345678U);  // bit 31 marks 29-bit identifiers
  CHECK(raw.can_dlc == 2);
  CHECK(raw.data[0] == 0xAB);
  CHECK(raw.data[1] == 0xCD);
  CHECK(from_kernel(raw) == frame);
}

TEST_CASE("a remote frame carries a size and no bytes") {
  CanFrame frame;
  frame.id = 0x701;
  frame.remote = true;
  frame.size = 1;
  CHECK(to_kernel(frame).can_id == 0x40000701U);
  CHECK(from_kernel(to_kernel(frame)) == frame);
}

TEST_CASE("a kernel filter tells 11-bit identifiers from 29-bit ones and data frames from requests") {
  const can_filter standard = to_kernel(CanFilter{.id = 0x181, .mask = 0x7FF, .extended = false});
  CHECK(standard.can_id == 0x181U);
  CHECK(standard.can_mask == 0xC00007FFU);
  const can_filter extended = to_kernel(CanFilter{.id = 0x917, .mask = 0x1FFFFFFF, .extended = true});
  CHECK(extended.can_id == 0x80000917U);
  CHECK(extended.can_mask == 0xDFFFFFFFU);
  const can_filter requests = to_kernel(CanFilter{.id = 0, .mask = 0, .extended = false, .remote = true});
  CHECK(requests.can_id == 0x40000000U);
  CHECK(requests.can_mask == 0xC0000000U);
}

TEST_CASE("a kernel frame of nine bytes or with a 12-bit identifier is refused") {
  can_frame raw{};
  raw.can_id = 0x123;
  raw.can_dlc = 9;
  CHECK_FALSE(from_kernel(raw));
  raw.can_dlc = 8;
  raw.can_id = 0x923;
  CHECK_FALSE(from_kernel(raw));
}

TEST_CASE("error frames move the controller's state") {
  const auto after = [](canid_t error_class, std::uint8_t status) {
    return state_after(error_frame(error_class, status), CanState::kActive);
  };
  CHECK(after(CAN_ERR_CRTL, 0x04) == CanState::kWarning);  // receive warning
  CHECK(after(CAN_ERR_CRTL, 0x20) == CanState::kPassive);  // send passive
  CHECK(after(CAN_ERR_CRTL, 0x24) == CanState::kPassive);
  CHECK(after(CAN_ERR_BUSOFF, 0) == CanState::kBusOff);
  CHECK(after(CAN_ERR_ACK, 0) == CanState::kActive);
  CHECK(state_after(error_frame(CAN_ERR_RESTARTED, 0), CanState::kBusOff) == CanState::kActive);
  CHECK(state_after(error_frame(CAN_ERR_CRTL, 0x40), CanState::kPassive) == CanState::kActive);
  CHECK(state_after(error_frame(CAN_ERR_PROT, 0), CanState::kPassive) == CanState::kPassive);
}

TEST_CASE("the socket hands out frames and keeps errors to itself") {
  SocketPair pair;
  tests::HandClock clock;
  clock.sleep_until(Time{std::chrono::seconds(3)});
  SocketCan bus(std::move(pair.driver), clock);
  ReceivedFrame received;
  CHECK_FALSE(bus.receive(received));
  CanFrame frame;
  frame.id = 0x181;
  frame.size = 8;
  frame.bytes = {1, 2, 3, 4, 5, 6, 7, 8};
  pair.inject(error_frame(CAN_ERR_CRTL, 0x20));
  pair.inject(to_kernel(frame));
  REQUIRE(bus.receive(received));
  CHECK(received.frame == frame);
  CHECK(received.stamp == clock.now());  // this kind of socket has no stamps: then the time of reading counts
  CHECK(bus.health().state == CanState::kPassive);
  CHECK(bus.health().error_frames == 1);
  pair.inject(error_frame(CAN_ERR_BUSOFF, 0));
  CHECK_FALSE(bus.receive(received));
  CHECK(bus.health().state == CanState::kBusOff);
  CHECK(bus.health().bus_off_count == 1);
}

TEST_CASE("a frame's age is what the wall clock says it waited, no longer than the socket may have held it") {
  const Duration wall = 1'000'000s;
  ArrivalClock arrivals(Time{100s});
  arrivals.note_empty(Time{100s}, wall);
  // 20 ms later; it waited 5 ms, 12 ms, and cannot have waited 50.
  const Time now = Time{100s + 20ms};
  CHECK(arrivals.arrival(wall + 15ms, wall + 20ms, now) == Time{100s + 15ms});
  CHECK(arrivals.arrival(wall + 8ms, wall + 20ms, now) == Time{100s + 8ms});
  CHECK(arrivals.arrival(wall - 30ms, wall + 20ms, now) == Time{100s});
  CHECK(arrivals.arrival(wall + 25ms, wall + 20ms, now) == now);  // a stamp ahead of the clock
}

TEST_CASE("a wall clock that is set under way makes feedback neither fresh nor older than a reading of the socket") {
  const Duration wall = 1'000'000s;
  for (const Duration step : {Duration(-3600s), Duration(-100ms), Duration(100ms), Duration(3600s)}) {
    ArrivalClock arrivals(Time{100s});
    arrivals.note_empty(Time{100s}, wall);
    // Stamped before the clock was set, and after; the loop reads it 20 ms after it last found nothing.
    CHECK(arrivals.arrival(wall + 15ms, wall + step + 20ms, Time{100s + 20ms}) == Time{100s});
    CHECK(arrivals.arrival(wall + step + 19ms, wall + step + 20ms, Time{100s + 20ms}) == Time{100s});
    // A loop that was held up for 0.5 s does not take what waited for fresh.
    CHECK(arrivals.arrival(wall + 15ms, wall + step + 500ms, Time{100s + 500ms}) == Time{100s});
    arrivals.note_empty(Time{100s + 20ms}, wall + step + 20ms);  // and from there on ages are right again
    CHECK(arrivals.arrival(wall + step + 35ms, wall + step + 40ms, Time{100s + 40ms}) == Time{100s + 35ms});
  }
}

TEST_CASE("one program at a time has an interface's drives, and another interface is another's") {
  {
    const BusLock lock("nocan7");
    const BusLock other("nocan8");
    CHECK(refusal_of([] {
            return BusLock("nocan7");
          }).starts_with("nocan7: another program of jaywalk has the drives on this bus; end it first"));
  }
  CHECK_NOTHROW(BusLock("nocan7"));  // it ended
}

TEST_CASE("a send that finds no room says so at once") {
  SocketPair pair;
  tests::HandClock clock;
  SocketCan bus(std::move(pair.driver), clock);
  CanFrame frame;
  frame.id = 0x201;
  int sent = 0;
  while (sent < 100000 && bus.send(frame)) ++sent;
  CHECK(sent < 100000);
  can_frame raw{};
  REQUIRE(::recv(pair.kernel.get(), &raw, sizeof raw, 0) == sizeof raw);
  CHECK(raw.can_id == 0x201U);
}

TEST_CASE("any bytes from the kernel are a frame, an error, or counted, without the heap") {
  SocketPair pair;
  tests::HandClock clock;
  SocketCan bus(std::move(pair.driver), clock);
  tests::RandomBytes random(5);
  std::uint64_t frames = 0;
  std::uint64_t heap_calls = 0;
  constexpr int kRounds = 20000;
  for (int k = 0; k < kRounds; ++k) {
    const auto bytes = random.bytes(random.below(2) == 0 ? sizeof(can_frame) : random.below(24));
    REQUIRE(::send(pair.kernel.get(), bytes.data(), bytes.size(), 0) == static_cast<ssize_t>(bytes.size()));
    ReceivedFrame received;
    const AllocationGuard guard;
    if (bus.receive(received)) {
      ++frames;
      if (!is_valid(received.frame)) frames += kRounds;
    }
    heap_calls += guard.calls();
  }
  CHECK(heap_calls == 0);
  CHECK(frames > 0);
  CHECK(bus.health().malformed > 0);
  CHECK(frames + bus.health().error_frames + bus.health().malformed == kRounds);
}

TEST_CASE("an interface that is not there is refused with what to do") {
  CHECK(refusal_of([] { return open_can("nocan9", {}); }) ==
        "nocan9: no such interface; bring it up: ip link set nocan9 up type can bitrate 500000");
}

TEST_CASE("a kernel without CAN, or an interface of another kind, is refused with what to do") {
  const std::string said = refusal_of([] { return open_can("lo", {}); });
  const bool without_can = said == "lo: this kernel has no raw CAN sockets; load them: modprobe can_raw";
  const bool not_can =
      said.starts_with("lo: bind: ") && said.ends_with("; see that it is a CAN interface: ip -details link show lo");
  CHECK((without_can || not_can));
}
