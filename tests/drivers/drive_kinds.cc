#include "tests/drivers/drive_kinds.h"

#include <chrono>

#include "drivers/can/can_bus.h"
#include "drivers/canopen/cia402.h"

using namespace std::chrono_literals;

namespace jaywalk::tests {

namespace {

template <class Kind>
std::unique_ptr<DriveBench> make(const BenchChanges& changes) {
  auto setup = Kind::setup();
  setup.allow_unproved = changes.allow_unproved;
  const auto ids = changes.ids.value_or(Kind::kIds);
  const double per_rad = changes.per_rad.value_or(Kind::kPerRad);
  setup.axes = {CanAxis{ids[0], per_rad}, CanAxis{ids[1], -per_rad}};
  if (changes.tick != 20ms) {
    setup.stop = stop_limits(setup.stop.brake_radps2, setup.stop.tolerance_radps, changes.tick);
  }
  auto bench = std::make_unique<BenchOf<Kind>>(setup);
  bench->tick = changes.tick;
  return bench;
}

template <class Kind>
DriveEvent on(void (*event)(typename Kind::Node&)) {
  return [event](DriveBench& bench, std::size_t side) { event(dynamic_cast<BenchOf<Kind>&>(bench).node(side)); };
}

const DriveEvent kUnplugged = [](DriveBench& bench, std::size_t side) { bench.pull_cable(side); };

CanFrame remote(std::uint32_t id) {
  CanFrame made = frame(id, {});
  made.remote = true;
  return made;
}

CanFrame with_random_bytes(CanFrame made, RandomBytes& random) {
  made.size = static_cast<std::uint8_t>(random.below(9));
  for (std::uint8_t at = 0; at < made.size; ++at) made.bytes[at] = random.byte();
  return made;
}

CanFrame random_to_cia402(RandomBytes& random) {
  constexpr std::array<std::uint32_t, 8> kIds{0x000, 0x085, 0x185, 0x285, 0x585, 0x605, 0x705, 0x706};
  const bool any = random.below(4) == 0;
  return with_random_bytes(frame(any ? static_cast<std::uint32_t>(random.below(0x800)) : kIds[random.below(8)], {}),
                           random);
}

CanFrame random_to_odrive(RandomBytes& random) {
  return with_random_bytes(frame(static_cast<std::uint32_t>(0x60 + random.below(0x40)), {}), random);
}

CanFrame random_to_vesc(RandomBytes& random) {
  constexpr std::array<std::uint32_t, 4> kWhom{23, 24, 254, 0};
  const auto number = static_cast<std::uint32_t>(random.below(32));
  return with_random_bytes(extended(number << 8U | kWhom[random.below(4)], {}), random);
}

/// What only a master sends to nodes 3 and 4: every command that sets, and a request that feeds the watchdog.
std::vector<CanFrame> masters_of_odrives() {
  std::vector<CanFrame> frames{remote(0x069), remote(0x081)};
  for (const std::uint32_t number :
       {0x02U, 0x04U, 0x07U, 0x0BU, 0x0CU, 0x0DU, 0x0EU, 0x0FU, 0x16U, 0x18U, 0x19U, 0x1BU, 0x1FU}) {
    frames.push_back(frame(3 << 5 | number, {0, 0, 0, 0, 0, 0, 0, 0}));
    frames.push_back(frame(4 << 5 | number, {0, 0, 0, 0}));
  }
  return frames;
}

/// Speeds, currents and questions to controllers 23, 24 and to all; and answers that were not asked for.
std::vector<CanFrame> masters_of_vescs() {
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

DriveKind cia402() {
  return {
      .name = "CiA 402",
      .make = make<Cia402>,
      .reserved_id = 1,  // the controller's own
      .brake_radps2 = 10.0 / 3.0,
      .tolerance_radps = 0.3,
      .travelled_rad = 1.6,  // 0.4 s of ramp are 0.4 rad, 0.6 s at 2 rad/s 1.2 more
      .enabling_ticks = 10,
      .stop_ticks = 8,  // 100 ms of quick stop, a tick to hear it and one to say it
      .proof_ticks = 150,
      .absent_ticks = 10,     // of the 300 ms that it listens
      .given_up_ticks = 230,  // 39 questions, 100 ms each
      .disarm_ticks = 5,
      .own_stop = 182ms,  // missed 100 ms after the last heartbeat, 100 ms of ramp, two steps
      .noticed = 0ms,
      .fault = DriveTrouble::kEmergency,
      .broken = "node 6: emergency 2310h (continuous over-current)",
      .break_down = on<Cia402>([](auto& drive) { drive.raise_fault(0x2310); }),
      .mend = [](DriveBench&, std::size_t) {},
      .lose_watch = on<Cia402>([](auto& drive) {
        drive.objects().fix({0x6007, 0}, 0);
      }),
      .restore_watch = on<Cia402>([](auto& drive) {
        drive.objects().fix({0x6007, 0}, 3);
      }),
      .need_restart = kUnplugged,
      .disobey = {on<Cia402>([](auto& drive) { drive.stick(); })},
      .fall_quiet = {on<Cia402>([](auto& drive) { drive.lose_feedback(); }), kUnplugged},
      .jump = on<Cia402>([](auto& drive) { drive.jump(100.0 * Cia402::kPerRad); }),
      .unproved = "node 5: 6007h:0 stops when the controller is lost: wanted 0003h, refused (read only): NOT PROVED",
      .remedy = "use a drive that can prove it, or allow_unproved at your own risk",
      .second_way = canopen::quick_stop_frames({5, 6}),
      .foreign = "CAN: another master on the bus: ",
      .masters = {frame(0x701, {5}), frame(0x000, {1, 0}), frame(0x080, {}), frame(0x206, {0x0F, 0, 1, 0, 0, 0}),
                  frame(0x505, {0}), frame(0x205, {0x0F, 0, 0, 0, 0, 0}),
                  frame(0x606, {0x40, 0x41, 0x60, 0, 0, 0, 0, 0}), frame(0x585, {0x60, 0x41, 0x60, 0, 0, 0, 0, 0})},
      .strangers = {frame(0x707, {5}), frame(0x087, {0, 0, 0, 0, 0, 0, 0, 0}), frame(0x207, {1}),
                    frame(0x607, {0x40, 0, 0, 0, 0, 0, 0, 0}), frame(0x188, {1, 2})},
      .random_frame = random_to_cia402};
}

DriveKind odrive_axes() {
  return {.name = "ODrive",
          .make = make<Odrive>,
          .reserved_id = 63,
          .brake_radps2 = 8.0,
          .travelled_rad = 1.8,  // 4 turns/s at 20 turns/s2 after 0.2 s: 0.4 turns; then 0.8 s at 4: 3.6 turns
          .enabling_ticks = 20,
          .stop_ticks = 15,
          .proof_ticks = 60,
          .absent_ticks = 30,  // of a second
          .given_up_ticks = 60,
          .disarm_ticks = 10,
          .own_stop = 61ms + 2s,  // 4 turns/s roll out at 2 turns/s2
          .noticed = 170ms,       // 150 ms and a tick
          .brakes_itself = false,
          .broken = "ODrive node 4: error 00001000h (current limit)",
          .break_down = on<Odrive>([](auto& drive) { drive.set_lasting_error(0x1000); }),  // too much current
          .mend = on<Odrive>([](auto& drive) { drive.set_lasting_error(0); }),
          .lose_watch = on<Odrive>([](auto& drive) { drive.set_watchdog(0ms); }),
          .restore_watch = on<Odrive>([](auto& drive) { drive.set_watchdog(60ms); }),
          .need_restart = on<Odrive>([](auto& drive) { drive.go_deaf(); }),
          .disobey = {on<Odrive>([](auto& drive) { drive.stick(); }), on<Odrive>([](auto& drive) { drive.go_deaf(); })},
          .fall_quiet = {on<Odrive>([](auto& drive) { drive.withhold_estimates(); }),
                         on<Odrive>([](auto& drive) { drive.mute(); }), kUnplugged},
          .jump = on<Odrive>([](auto& drive) { drive.jump(100.0 * Odrive::kPerRad); }),
          .unproved = "ODrive node 3: watchdog: nothing said 100 ms after the last command: NOT PROVED",
          .remedy =
              "set enable_watchdog, watchdog_timeout = 0.06 and can.heartbeat_msg_rate_ms = 10 in the ODrive, or "
              "allow_unproved at your own risk",
          .second_way = {odrive::set_velocity(3, 0.0F), odrive::set_velocity(4, 0.0F)},
          .foreign = "CAN: another program commands the drives: frame ",
          .masters = masters_of_odrives(),
          .strangers = {frame(0x0AD, {0, 0, 0, 0}),       // a speed for node 5
                        frame(0x074, {0, 0, 0, 0}),       // node 3's motor current
                        extended(0x006D, {0, 0, 0, 0})},  // no ODrive frame
          .random_frame = random_to_odrive};
}

DriveKind vescs() {
  return {.name = "VESC",
          .make = make<Vesc>,
          .reserved_id = 254,  // ours
          .brake_radps2 = 15.0,
          .travelled_rad = 1.9,  // 0.1 s of ramp are 0.1 rad, 0.9 s more at 2 rad/s 1.8
          .enabling_ticks = 5,
          .stop_ticks = 8,  // two to hear it and say it, 100 ms of ramp, before its timeout would brake
          .proof_ticks = 30,
          .absent_ticks = 20,  // of half a second
          .given_up_ticks = 30,
          .disarm_ticks = 1,
          .own_stop = 172ms,  // the last command was 20 ms ago; 90 ms of timeout, 100 ms of ramp, two steps
          .noticed = 170ms,
          .broken = "VESC 24: fault 3 (gate driver)",
          .break_down = on<Vesc>([](auto& drive) { drive.raise_fault(3); }),
          .mend = on<Vesc>([](auto& drive) { drive.raise_fault(0); }),
          .lose_watch = on<Vesc>([](auto& drive) { drive.set_timeout(1000, 0.0F); }),
          .restore_watch = on<Vesc>([](auto& drive) { drive.set_timeout(90, 10.0F); }),
          .need_restart = on<Vesc>([](auto& drive) { drive.go_deaf(); }),
          .disobey = {on<Vesc>([](auto& drive) { drive.stick(); }), on<Vesc>([](auto& drive) { drive.go_deaf(); })},
          .fall_quiet = {on<Vesc>([](auto& drive) { drive.mute(); }), kUnplugged},
          .jump = on<Vesc>([](auto& drive) { drive.jump(100.0 * Vesc::kPerRad); }),
          .unproved = "VESC 23: timeout: wanted 40 to 90 ms, reads 1000 ms, then brakes with 0.0 A: NOT PROVED",
          .remedy =
              "set timeout and timeout brake current (App Settings, General) with VESC Tool, or allow_unproved at "
              "your own risk",
          .second_way = {vesc::set_erpm(23, 0), vesc::set_erpm(24, 0)},
          .foreign = "CAN: another program commands the drives: frame ",
          .masters = masters_of_vescs(),
          .strangers = {extended(0x0319, {0, 0, 0, 0}),              // a speed for controller 25
                        extended(0x0E17, {0, 0, 0, 0, 0, 0, 0, 0}),  // status message 2 of controller 23
                        frame(0x317, {0, 0, 0, 0})},                 // no VESC frame
          .random_frame = random_to_vesc};
}

DriveEvent on_board(void (*event)(emulators::ArcosBoard&, std::size_t side)) {
  return [event](DriveBench& bench, std::size_t side) { event(dynamic_cast<ArcosBench&>(bench).board, side); };
}

std::unique_ptr<DriveBench> make_arcos(const BenchChanges& changes) {
  auto setup = ArcosBench::setup();
  setup.allow_unproved = changes.allow_unproved;
  setup.tick = changes.tick;
  if (changes.per_rad) setup.mm_per_rad = {*changes.per_rad, *changes.per_rad};
  if (changes.tick != 20ms) setup.stop = stop_limits(setup.stop.brake_radps2, setup.stop.tolerance_radps, changes.tick);
  auto bench = std::make_unique<ArcosBench>(setup);
  bench->tick = changes.tick;
  return bench;
}

/// What looks like the beginning of a packet, or is one that the board obeys, each one time in eight.
CanFrame random_to_arcos(RandomBytes& random) {
  CanFrame made = with_random_bytes(frame(0, {}), random);
  const std::size_t kind = random.below(8);
  if (kind == 0) made.bytes[0] = 0xFA, made.bytes[1] = 0xFB;
  if (kind != 1) return made;
  constexpr std::array kWords{arcos::Command::kPulse, arcos::Command::kClose, arcos::Command::kEmergencyStop};
  in_frames(arcos::packet_of({kWords[random.below(3)]}).on_line(), [&made](const CanFrame& all) { made = all; });
  return made;
}

DriveKind arcos_boards() {
  return {.name = "Pioneer",
          .make = make_arcos,
          .brake_radps2 = 15.0,
          .travelled_rad = 1.9,  // 0.1 s of ramp are 0.1 rad, 0.9 s more at 2 rad/s 1.8
          .enabling_ticks = 12,
          .stop_ticks = 40,  // without torque it rolls out: 0.67 s
          .proof_ticks = 70,
          .absent_ticks = 30,  // of 3 s
          .given_up_ticks = 160,
          .disarm_ticks = 2,
          .own_stop = 182ms,  // the last word was 20 ms ago; 100 ms of watchdog, 100 ms of ramp, two steps
          .noticed = 170ms,
          .restarted = DriveTrouble::kDriveSilent,  // it says nothing before a new connection
          .broken = "Pioneer: right wheel stalled",
          .break_down = on_board([](auto& board, std::size_t side) { board.stall(side, true); }),
          .mend = on_board([](auto& board, std::size_t side) { board.stall(side, false); }),
          .lose_watch = on_board([](auto& board, std::size_t) { board.set_watchdog(2000); }),
          .restore_watch = on_board([](auto& board, std::size_t) { board.set_watchdog(100); }),
          .need_restart = on_board([](auto& board, std::size_t side) { board.go_deaf(side); }),
          .disobey = {on_board([](auto& board, std::size_t side) { board.go_deaf(side); }),
                      on_board([](auto& board, std::size_t side) { board.stick(side); })},
          .fall_quiet = {on_board([](auto& board, std::size_t) { board.mute(); }), kUnplugged},
          .jump = on_board([](auto& board, std::size_t side) { board.jump(side, 10000.0); }),
          .unproved =
              "line: Pioneer p3dx-sh, SipCycle 20, TicksMM 128, TransAccel 2000, TransDecel 2000, RotAccel 800, "
              "RotDecel 800, TransVelMax 600, RotVelMax 250, Watchdog 2000 (wanted 40 to 100): NOT PROVED",
          .remedy = "set Watchdog in the board's FLASH (ARCOScfg), or allow_unproved at your own risk",
          .second_way = arcos::stop_frames(),
          .random_frame = random_to_arcos};
}

}  // namespace

const std::vector<DriveKind>& drive_kinds() {
  static const std::vector<DriveKind> kinds{cia402(), odrive_axes(), vescs(), arcos_boards()};
  return kinds;
}

}  // namespace jaywalk::tests
