// SocketCAN against a kernel's virtual bus; where there is none these tests say "skipped". tools/rig/run brings one
// along, or: modprobe vcan; ip link add vcan0 type vcan; ip link set vcan0 up
#include <linux/can/error.h>
#include <net/if.h>
#include <sys/socket.h>

#include <array>
#include <cstdlib>
#include <iostream>

#include "drivers/can/socketcan.h"
#include "drivers/wire/byte_reader.h"
#include "tests/drivers/drive_bench.h"
#include "tests/drivers/hand_clock.h"
#include "tests/support/allocation_guard.h"
#include "tests/support/catch.h"

using namespace jaywalk;
using namespace jaywalk::canopen;

namespace {

bool is_missing() {
  if (::if_nametoindex("vcan0") != 0) return false;
  std::cout << "skipped: no interface vcan0\n";
  return true;
}

SocketCan place_on_bus(Clock& clock, bool extended = false) {
  const std::array all{CanFilter{.id = 0, .mask = 0, .extended = extended}};
  return {open_can("vcan0", all), clock};
}

/// The bench of the in-process bus on the kernel's: controller and drives each have a socket of their own.
template <class Kind>
struct KernelBench {
  explicit KernelBench(bool extended = false)
      : controller(place_on_bus(clock, extended)),
        left_socket(place_on_bus(clock, extended)),
        right_socket(place_on_bus(clock, extended)) {
    clock.plant = [this](Time now) { left.step(now), right.step(now); };
  }
  /// Frames have real ages here, and this machine may be busy.
  static typename Kind::Setup patient() {
    auto setup = Kind::setup();
    setup.silence_limit = setup.stop.fresh = std::chrono::seconds(2);
    return setup;
  }
  void drive(double speed_radps, int ticks) {
    for (int k = 0; k < ticks; ++k) {
      wheels = base.latest();
      base.command({clock.now(), speed_radps, speed_radps});
      clock.sleep_until(clock.now() + std::chrono::milliseconds(20));
    }
  }
  void bring_to_two_radps(std::size_t proved, int enabling_ticks) {
    REQUIRE(base.arm().size() == proved);
    drive(0.0, enabling_ticks);
    drive(2.0, 50);
    REQUIRE(left.velocity() == Approx(2.0 * Kind::kPerRad));
    REQUIRE(right.velocity() == Approx(-2.0 * Kind::kPerRad));
    CHECK(wheels.right_radps == Approx(2.0));
  }

  tests::PlantClock clock;
  SocketCan controller, left_socket, right_socket;
  typename Kind::Node left{left_socket, Kind::kIds[0]}, right{right_socket, Kind::kIds[1]};
  typename Kind::Base base{controller, clock, patient()};
  WheelState wheels;
};

struct Cia402KernelBench : KernelBench<tests::Cia402> {
  Cia402KernelBench() { bring_to_two_radps(76, 10); }
  void check_stopped_until_reset() {
    CHECK(left.velocity() == 0.0);
    CHECK(right.velocity() == 0.0);
    drive(0.0, 20);
    drive(2.0, 20);
    CHECK(left.velocity() == 0.0);
    base.reset();
    for (int k = 0; k < 250 && !base.is_proved(); ++k) drive(0.0, 1);
    drive(0.0, 20);
    drive(2.0, 50);
    CHECK(base.trouble() == DriveTrouble::kNone);
    CHECK(left.velocity() == Approx(2000.0));
  }
};

/// Checks a pair whose left drive has just failed under way.
template <class Kind>
void check_fault_stops(KernelBench<Kind>& bench) {
  bench.drive(2.0, 20);
  CHECK(bench.wheels.trouble == DriveTrouble::kDriveFault);
  CHECK(bench.right.velocity() == 0.0);
  CHECK(bench.controller.health().frames_lost == 0);
}

}  // namespace

TEST_CASE("a thousand frames cross the kernel's virtual bus in order, filtered and stamped", "[can]") {
  if (is_missing()) return;
  tests::HandClock clock;
  clock.sleep_until(Time{std::chrono::seconds(9)});
  const std::array passes{CanFilter{.id = 0x181, .mask = 0x7FF, .extended = false}};
  SocketCan sender(open_can("vcan0", {}), clock);
  SocketCan receiver(open_can("vcan0", passes), clock);
  CanFrame frame;
  frame.size = 4;
  std::uint32_t arrived = 0;
  for (std::uint32_t k = 0; k < 2000; ++k) {
    frame.id = k % 2 == 0 ? 0x181 : 0x182;  // every other one is filtered out
    wire::put_little_endian(k, frame.bytes);
    REQUIRE(sender.send(frame));
    ReceivedFrame received;
    if (!receiver.receive(received)) continue;
    REQUIRE(received.frame == frame);
    REQUIRE(received.stamp <= clock.now());
    REQUIRE(received.stamp > clock.now() - std::chrono::seconds(1));
    ++arrived;
  }
  CHECK(arrived == 1000);
  CHECK(receiver.health().frames_lost == 0);
  CHECK(receiver.health().malformed == 0);
}

