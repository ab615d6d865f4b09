#include <linux/input.h>

#include <array>
#include <cmath>
#include <tuple>

#include "drivers/panel/joystick.h"
#include "firmware/robot/realtime.h"
#include "tests/drivers/panel_bench.h"
#include "tests/drivers/random_bytes.h"

using namespace jaywalk;
using namespace jaywalk::panel;
using namespace jaywalk::panel::tests;

TEST_CASE("a joystick that is not there is an emergency stop") {
  Bench bench;
  CHECK(bench.after(0ms).emergency_stop);
  CHECK_FALSE(bench.after(1s).has_goal);
  CHECK_FALSE(bench.watch.latest().connected);
}

TEST_CASE("a goal passes while the dead man's button is held") {
  Bench bench;
  bench.plug_in();
  OperatorInput input = bench.after(0ms);
  CHECK_FALSE(input.emergency_stop);
  CHECK_FALSE(input.has_goal);
  bench.press_dead_man();
  input = bench.after(20ms);
  CHECK(input.has_goal);
  CHECK(input.goal_in_map.x == 1.0);
  CHECK(bench.after(10s).has_goal);
  bench.press(kDeadMan, false);
  CHECK_FALSE(bench.after(20ms).has_goal);
  CHECK(bench.heap_calls == 0);
}

TEST_CASE("a dead man's button that was never seen released does not count") {
  Bench bench;
  bench.plug_in();
  static_cast<void>(bench.after(0ms));
  bench.press(kDeadMan);
  CHECK_FALSE(bench.after(20ms).has_goal);
  bench.write(event(EV_KEY, kDeadMan, 2));  // the kernel repeats what is held
  CHECK_FALSE(bench.after(20ms).has_goal);
  bench.press_dead_man();
  CHECK(bench.after(20ms).has_goal);
}

TEST_CASE("stop and reset are what their buttons say") {
  Bench bench;
  bench.plug_in();
  CHECK_FALSE(bench.after(0ms).emergency_stop);
  bench.press(kStop);
  CHECK(bench.after(20ms).emergency_stop);
  CHECK(bench.after(1s).emergency_stop);
  bench.press(kStop, false);
  bench.press(kReset);
  const OperatorInput input = bench.after(20ms);
  CHECK_FALSE(input.emergency_stop);
  CHECK(input.reset);
  bench.press(kReset, false);
  CHECK_FALSE(bench.after(20ms).reset);
}

TEST_CASE("an emergency stop that opens a contact stops until it is known to be closed") {
  Bench bench(true);
  bench.plug_in();
  CHECK(bench.after(0ms).emergency_stop);
  bench.press(kStop);  // closed
  CHECK_FALSE(bench.after(20ms).emergency_stop);
  bench.press(kStop, false);
  CHECK(bench.after(20ms).emergency_stop);
}

TEST_CASE("a joystick that is pulled is an emergency stop and is found again with its dead man forgotten") {
  Bench bench;
  bench.plug_in_and_hold();
  CHECK(bench.after(20ms).has_goal);
  bench.pull();
  OperatorInput input = bench.after(20ms);
  CHECK(input.emergency_stop);
  CHECK_FALSE(input.has_goal);
  bench.plug_in();
  input = bench.after(500ms);
  CHECK_FALSE(input.emergency_stop);
  CHECK_FALSE(input.has_goal);
  CHECK(bench.heap_calls == 0);
}

TEST_CASE("the loop's thread opens no device: what the watch has not looked at is not there") {
  Bench bench;
  bench.plug_in();
  CHECK(bench.tick().emergency_stop);
  CHECK_FALSE(bench.after(0ms).emergency_stop);
}

TEST_CASE("a watch that hangs for more than 100 ms is a joystick that is gone") {
  Bench bench;
  bench.plug_in_and_hold();
  CHECK(bench.after(20ms).has_goal);
  bench.clock.sleep_until(bench.clock.now() + 100ms);
  CHECK(bench.tick().has_goal);
  bench.clock.sleep_until(bench.clock.now() + 1ms);
  const OperatorInput input = bench.tick();
  CHECK(input.emergency_stop);
  CHECK_FALSE(input.has_goal);
  CHECK_FALSE(bench.after(0ms).emergency_stop);
}

