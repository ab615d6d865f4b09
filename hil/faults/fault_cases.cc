#include <algorithm>
#include <array>
#include <limits>

#include "hil/faults/fault_bench.h"
#include "hil/faults/fault_matrix.h"

namespace jaywalk::faults {
namespace {

using namespace std::chrono_literals;
using emulators::ScannerFault;

/// What another master would tell the left drive.
CanFrame foreign_setpoint(DriveKind kind) {
  CanFrame frame;
  frame.size = 8;
  frame.extended = kind == DriveKind::kVesc;
  frame.id = kind == DriveKind::kVesc ? 0x317 : kind == DriveKind::kOdrive ? 3U << 5U | 0x0DU : 0x202;
  if (kind == DriveKind::kVesc) frame.size = 4;
  if (kind == DriveKind::kCia402) frame.size = 6;
  return frame;
}

CanFrame foreign_heartbeat() {
  CanFrame frame;
  frame.id = 0x701;
  frame.size = 1;
  frame.bytes = {0x05};
  return frame;
}

void tell_network(FaultBench& bench, std::uint8_t command) {
  CanFrame frame;
  frame.size = 2;
  frame.bytes = {command, 0};  // every node
  bench.say_as_stranger(frame);
}

void stick_and_stop(FaultBench& bench, rig::WheelDrive& drive) {
  drive.stick();
  (void)bench.robot().desk().obey("stop now");
}

/// A reset, and a stop while the drives are being proved for it: the end of the proof lifts no latch.
void reset_and_stop(FaultBench& bench) {
  bench.wait(1s);
  (void)bench.robot().desk().obey("reset");
  bench.wait(2 * bench.tick_length());
  (void)bench.robot().desk().obey("stop now");
  bench.wait(6s);
}

void say_goal(FaultBench& bench) { (void)bench.robot().desk().obey("goto 42 2.5"); }

/// A plain stop, which a client that repeats its goal does not undo, on the way to rest and there.
FaultCase stop_among_goals() {
  FaultCase fault{"stop_among_goals",
                  [](FaultBench& b) {
                    say_goal(b), say_goal(b);
                    (void)b.robot().desk().obey("stop");
                  },
                  Reason::kNoGoal,
                  in_comfort,
                  Outcome::kStopped,
                  say_goal};
  fault.at_rest = [](FaultBench& b) {
    for (int k = 0; k < 100; ++k) say_goal(b), b.wait(b.tick_length());
  };
  return fault;
}

void scanner(FaultBench& bench, ScannerFault fault, std::size_t index = 0) {
  bench.robot().far_end().scanner(index).order(fault, 60s);
}

/// The fault strikes this scanner of a robot with two; the other one goes on.
FaultCase of_two(std::size_t scanner, FaultCase fault) {
  fault.of_two = scanner;
  return fault;
}

FaultCase rolling_out(RollsOut which, FaultCase fault) {
  fault.rolls_out = which;
  return fault;
}

FaultCase of_bus(FaultCase fault) {
  fault.of_bus = true;
  return fault;
}

FaultCase of_cia402(FaultCase fault) {
  fault.only = DriveKind::kCia402;
  return fault;
}

FaultCase network(const char* name, void (*tell)(FaultBench&)) {
  FaultCase fault{name, tell, Reason::kForeignMaster | Reason::kDrive, taken_over};
  fault.every_tick = tell;
  return of_cia402(fault);
}

FaultCase stop_ignored(const char* name, void (*strike)(FaultBench&)) {
  FaultCase fault{name, strike, Reason::kStopUnconfirmed, escalated};
  fault.after_ramp = true;
  return rolling_out(RollsOut::kMotors, fault);
}

/// At rest after a stop, not latched; half a second without power.
void restart_at_rest(FaultBench& bench, rig::WheelDrive& drive) {
  drive.pull_cable();
  bench.wait(500ms);
  drive.plug_cable();
  drive.restart();
  bench.wait(200ms);
}

FaultCase restarts_at_rest(const char* name, void (*restart)(FaultBench&)) {
  FaultCase fault{name, [](FaultBench& b) { (void)b.robot().desk().obey("stop"); }, Reason::kDrive, in_comfort};
  fault.at_rest = restart;
  return fault;
}

FaultCase stop_in_proof() {
  FaultCase fault{"stop_in_proof", [](FaultBench& b) { b.right_drive().restart(); },
                  Reason::kDrive | Reason::kWheelsDisobey, feedback};
  fault.at_rest = reset_and_stop;
  return rolling_out(RollsOut::kAll, fault);
}

/// Beams within so much of straight ahead claim that nothing is within reach.
void say_free(FaultBench& bench, double half_deg) {
  const double half_rad = std::min(half_deg, 179.9) * kPi / 180.0;
  bench.scanner().lose_sector(-half_rad, half_rad, std::numeric_limits<float>::infinity());
}

FaultCase claiming_free(const char* name, void (*strike)(FaultBench&), Outcome outcome) {
  FaultCase fault{name, strike, Reason::kUnwatched | Reason::kScanInvalid | Reason::kSightLost, next_scan, outcome};
  fault.claims_free = true;
  return fault;
}

/// What the supervisor itself must tell: wheels and scanner that contradict each other or the command.
FaultCase contradiction(const char* name, void (*strike)(FaultBench&) = nullptr,
                        Duration (*limit)(Duration) noexcept = shows_for) {
  FaultCase fault{name, strike, Reason::kWheelsDisobey | Reason::kMotionMismatch | Reason::kScanFrozen, limit};
  fault.in_turn = true;
  return fault;
}

FaultCase miswired(const char* name, sim::FaultKind kind) {
  FaultCase fault = contradiction(name);
  fault.miswiring = kind;
  return fault;
}

FaultCase wheels_go(const char* name, double times, Duration (*limit)(Duration) noexcept) {
  FaultCase fault = contradiction(name, nullptr, limit);
  fault.wheels_go = times;
  return fault;
}

/// A person lifts the robot as it stands.
FaultCase carried(const char* name, void (*strike)(FaultBench&)) {
  FaultCase fault{name, strike, Reason::kPoseDoubtful, shows_for};
  fault.at_rest_only = true;
  return fault;
}

/// Drives that report their mode 30 ms after enabling, as some makers' do. The robot comes up to speed.
FaultCase mode_shown_late() {
  FaultCase fault{"mode_shown_late", [](FaultBench& b) { (void)b.robot().desk().obey("stop now"); },
                  Reason::kEmergencyStop, at_once};
  fault.from_start = [](FaultBench& b) { b.left_drive().show_mode_late(30ms), b.right_drive().show_mode_late(30ms); };
  return of_cia402(fault);
}

/// VESCs with a minimum ERPM above the robot's fastest speed: no wheel turns.
FaultCase below_minimum_erpm() {
  constexpr double kOverAll_radps = 15.0;  // 1.4 m/s
  FaultCase fault = contradiction("below_minimum_erpm", nullptr, in_first_way);
  fault.only = DriveKind::kVesc;
  fault.from_start = [](FaultBench& b) {
    b.left_drive().let_go_below(kOverAll_radps), b.right_drive().let_go_below(kOverAll_radps);
  };
  return fault;
}

/// A Pioneer's stop button, which its board tells in its next report.
FaultCase stop_button() {
  FaultCase fault{"stop_button", [](FaultBench& b) { b.left_drive().press_stop(); }, Reason::kDrive, at_once};
  fault.only = DriveKind::kPioneer;
  return fault;
}

/// A Pioneer as it comes from the factory, armed because its robot file allows that: its watchdog takes two seconds.
FaultCase factory_watchdog() {
  FaultCase fault{"factory_watchdog", [](FaultBench& b) { b.hold_up(Duration::max()); }, Reason::kNone,
                  [](Duration tick) noexcept -> Duration { return 2s + at_once(tick); }, Outcome::kDead};
  fault.only = DriveKind::kPioneer;
  fault.allow_unproved = true;
  fault.from_start = [](FaultBench& b) { b.left_drive().set_watchdog(2s); };
  return fault;
}

void deceive(FaultBench& bench, const rig::FalseSenses& senses) { bench.robot().far_end().deceive(senses); }

const std::array kCases{
    FaultCase{"emergency_stop", [](FaultBench& b) { (void)b.robot().desk().obey("stop now"); }, Reason::kEmergencyStop,
              at_once},
    stop_among_goals(),
    stop_in_proof(),
    FaultCase{"scanner_silent", [](FaultBench& b) { scanner(b, ScannerFault::kSilence); }, Reason::kScanStale, scans},
    FaultCase{"scanner_gone", [](FaultBench& b) { scanner(b, ScannerFault::kGone); }, Reason::kScanStale, scans},
    FaultCase{"scanner_garbage", [](FaultBench& b) { scanner(b, ScannerFault::kGarbage); }, Reason::kScanStale, scans},
    FaultCase{"scanner_damaged", [](FaultBench& b) { scanner(b, ScannerFault::kDamage); }, Reason::kScanStale, scans},
    of_two(0, {"front_gone", [](FaultBench& b) { scanner(b, ScannerFault::kGone); }, Reason::kScanStale, scans}),
    of_two(1, {"rear_gone", [](FaultBench& b) { scanner(b, ScannerFault::kGone, 1); }, Reason::kScanStale, scans}),
    of_two(1, {"rear_late", [](FaultBench& b) { scanner(b, ScannerFault::kDelayed, 1); }, Reason::kScanStale, scans}),
    of_two(1, {"rear_covered", [](FaultBench& b) { b.robot().far_end().scanner(1).lose_sector(-kPi, 3.1); },
               Reason::kScanInvalid | Reason::kSightLost, next_scan}),
    FaultCase{"plan_absent", [](FaultBench& b) { b.planner().order(PlanFault::kNoMore); }, Reason::kPlanStale, plans,
              Outcome::kStopped},
    rolling_out(RollsOut::kMotors, {"drive_unplugged_left", [](FaultBench& b) { b.left_drive().pull_cable(); },
                                    Reason::kWheelsStale | Reason::kDrive, feedback}),
    rolling_out(RollsOut::kMotors, {"drive_unplugged_right", [](FaultBench& b) { b.right_drive().pull_cable(); },
                                    Reason::kWheelsStale | Reason::kDrive, feedback}),
    rolling_out(RollsOut::kMotors,
                {"drive_fault_left", [](FaultBench& b) { b.left_drive().raise_fault(0x21); }, Reason::kDrive, at_once}),
    rolling_out(RollsOut::kMotors, {"drive_fault_right", [](FaultBench& b) { b.right_drive().raise_fault(0x21); },
                                    Reason::kDrive, at_once}),
    rolling_out(RollsOut::kMotors,
                {"bus_refuses_frames", [](FaultBench& b) { b.controllers_port().refuse_sends(1000000); }, Reason::kBus,
                 by_themselves}),
    of_bus(rolling_out(RollsOut::kMotors,
                       {"bus_off", [](FaultBench& b) { b.controllers_port().set_state(CanState::kBusOff); },
                        Reason::kBus, by_themselves})),
    of_bus({"bus_passive", [](FaultBench& b) { b.controllers_port().set_state(CanState::kPassive); }, Reason::kBus,
            at_once}),
    rolling_out(RollsOut::kMotors,
                {"interface_down", [](FaultBench& b) { b.controllers_port().set_state(CanState::kDown); }, Reason::kBus,
                 by_themselves}),
    FaultCase{"two_ticks_missed", [](FaultBench& b) { b.hold_up(5 * b.tick_length() / 2); }, Reason::kMissedTicks,
              two_ticks},
    rolling_out(RollsOut::kMotors,
                {"controller_hangs", [](FaultBench& b) { b.hold_up(400ms); }, Reason::kMissedTicks, by_themselves}),
    rolling_out(RollsOut::kMotors, {"controller_dies", [](FaultBench& b) { b.hold_up(Duration::max()); }, Reason::kNone,
                                    by_themselves, Outcome::kDead}),
    FaultCase{"scanner_late", [](FaultBench& b) { scanner(b, ScannerFault::kDelayed); }, Reason::kScanStale, scans},
    FaultCase{"scanner_dirty", [](FaultBench& b) { (void)b.scanner().set_window(emulators::Window::kDirty); },
              Reason::kScanStale, scans},
    FaultCase{"beams_lost_ahead", [](FaultBench& b) { b.scanner().lose_sector(-kPi / 3.0, kPi / 3.0); },
              Reason::kUnwatched, next_scan, Outcome::kStopped},
    FaultCase{"beams_lost_all_round", [](FaultBench& b) { b.scanner().lose_sector(-kPi, 3.1); },
              Reason::kScanInvalid | Reason::kSightLost, next_scan},
    claiming_free(
        "nothing_ahead_claimed", [](FaultBench& b) { say_free(b, 40.0); }, Outcome::kStopped),
    claiming_free(
        "nothing_all_round_claimed", [](FaultBench& b) { say_free(b, 180.0); }, Outcome::kLatched),
    rolling_out(RollsOut::kMotors, {"feedback_lost_left", [](FaultBench& b) { b.left_drive().lose_feedback(); },
                                    Reason::kWheelsStale | Reason::kDrive, feedback}),
    rolling_out(RollsOut::kMotors, {"feedback_lost_right", [](FaultBench& b) { b.right_drive().lose_feedback(); },
                                    Reason::kWheelsStale | Reason::kDrive, feedback}),
    rolling_out(RollsOut::kAll, {"drive_restarts_left", [](FaultBench& b) { b.left_drive().restart(); },
                                 Reason::kDrive | Reason::kWheelsDisobey, feedback}),
    rolling_out(RollsOut::kAll, {"drive_restarts_right", [](FaultBench& b) { b.right_drive().restart(); },
                                 Reason::kDrive | Reason::kWheelsDisobey, feedback}),
    stop_ignored("stop_ignored_left", [](FaultBench& b) { stick_and_stop(b, b.left_drive()); }),
    stop_ignored("stop_ignored_right", [](FaultBench& b) { stick_and_stop(b, b.right_drive()); }),
    network("network_preoperational", [](FaultBench& b) { tell_network(b, 0x80); }),
    network("network_stopped", [](FaultBench& b) { tell_network(b, 0x02); }),
    of_cia402({"foreign_heartbeat", [](FaultBench& b) { b.say_as_stranger(foreign_heartbeat()); },
               Reason::kForeignMaster, at_once}),
    of_bus({"foreign_setpoint", [](FaultBench& b) { b.say_as_stranger(foreign_setpoint(b.kind())); },
            Reason::kForeignMaster, at_once}),
    of_bus(
        rolling_out(RollsOut::kMotors, {"twin_left", [](FaultBench& b) { b.add_twin(0); },
                                        Reason::kForeignMaster | Reason::kDrive | Reason::kWheelsDisobey, feedback})),
    of_bus(
        rolling_out(RollsOut::kMotors, {"twin_right", [](FaultBench& b) { b.add_twin(1); },
                                        Reason::kForeignMaster | Reason::kDrive | Reason::kWheelsDisobey, feedback})),
    restarts_at_rest("restarts_at_rest_left", [](FaultBench& b) { restart_at_rest(b, b.left_drive()); }),
    restarts_at_rest("restarts_at_rest_right", [](FaultBench& b) { restart_at_rest(b, b.right_drive()); }),
    miswired("both_motors_reversed", sim::FaultKind::kBothMotorsReversed),
    miswired("left_motor_reversed", sim::FaultKind::kLeftMotorReversed),
    miswired("left_wheel_reversed", sim::FaultKind::kLeftWheelReversed),
    miswired("wheels_swapped", sim::FaultKind::kWheelsSwapped),
    miswired("left_wheel_stuck", sim::FaultKind::kLeftWheelStuck),
    miswired("scanner_mirrored", sim::FaultKind::kScannerMirrored),
    miswired("no_grip", sim::FaultKind::kNoGrip),
    wheels_go("wheels_go_twice", 2.0, shows_for),
    wheels_go("wheels_go_thrice", 3.0, shows_for),
    wheels_go("wheels_go_tenfold", 10.0, shows_for),
    wheels_go("wheels_go_half", 0.5, slips_for),
    contradiction(
        "scan_repeats",
        [](FaultBench& b) {
          deceive(b, {.repeats = {-4.0, 4.0}});
        },
        repeats_for),
    of_two(1, contradiction(
                  "rear_repeats",
                  [](FaultBench& b) {
                    deceive(b, {.repeats = {-4.0, 4.0}, .scanner = 1});
                  },
                  repeats_for)),
    contradiction("scan_repeats_ahead",
                  [](FaultBench& b) {
                    deceive(b, {.repeats = {-0.7, 0.7}});
                  }),
    mode_shown_late(),
    below_minimum_erpm(),
    stop_button(),
    factory_watchdog(),
    contradiction("scanner_turned_20", [](FaultBench& b) { deceive(b, {.mount_turned_rad = 0.35}); }),
    carried("carried_1_m",
            [](FaultBench& b) {
              b.robot().far_end().carry({0.8, 0.6, 0.0});
            }),
    carried("carried_3_m",
            [](FaultBench& b) {
              b.robot().far_end().carry({2.9, -0.8, 0.0});
            }),
    carried("turned_by_hand",
            [](FaultBench& b) {
              b.robot().far_end().carry({0.0, 0.0, 1.0});
            }),
    contradiction("counters_stand", [](FaultBench& b) { deceive(b, {.counters_stand = true}); }),
    contradiction(
        "speeds_stand", [](FaultBench& b) { deceive(b, {.speeds_stand = true}); }, changes_for),
    contradiction(
        "feedback_ages", [](FaultBench& b) { deceive(b, {.feedback_ages = 0.1}); }, ages_for),
};

}  // namespace

std::span<const FaultCase> all_cases() noexcept { return kCases; }

}  // namespace jaywalk::faults