TEST_CASE("what a second user of a socket sends reaches the bus and not the socket itself", "[can]") {
  if (is_missing()) return;
  tests::HandClock clock;
  SocketCan bus = place_on_bus(clock), other = place_on_bus(clock);
  SocketCan second(bus.second(), clock);
  CanFrame frame;
  frame.id = 0x205;
  REQUIRE(second.send(frame));
  ReceivedFrame received;
  CHECK(other.receive(received));
  CHECK_FALSE(bus.receive(received));
  REQUIRE(other.send(frame));
  CHECK(bus.receive(received));  // another program's
}

TEST_CASE("a stranger on the kernel's bus is a fault, and the second user of the controller's socket is none",
          "[can]") {
  if (is_missing()) return;
  Cia402KernelBench bench;
  SocketCan second(bench.controller.second(), bench.clock), stranger = place_on_bus(bench.clock);
  REQUIRE(second.send(sync_frame()));
  bench.drive(2.0, 10);
  CHECK(bench.base.trouble() == DriveTrouble::kNone);
  REQUIRE(stranger.send(heartbeat_frame(1, NmtState::kOperational)));
  bench.drive(2.0, 12);
  CHECK(bench.base.trouble() == DriveTrouble::kForeignMaster);
  bench.check_stopped_until_reset();
}

TEST_CASE("drives arm, drive and stop over the kernel's virtual bus without a lost frame or the heap", "[can]") {
  if (is_missing()) return;
  Cia402KernelBench bench;
  const AllocationGuard guard;
  bench.drive(1.0, 500);
  const auto calls = guard.calls();
  CHECK(calls == 0);
  CHECK(bench.wheels.left_radps == Approx(1.0));
  bench.drive(0.0, 50);
  CHECK(bench.left.velocity() == 0.0);
  CHECK(bench.base.trouble() == DriveTrouble::kNone);
  for (const SocketCan* socket : {&bench.controller, &bench.left_socket, &bench.right_socket}) {
    CHECK(socket->health().frames_lost == 0);
    CHECK(socket->health().malformed == 0);
    CHECK(socket->health().error_frames == 0);
  }
}

TEST_CASE("bus-off as the kernel tells it stops the drives until a reset", "[can]") {
  if (is_missing()) return;
  Cia402KernelBench bench;
  const auto injector = open_can("vcan0", {});
  can_frame error{};
  error.can_id = CAN_ERR_FLAG | CAN_ERR_BUSOFF;
  error.can_dlc = CAN_ERR_DLC;
  REQUIRE(::send(injector.get(), &error, sizeof error, 0) == sizeof error);
  bench.drive(2.0, 12);
  CHECK(bench.controller.health().bus_off_count == 1);
  CHECK(bench.base.trouble() == DriveTrouble::kBusUnwell);
  bench.check_stopped_until_reset();
}

TEST_CASE("a link that goes down stops the drives until it is up and somebody resets", "[can]") {
  if (is_missing()) return;
  Cia402KernelBench bench;
  if (std::system("ip link set vcan0 down") != 0) {
    std::cout << "skipped: may not set vcan0 down\n";
    return;
  }
  bench.drive(2.0, 12);
  CHECK(bench.base.trouble() == DriveTrouble::kBusUnwell);  // the kernel tells it to who reads, before who sends
  CHECK(bench.left.velocity() == 0.0);                      // its own doing: it missed the controller's heartbeat
  REQUIRE(std::system("ip link set vcan0 up") == 0);
  bench.drive(2.0, 12);
  bench.check_stopped_until_reset();
}

TEST_CASE("ODrives over the kernel's bus are proved, drive, and stop when one of them fails", "[can]") {
  if (is_missing()) return;
  KernelBench<tests::Odrive> bench;
  bench.bring_to_two_radps(2, 20);
  bench.left.set_lasting_error(0x1000);
  check_fault_stops(bench);
}

TEST_CASE("VESCs over the kernel's bus are read back, drive, and stop when one of them fails", "[can]") {
  if (is_missing()) return;
  KernelBench<tests::Vesc> bench(true);
  bench.bring_to_two_radps(2, 10);
  bench.left.raise_fault(3);
  check_fault_stops(bench);
}