TEST_CASE("a stop that is pressed and let go between two ticks is one for a tick") {
  Bench bench;
  bench.plug_in();
  CHECK_FALSE(bench.after(0ms).emergency_stop);
  bench.press(kStop);
  bench.press(kStop, false);
  CHECK(bench.after(10ms).emergency_stop);
  CHECK_FALSE(bench.after(20ms).emergency_stop);
  bench.press(kStop);
  bench.watch.step();
  bench.press(kStop, false);
  bench.watch.step();
  CHECK(bench.tick().emergency_stop);
  CHECK_FALSE(bench.tick().emergency_stop);
}

TEST_CASE(
    "a dead man that is to be renewed counts until two seconds after the last event, then it must be pressed anew") {
  Bench bench(false, 2s);
  bench.plug_in_and_hold();
  CHECK(bench.after(20ms).has_goal);
  CHECK(bench.after(2s).has_goal);
  bench.write(event(EV_ABS, kX, 100));  // the link lives
  CHECK(bench.after(10ms).has_goal);
  CHECK(bench.after(2s).has_goal);
  CHECK_FALSE(bench.after(10ms).has_goal);
  bench.write(event(EV_ABS, kX, 0));
  CHECK_FALSE(bench.after(10ms).has_goal);
  bench.press_dead_man();
  CHECK(bench.after(10ms).has_goal);
}

TEST_CASE("a dead man on Bluetooth counts only where it is to be renewed, and says so") {
  const BusOf bluetooth = [](int) noexcept -> std::optional<std::uint16_t> { return BUS_BLUETOOTH; };
  const BusOf usb = [](int) noexcept -> std::optional<std::uint16_t> { return BUS_USB; };
  for (const auto& [bus, renew, drives] :
       {std::tuple{bluetooth, Duration{0}, false}, {bluetooth, Duration{2s}, true}, {usb, Duration{0}, true}}) {
    Bench bench(false, renew, bus);
    bench.plug_in_and_hold();
    CHECK(bench.after(20ms).has_goal == drives);
    CHECK(bench.watch.latest().needs_renewal == !drives);
  }
}

TEST_CASE("a watch in a thread of its own finds the joystick and publishes how it stands") {
  SteadyClock clock;
  Bench pipe;
  pipe.plug_in();
  JoystickWatch watch(clock, {.path = pipe.path()});
  watch.start(0);
  while (!watch.latest().connected) std::this_thread::sleep_for(1ms);
  pipe.press_dead_man();
  while (!watch.latest().dead_man) std::this_thread::sleep_for(1ms);
  CHECK(watch.latest().dead_man);
}

TEST_CASE("a joystick whose events were lost is asked again how it stands") {
  Bench bench;
  bench.plug_in_and_hold();
  CHECK(bench.after(20ms).has_goal);
  bench.write(event(EV_SYN, SYN_DROPPED, 0));
  OperatorInput input = bench.after(20ms);
  CHECK(input.emergency_stop);
  input = bench.after(500ms);  // opened anew: a pipe does not say that the button is still held
  CHECK_FALSE(input.emergency_stop);
  CHECK_FALSE(input.has_goal);
}

TEST_CASE("whatever a device says its state stays within its limits") {
  Bench bench;
  bench.plug_in();
  static_cast<void>(bench.after(0ms));
  jaywalk::tests::RandomBytes random(91);
  for (int k = 0; k < 3000; ++k) {
    constexpr std::array<std::uint16_t, 5> kCodes{kDeadMan, kStop, kReset, kX, kY};
    const std::uint8_t type = static_cast<std::uint8_t>(random.below(5));
    const std::uint16_t code =
        random.below(3) == 0 ? static_cast<std::uint16_t>(random.below(0x10000)) : kCodes[random.below(kCodes.size())];
    Octets made = event(type, code, 0);
    for (std::size_t at = made.size() - 4; at < made.size(); ++at) made[at] = random.byte();
    if (random.below(50) == 0) made = random.bytes(random.below(100));
    bench.write(made);
    static_cast<void>(bench.after(20ms));
    const JoystickState state = bench.watch.latest();
    REQUIRE(std::fabs(state.forward) <= 1.0);
    REQUIRE(std::fabs(state.left) <= 1.0);
    REQUIRE((state.connected || state.stop));
  }
  CHECK(bench.heap_calls == 0);
}

