#pragma once
#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <string_view>

#include "hal/types/geometry.h"

namespace jaywalk {
/// Why the supervisor permits less than was wanted, or nothing is wanted. A set of bits.
enum class Reason : std::uint32_t {
  kNone = 0,
  kStopZone = 1U << 0,          ///< limit: something stands in the way (raw scan)
  kScanStale = 1U << 1,         ///< fault: scan too old
  kScanInvalid = 1U << 2,       ///< fault: scan that cannot be trusted
  kWheelsStale = 1U << 3,       ///< fault: wheel feedback too old
  kPlanStale = 1U << 4,         ///< limit: plan too old or none
  kEmergencyStop = 1U << 5,     ///< fault, latched
  kSpeedLimit = 1U << 6,        ///< limit: faster than allowed
  kMissedTicks = 1U << 7,       ///< fault, latched: two ticks or more in a row did not happen
  kNotFinite = 1U << 8,         ///< fault: a wanted twist that is no number
  kLatched = 1U << 9,           ///< an earlier fault waits for a reset edge
  kUnwatched = 1U << 10,        ///< limit: nothing watches the direction of travel
  kNoGoal = 1U << 11,           ///< nowhere to go
  kBus = 1U << 12,              ///< fault, latched: the drives' bus refuses frames or is unwell
  kDrive = 1U << 13,            ///< fault, latched: a drive is in trouble
  kTurnBlocked = 1U << 14,      ///< no room to turn to the heading wanted at the goal: the robot waits
  kScanFrozen = 1U << 15,       ///< fault: the same scan again and again while the wheels drive
  kTouched = 1U << 16,          ///< limit: a beam ends on the body's own outline, which is in the way of any motion
  kWheelsInvalid = 1U << 17,    ///< fault: wheel feedback that is no number
  kSightLost = 1U << 18,        ///< fault: too many beams prove nothing, for too long
  kWheelsDisobey = 1U << 19,    ///< fault: the wheels' feedback is not what was commanded
  kMotionMismatch = 1U << 20,   ///< fault: the scans show another motion than the wheels' feedback
  kStopUnconfirmed = 1U << 21,  ///< fault, latched: the wheels' feedback does not confirm a stop; it was escalated
  kForeignMaster = 1U << 22,    ///< fault, latched: another program commands the drives
  kNotRecorded = 1U << 23,      ///< remark: the disk takes no more of the recording or the tables
  kSpeedZone = 1U << 24,        ///< limit: faster than the zone in the map where the robot is
  kPoseDoubtful = 1U << 25,     ///< fault, latched: it was carried, or guessed over a gap for too long
  kLast = kPoseDoubtful         ///< the newest
};

constexpr Reason operator|(Reason a, Reason b) {
  return static_cast<Reason>(static_cast<std::uint32_t>(a) | static_cast<std::uint32_t>(b));
}
constexpr Reason& operator|=(Reason& a, Reason b) { return a = a | b; }
constexpr Reason without(Reason set, Reason others) {
  return static_cast<Reason>(static_cast<std::uint32_t>(set) & ~static_cast<std::uint32_t>(others));
}
constexpr bool has(Reason set, Reason bit) {
  return (static_cast<std::uint32_t>(set) & static_cast<std::uint32_t>(bit)) != 0;
}

enum class ReasonKind : std::uint8_t { kRemark, kLimit, kFault, kLatchedFault };

/// A reason's facts: everything that names, explains or judges reasons reads this table.
struct ReasonRow {
  Reason reason;
  const char* name;  ///< in tables and recordings
  ReasonKind kind;
  const char* says;  ///< to a person
};
/// In the order in which to_string() names them.
inline constexpr auto kReasons = std::to_array<ReasonRow>(
    {{Reason::kStopZone, "stop_zone", ReasonKind::kLimit, "something stands in its way"},
     {Reason::kScanStale, "scan_stale", ReasonKind::kFault, "the newest scan is too old"},
     {Reason::kScanInvalid, "scan_invalid", ReasonKind::kFault, "the scan cannot be trusted"},
     {Reason::kScanFrozen, "scan_frozen", ReasonKind::kFault, "the same scan comes again and again"},
     {Reason::kWheelsStale, "wheels_stale", ReasonKind::kFault, "the wheels' feedback is too old"},
     {Reason::kPlanStale, "plan_stale", ReasonKind::kLimit, "no way is known, or the plan is too old"},
     {Reason::kEmergencyStop, "emergency_stop", ReasonKind::kLatchedFault, "the emergency stop is pressed"},
     {Reason::kMissedTicks, "missed_ticks", ReasonKind::kLatchedFault, "the computer was held up"},
     {Reason::kSpeedLimit, "speed_limit", ReasonKind::kLimit, "it is faster than is allowed"},
     {Reason::kNotFinite, "not_finite", ReasonKind::kFault, "what was wanted is no number"},
     {Reason::kLatched, "latched", ReasonKind::kRemark, "a fault waits for a reset"},
     {Reason::kUnwatched, "unwatched", ReasonKind::kLimit, "it cannot see where it would go"},
     {Reason::kNoGoal, "no_goal", ReasonKind::kRemark, "it has no goal"},
     {Reason::kBus, "bus", ReasonKind::kLatchedFault, "the drives' bus is unwell"},
     {Reason::kDrive, "drive", ReasonKind::kLatchedFault, "a drive is in trouble"},
     {Reason::kTurnBlocked, "turn_blocked", ReasonKind::kRemark, "no room to turn to the goal's heading"},
     {Reason::kTouched, "touched", ReasonKind::kLimit, "something touches it, or its scanner sees itself"},
     {Reason::kWheelsInvalid, "wheels_invalid", ReasonKind::kFault, "the wheels' feedback is no number"},
     {Reason::kSightLost, "sight_lost", ReasonKind::kFault, "too many beams prove nothing"},
     {Reason::kWheelsDisobey, "wheels_disobey", ReasonKind::kLatchedFault, "the wheels do not do what they are told"},
     {Reason::kMotionMismatch, "motion_mismatch", ReasonKind::kLatchedFault,
      "the scans show another motion than the wheels feel"},
     {Reason::kStopUnconfirmed, "stop_unconfirmed", ReasonKind::kLatchedFault, "the wheels do not confirm a stop"},
     {Reason::kForeignMaster, "foreign_master", ReasonKind::kLatchedFault, "another program commands the drives"},
     {Reason::kNotRecorded, "not_recorded", ReasonKind::kRemark, "the disk is full"},
     {Reason::kSpeedZone, "speed_zone", ReasonKind::kLimit, "a zone in the map wants it slower"},
     {Reason::kPoseDoubtful, "pose_doubtful", ReasonKind::kLatchedFault,
      "it was carried, or where it is was guessed over a gap"}});

[[nodiscard]] constexpr const ReasonRow& row_of(Reason reason) {
  return *std::find_if(kReasons.begin(), kReasons.end() - 1,
                       [=](const ReasonRow& row) { return row.reason == reason; });
}

constexpr Reason of_kind(ReasonKind kind) {
  Reason set = Reason::kNone;
  for (const ReasonRow& row : kReasons)
    if (row.kind == kind) set |= row.reason;
  return set;
}
inline constexpr Reason kNoFaults = of_kind(ReasonKind::kRemark) | of_kind(ReasonKind::kLimit);
inline constexpr Reason kAlwaysLatched = of_kind(ReasonKind::kLatchedFault);
static_assert((kNoFaults | kAlwaysLatched | of_kind(ReasonKind::kFault)) ==
                  static_cast<Reason>(2 * static_cast<std::uint32_t>(Reason::kLast) - 1),
              "each reason has a row");

/// kNone where there is none of that name.
[[nodiscard]] Reason reason_named(std::string_view name) noexcept;
/// "stop_zone|plan_stale"; empty for none. For reports, never in the loop.
[[nodiscard]] std::string to_string(Reason reasons);
/// And which of several scanners have a fault of theirs, by Verdict::faulty_scanners: "scan_stale|scanner_2".
[[nodiscard]] std::string to_string(Reason reasons, std::uint8_t faulty_scanners);

/// What the supervisor permits this tick, and why it is not what was wanted.
struct Verdict {
  Twist2 permitted;
  Reason reasons = Reason::kNone;
  double gap_m = 0.0;                ///< free way ahead in the direction of travel, +inf when nothing is in it
  std::uint8_t faulty_scanners = 0;  ///< of several, bit k: a fault of scans is scanner k's

  [[nodiscard]] bool is_faulty(std::size_t scanner) const noexcept { return ((faulty_scanners >> scanner) & 1U) != 0; }
};

}  // namespace jaywalk
