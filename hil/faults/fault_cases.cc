#include <limits>
#include <vector>

#include "hil/faults/fault_matrix.h"

namespace jaywalk::faults {
namespace {

using namespace std::chrono_literals;
using emulators::ScannerFault;

constexpr auto kMotors = RollsOut::kMotors;
constexpr Reason kFeedback = Reason::kWheelsStale | Reason::kDrive;
constexpr Reason kNewStart = Reason::kDrive | Reason::kWheelsDisobey;
constexpr Reason kBlind = Reason::kScanInvalid | Reason::kSightLost;

/// What another master would tell the left drive.
void say_setpoint(FaultBench& bench) {
  const DriveKind kind = bench.kind();
  if (kind == DriveKind::kVesc) return bench.say_as_stranger({.id = 0x317, .extended = true, .size = 4});
  if (kind == DriveKind::kOdrive) return bench.say_as_stranger({.id = 3U << 5U | 0x0DU, .size = 8});
  bench.say_as_stranger({.id = 0x202, .size = static_cast<std::uint8_t>(kind == DriveKind::kCia402 ? 6 : 8)});
}

void say_heartbeat(FaultBench& bench) { bench.say_as_stranger({.id = 0x701, .size = 1, .bytes = {0x05}}); }

/// To every node.
template <std::uint8_t command>
void tell_network(FaultBench& bench) {
  bench.say_as_stranger({.size = 2, .bytes = {command, 0}});
}

void stop(FaultBench& bench) { bench.tell("stop"); }
void stop_now(FaultBench& bench) { bench.tell("stop now"); }
void say_goal(FaultBench& bench) { bench.tell("goto 42 2.5"); }
void restart(FaultBench& bench) { bench.drive().restart(); }

void stick_and_stop(FaultBench& bench) {
  bench.drive().stick();
  stop_now(bench);
}

/// A reset, and a stop while the drives are being proved for it: the end of the proof lifts no latch.
void reset_and_stop(FaultBench& bench) {
  bench.wait(1s);
  bench.tell("reset");
  bench.wait(2 * bench.tick_length());
  stop_now(bench);
  bench.wait(6s);
}

/// A plain stop, which a client that repeats its goal does not undo, on the way to rest and there.
FaultCase stop_among_goals() {
  return {.name = "stop_among_goals",
          .strike = [](FaultBench& b) { say_goal(b), say_goal(b), stop(b); },
          .reason = Reason::kNoGoal,
          .limit = in_comfort,
          .outcome = Outcome::kStopped,
          .every_tick = say_goal,
          .at_rest =
              [](FaultBench& b) {
                for (int k = 0; k < 100; ++k) say_goal(b), b.wait(b.tick_length());
              }};
}

template <CanState state>
void set_state(FaultBench& bench) {
  bench.controllers_port().set_state(state);
}

template <ScannerFault fault, std::size_t index = 0>
void scanner(FaultBench& bench) {
  bench.robot().far_end().scanner(index).order(fault, 60s);
}

/// The fault strikes this scanner of a robot with two; the other one goes on.
FaultCase of_two(std::size_t scanner, FaultCase fault) {
  fault.of_two = scanner;
  return fault;
}

FaultCase of_bus(FaultCase fault) {
  fault.of_bus = true;
  return fault;
}

FaultCase of_kind(DriveKind kind, FaultCase fault) {
  fault.only = kind;
  return fault;
}

FaultCase network(const char* name, void (*tell)(FaultBench&)) {
  return {.name = name,
          .strike = tell,
          .reason = Reason::kForeignMaster | Reason::kDrive,
          .limit = taken_over,
          .every_tick = tell,
          .only = DriveKind::kCia402};
}

/// At rest after a stop, not latched; half a second without power.
void restart_at_rest(FaultBench& bench) {
  bench.drive().pull_cable();
  bench.wait(500ms);
  bench.drive().plug_cable();
  bench.drive().restart();
  bench.wait(200ms);
}

/// Beams within so much of straight ahead claim that nothing is within reach.
template <int half_deg>
void say_free(FaultBench& bench) {
  constexpr double kHalf_rad = std::min(double{half_deg}, 179.9) * kPi / 180.0;
  bench.scanner().lose_sector(-kHalf_rad, kHalf_rad, std::numeric_limits<float>::infinity());
}

FaultCase claiming_free(const char* name, void (*strike)(FaultBench&), Outcome outcome) {
  return {.name = name,
          .strike = strike,
          .reason = Reason::kUnwatched | kBlind,
          .limit = next_scan,
          .outcome = outcome,
          .claims_free = true};
}

/// What the supervisor itself must tell: wheels and scanner that contradict each other or the command.
FaultCase contradiction(const char* name, void (*strike)(FaultBench&) = nullptr,
                        Duration (*limit)(Duration) noexcept = shows_for) {
  return {.name = name,
          .strike = strike,
          .reason = Reason::kWheelsDisobey | Reason::kMotionMismatch | Reason::kScanFrozen,
          .limit = limit,
          .in_turn = true};
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
  return {.name = name, .strike = strike, .reason = Reason::kPoseDoubtful, .limit = shows_for, .at_rest_only = true};
}

/// Drives that report their mode 30 ms after enabling, as some makers' do. The robot comes up to speed.
FaultCase mode_shown_late() {
  return {.name = "mode_shown_late",
          .strike = stop_now,
          .reason = Reason::kEmergencyStop,
          .limit = at_once,
          .only = DriveKind::kCia402,
          .from_start = [](FaultBench& b) {
            b.drive(0).show_mode_after_enabling(30ms), b.drive(1).show_mode_after_enabling(30ms);
          }};
}

/// VESCs with a minimum ERPM above the robot's fastest speed: no wheel turns.
FaultCase below_minimum_erpm() {
  FaultCase fault = contradiction("below_minimum_erpm", nullptr, in_first_way);
  fault.only = DriveKind::kVesc;
  fault.from_start = [](FaultBench& b) {
    constexpr double kOverAll_radps = 15.0;  // 1.4 m/s
    b.drive(0).let_go_below(kOverAll_radps), b.drive(1).let_go_below(kOverAll_radps);
  };
  return fault;
}

/// A Pioneer as it comes from the factory, armed because its robot file allows that: its watchdog takes two seconds.
FaultCase factory_watchdog() {
  return {.name = "factory_watchdog",
          .strike = [](FaultBench& b) { b.hold_up(Duration::max()); },
          .reason = Reason::kNone,
          .limit = [](Duration tick) noexcept -> Duration { return 2s + at_once(tick); },
          .outcome = Outcome::kDead,
          .only = DriveKind::kPioneer,
          .from_start = [](FaultBench& b) { b.drive().set_watchdog(2s); },
          .allow_unproved = true};
}

void deceive(FaultBench& bench, const rig::FalseSenses& senses) { bench.robot().far_end().deceive(senses); }

/// Beams within so much of straight ahead show the scan from now on.
void repeat(FaultBench& bench, double half_rad, std::size_t scanner = 0) {
  deceive(bench, {.repeats = {-half_rad, half_rad}, .scanner = scanner});
}

void carry(FaultBench& bench, double x_m, double y_m, double turn_rad) {
  bench.robot().far_end().carry({x_m, y_m, turn_rad});
}

const std::vector<FaultCase> kRows{
    {"emergency_stop", stop_now, Reason::kEmergencyStop, at_once},
    stop_among_goals(),
    {.name = "stop_in_proof",
     .strike = [](FaultBench& b) { b.drive(1).restart(); },
     .reason = kNewStart,
     .limit = feedback,
     .rolls_out = RollsOut::kAll,
     .at_rest = reset_and_stop},
    {"scanner_silent", scanner<ScannerFault::kSilence>, Reason::kScanStale, scans},
    {"scanner_gone", scanner<ScannerFault::kGone>, Reason::kScanStale, scans},
    {"scanner_garbage", scanner<ScannerFault::kGarbage>, Reason::kScanStale, scans},
    {"scanner_damaged", scanner<ScannerFault::kDamage>, Reason::kScanStale, scans},
    of_two(0, {"front_gone", scanner<ScannerFault::kGone>, Reason::kScanStale, scans}),
    of_two(1, {"rear_gone", scanner<ScannerFault::kGone, 1>, Reason::kScanStale, scans}),
    of_two(1, {"rear_late", scanner<ScannerFault::kDelayed, 1>, Reason::kScanStale, scans}),
    of_two(1, {"rear_covered", [](FaultBench& b) { b.robot().far_end().scanner(1).lose_sector(-kPi, 3.1); }, kBlind,
               next_scan}),
    {"plan_absent", [](FaultBench& b) { b.planner().end(); }, Reason::kPlanStale, plans, RollsOut::kNone,
     Outcome::kStopped},
    {"drive_unplugged_left", [](FaultBench& b) { b.drive().pull_cable(); }, kFeedback, feedback, kMotors,
     Outcome::kLatched, "drive_unplugged_right"},
    {"drive_fault_left", [](FaultBench& b) { b.drive().raise_fault(0x21); }, Reason::kDrive, at_once, kMotors,
     Outcome::kLatched, "drive_fault_right"},
    {"bus_refuses_frames", [](FaultBench& b) { b.controllers_port().refuse_sends(1000000); }, Reason::kBus,
     by_themselves, kMotors},
    of_bus({"bus_off", set_state<CanState::kBusOff>, Reason::kBus, by_themselves, kMotors}),
    of_bus({"bus_passive", set_state<CanState::kPassive>, Reason::kBus, at_once}),
    {"interface_down", set_state<CanState::kDown>, Reason::kBus, by_themselves, kMotors},
    {"two_ticks_missed", [](FaultBench& b) { b.hold_up(5 * b.tick_length() / 2); }, Reason::kMissedTicks, two_ticks},
    {"controller_hangs", [](FaultBench& b) { b.hold_up(400ms); }, Reason::kMissedTicks, by_themselves, kMotors},
    {"controller_dies", [](FaultBench& b) { b.hold_up(Duration::max()); }, Reason::kNone, by_themselves, kMotors,
     Outcome::kDead},
    {"scanner_late", scanner<ScannerFault::kDelayed>, Reason::kScanStale, scans},
    {"scanner_dirty", [](FaultBench& b) { (void)b.scanner().set_window(emulators::Window::kDirty); },
     Reason::kScanStale, scans},
    {"beams_lost_ahead", [](FaultBench& b) { b.scanner().lose_sector(-kPi / 3.0, kPi / 3.0); }, Reason::kUnwatched,
     next_scan, RollsOut::kNone, Outcome::kStopped},
    {"beams_lost_all_round", [](FaultBench& b) { b.scanner().lose_sector(-kPi, 3.1); }, kBlind, next_scan},
    claiming_free("nothing_ahead_claimed", say_free<40>, Outcome::kStopped),
    claiming_free("nothing_all_round_claimed", say_free<180>, Outcome::kLatched),
    {"feedback_lost_left", [](FaultBench& b) { b.drive().lose_feedback(); }, kFeedback, feedback, kMotors,
     Outcome::kLatched, "feedback_lost_right"},
    {"drive_restarts_left", restart, kNewStart, feedback, RollsOut::kAll, Outcome::kLatched, "drive_restarts_right"},
    {.name = "stop_ignored_left",
     .strike = stick_and_stop,
     .reason = Reason::kStopUnconfirmed,
     .limit = escalated,
     .rolls_out = kMotors,
     .right_too = "stop_ignored_right",
     .after_ramp = true},
    network("network_preoperational", tell_network<0x80>),
    network("network_stopped", tell_network<0x02>),
    of_kind(DriveKind::kCia402, {"foreign_heartbeat", say_heartbeat, Reason::kForeignMaster, at_once}),
    of_bus({"foreign_setpoint", say_setpoint, Reason::kForeignMaster, at_once}),
    of_bus({"twin_left", [](FaultBench& b) { b.add_twin(); }, Reason::kForeignMaster | kNewStart, feedback, kMotors,
            Outcome::kLatched, "twin_right"}),
    {.name = "restarts_at_rest_left",
     .strike = stop,
     .reason = Reason::kDrive,
     .limit = in_comfort,
     .right_too = "restarts_at_rest_right",
     .at_rest = restart_at_rest},
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
        "scan_repeats", [](FaultBench& b) { repeat(b, 4.0); }, repeats_for),
    of_two(1, contradiction(
                  "rear_repeats", [](FaultBench& b) { repeat(b, 4.0, 1); }, repeats_for)),
    contradiction("scan_repeats_ahead", [](FaultBench& b) { repeat(b, 0.7); }),
    mode_shown_late(),
    below_minimum_erpm(),
    of_kind(DriveKind::kPioneer,
            {"stop_button", [](FaultBench& b) { b.drive().press_stop(); }, Reason::kDrive, at_once}),
    factory_watchdog(),
    contradiction("scanner_turned_20", [](FaultBench& b) { deceive(b, {.mount_turned_rad = 0.35}); }),
    carried("carried_1_m", [](FaultBench& b) { carry(b, 0.8, 0.6, 0.0); }),
    carried("carried_3_m", [](FaultBench& b) { carry(b, 2.9, -0.8, 0.0); }),
    carried("turned_by_hand", [](FaultBench& b) { carry(b, 0.0, 0.0, 1.0); }),
    contradiction("counters_stand", [](FaultBench& b) { deceive(b, {.counters_stand = true}); }),
    contradiction(
        "speeds_stand", [](FaultBench& b) { deceive(b, {.speeds_stand = true}); }, changes_for),
    contradiction(
        "feedback_ages", [](FaultBench& b) { deceive(b, {.feedback_ages = 0.1}); }, ages_for)};

/// The rows, with the right drive's fault after the left one's.
std::vector<FaultCase> with_right_drives() {
  std::vector<FaultCase> cases;
  for (const FaultCase& row : kRows) {
    cases.push_back(row);
    if (row.right_too == nullptr) continue;
    cases.push_back(row);
    cases.back().name = row.right_too;
    cases.back().side = 1;
  }
  return cases;
}

}  // namespace

std::span<const FaultCase> all_cases() {
  static const std::vector<FaultCase> cases = with_right_drives();
  return cases;
}

}  // namespace jaywalk::faults
