#include "firmware/faults/fault_cases.h"

#include <array>

namespace jaywalk::faults {
namespace {

using namespace std::chrono_literals;
using emulators::ScannerFault;

/// Two periods of the loop: what happens just after a tick is seen by the next, whose frames the drives obey with the
/// one after it; and what a ramp takes to be 5 mm/s below the speed before it.
constexpr Duration kAtOnce = 40ms + 20ms;
/// The drives' own watchdog or heartbeat consumer, 100 ms at most, after the frame before it; a wheel that nothing
/// brakes is 5 mm/s slower only after 40 ms more.
constexpr Duration kByThemselves = 100ms + kAtOnce;
/// 60 ms without feedback.
constexpr Duration kFeedback = 60ms + kAtOnce;
/// Two scans of 15 Hz that do not come, and the age of the one before.
constexpr Duration kScans = 300ms;
/// Plans are good for 0.3 s, and then the speed falls until they are a second old; the scan that they rest on is
/// older than they are.
constexpr Duration kPlans = 600ms;

void scanner(FaultBench& bench, ScannerFault fault) { bench.robot().far_end().scanner().order(fault, 60s); }

constexpr std::array kCases{
    FaultCase{"emergency_stop", [](FaultBench& b) { (void)b.robot().desk().obey("stop now"); }, nullptr,
              Reason::kEmergencyStop, kAtOnce, Outcome::kLatched},
    FaultCase{"scanner_silent", [](FaultBench& b) { scanner(b, ScannerFault::kSilence); }, nullptr, Reason::kScanStale,
              kScans, Outcome::kLatched},
    FaultCase{"scanner_gone", [](FaultBench& b) { scanner(b, ScannerFault::kGone); }, nullptr, Reason::kScanStale,
              kScans, Outcome::kLatched},
    FaultCase{"scanner_garbage", [](FaultBench& b) { scanner(b, ScannerFault::kGarbage); }, nullptr, Reason::kScanStale,
              kScans, Outcome::kLatched},
    FaultCase{"scanner_damaged", [](FaultBench& b) { scanner(b, ScannerFault::kDamage); }, nullptr, Reason::kScanStale,
              kScans, Outcome::kLatched},
    FaultCase{"plan_absent", [](FaultBench& b) { b.planner().order(PlanFault::kNoMore); }, nullptr, Reason::kPlanStale,
              kPlans, Outcome::kStopped},
    FaultCase{"drive_unplugged_left",
              [](FaultBench& b) { b.left_drive().pull_cable(); },
              nullptr,
              Reason::kWheelsStale | Reason::kDrive,
              kFeedback,
              Outcome::kLatched,
              {},
              true},
    FaultCase{"drive_unplugged_right",
              [](FaultBench& b) { b.right_drive().pull_cable(); },
              nullptr,
              Reason::kWheelsStale | Reason::kDrive,
              kFeedback,
              Outcome::kLatched,
              {},
              true},
    FaultCase{"drive_fault_left",
              [](FaultBench& b) { b.left_drive().raise_fault(0x21); },
              nullptr,
              Reason::kDrive,
              kAtOnce,
              Outcome::kLatched,
              {},
              true},
    FaultCase{"drive_fault_right",
              [](FaultBench& b) { b.right_drive().raise_fault(0x21); },
              nullptr,
              Reason::kDrive,
              kAtOnce,
              Outcome::kLatched,
              {},
              true},
    FaultCase{"bus_refuses_frames",
              [](FaultBench& b) { b.controllers_port().refuse_sends(1000000); },
              nullptr,
              Reason::kBus,
              kByThemselves,
              Outcome::kLatched,
              {},
              true},
    FaultCase{"bus_off",
              [](FaultBench& b) { b.controllers_port().set_state(CanState::kBusOff); },
              nullptr,
              Reason::kBus,
              kByThemselves,
              Outcome::kLatched,
              {},
              true},
    FaultCase{"bus_passive", [](FaultBench& b) { b.controllers_port().set_state(CanState::kPassive); }, nullptr,
              Reason::kBus, kAtOnce, Outcome::kLatched},
    FaultCase{"interface_down",
              [](FaultBench& b) { b.controllers_port().set_state(CanState::kDown); },
              nullptr,
              Reason::kBus,
              kByThemselves,
              Outcome::kLatched,
              {},
              true},
    FaultCase{"two_ticks_missed", [](FaultBench& b) { b.hold_up(50ms); }, nullptr, Reason::kMissedTicks, 50ms + kAtOnce,
              Outcome::kLatched},
    FaultCase{"controller_hangs",
              [](FaultBench& b) { b.hold_up(400ms); },
              nullptr,
              Reason::kMissedTicks,
              kByThemselves,
              Outcome::kLatched,
              {},
              true},
    FaultCase{"controller_dies",
              [](FaultBench& b) { b.hold_up(Duration::max()); },
              nullptr,
              Reason::kNone,
              kByThemselves,
              Outcome::kDead,
              {},
              true},
};

}  // namespace

std::span<const FaultCase> all_cases() noexcept { return kCases; }

}  // namespace jaywalk::faults