TEST_CASE("a device is asked for its stop, its dead man and its stick, as far as they are needed") {
  DeviceKeys pad{.answers = true, .old_joystick = false, .buttons = {}, .axes = {}};
  const auto give = [](auto& bits, unsigned code) {
    bits[code / 8] = static_cast<std::uint8_t>(bits[code / 8] | 1U << code % 8);
  };
  JoystickSetup setup{.path = "pad"};
  CHECK(lacking(DeviceKeys{}, setup) == "is no input device: it does not tell which buttons it has");
  CHECK(lacking(pad, setup) == "has no button 305, which [panel] stop_button names");
  give(pad.buttons, kStop);
  CHECK(lacking(pad, setup) == "has no button 310, which [panel] dead_man_button names");
  setup.needs_dead_man = false;
  CHECK(lacking(pad, setup).empty());
  setup.needs_dead_man = setup.steers = true;
  give(pad.buttons, kDeadMan);
  give(pad.axes, kX);
  CHECK(lacking(pad, setup) == "has no stick, which [panel] steering needs");
  give(pad.axes, kY);
  CHECK(lacking(pad, setup).empty());
  pad.old_joystick = true, pad.answers = false;
  CHECK(lacking(pad, setup).rfind("speaks the older joystick interface", 0) == 0);
}

TEST_CASE("a pipe in the place of a joystick that is asked what it has counts as gone") {
  Bench pipe;
  pipe.plug_in();
  Joystick asked({.path = pipe.path(), .asks_device = true}), unasked({.path = pipe.path()});
  asked.poll(Time{}), unasked.poll(Time{});
  CHECK_FALSE(asked.state().connected);
  CHECK(asked.state().stop);
  CHECK(unasked.state().connected);
}

TEST_CASE("sticks count from a dead zone to the end while the dead man's button is held") {
  Bench bench;
  bench.plug_in();
  static_cast<void>(bench.after(0ms));
  bench.write(event(EV_ABS, kY, -32767));
  static_cast<void>(bench.after(20ms));
  CHECK(bench.watch.latest().forward == 0.0);
  bench.press_dead_man();
  static_cast<void>(bench.after(20ms));
  CHECK(bench.watch.latest().dead_man);
  CHECK(bench.watch.latest().forward == 0.0);  // pushed before: it has to come to its middle first
  bench.write(event(EV_ABS, kY, 0));
  static_cast<void>(bench.after(20ms));
  bench.write(event(EV_ABS, kY, -32767));
  bench.write(event(EV_ABS, kX, 3276));  // a tenth to the right: at rest
  static_cast<void>(bench.after(20ms));
  CHECK(bench.watch.latest().forward == Approx(1.0));
  CHECK(bench.watch.latest().left == 0.0);
  bench.write(event(EV_ABS, kX, -18022));  // 0.55 to the left: (0.55 - 0.1) / 0.9
  static_cast<void>(bench.after(20ms));
  CHECK(bench.watch.latest().left == Approx(0.5).margin(1e-4));
}

TEST_CASE("where the stick drives it takes the goal's place when it leaves its middle, while the dead man is held") {
  Bench bench(false, 0s, bus_of, true);
  bench.plug_in_and_hold();
  OperatorInput input = bench.after(20ms);
  CHECK(input.has_goal);  // the stick rests: what was asked for elsewhere counts
  CHECK_FALSE(input.steers);
  bench.write(event(EV_ABS, kY, -32767));
  input = bench.after(20ms);
  CHECK_FALSE(input.has_goal);
  CHECK(input.steers);
  CHECK(input.stick.forward == Approx(1.0));
  bench.press(kDeadMan, false);
  input = bench.after(20ms);
  CHECK(input.stick.is_centred());
  CHECK_FALSE(input.wants_motion());
}
