#pragma once
#include <cstdint>
#include <string>

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
  kPoseDoubtful = 1U << 25,     ///< fault, latched: where it is was guessed over a gap for too long
};

constexpr Reason operator|(Reason a, Reason b) {
  return static_cast<Reason>(static_cast<std::uint32_t>(a) | static_cast<std::uint32_t>(b));
}
constexpr Reason& operator|=(Reason& a, Reason b) { return a = a | b; }
/// `set` less what is in `others`.
constexpr Reason without(Reason set, Reason others) {
  return static_cast<Reason>(static_cast<std::uint32_t>(set) & ~static_cast<std::uint32_t>(others));
}
constexpr bool has(Reason set, Reason bit) {
  return (static_cast<std::uint32_t>(set) & static_cast<std::uint32_t>(bit)) != 0;
}

/// Limits, remarks and states: what is no fault.
inline constexpr Reason kNoFaults = Reason::kStopZone | Reason::kPlanStale | Reason::kSpeedLimit | Reason::kUnwatched |
                                    Reason::kNoGoal | Reason::kLatched | Reason::kTurnBlocked | Reason::kTouched |
                                    Reason::kNotRecorded | Reason::kSpeedZone;

/// "stop_zone|plan_stale"; empty for none. For reports, never in the loop.
[[nodiscard]] std::string to_string(Reason reasons);
/// And which of several scanners have a fault of theirs, by Verdict::faulty_scanners: "scan_stale|scanner_2".
[[nodiscard]] std::string to_string(Reason reasons, std::uint8_t faulty_scanners);

}  // namespace jaywalk
