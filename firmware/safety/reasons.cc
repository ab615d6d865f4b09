#include "firmware/safety/reasons.h"

#include <array>
#include <utility>

namespace jaywalk {

std::string to_string(Reason reasons) {
  constexpr std::array<std::pair<Reason, const char*>, 26> kNames{{{Reason::kStopZone, "stop_zone"},
                                                                   {Reason::kScanStale, "scan_stale"},
                                                                   {Reason::kScanInvalid, "scan_invalid"},
                                                                   {Reason::kScanFrozen, "scan_frozen"},
                                                                   {Reason::kWheelsStale, "wheels_stale"},
                                                                   {Reason::kPlanStale, "plan_stale"},
                                                                   {Reason::kEmergencyStop, "emergency_stop"},
                                                                   {Reason::kMissedTicks, "missed_ticks"},
                                                                   {Reason::kSpeedLimit, "speed_limit"},
                                                                   {Reason::kNotFinite, "not_finite"},
                                                                   {Reason::kLatched, "latched"},
                                                                   {Reason::kUnwatched, "unwatched"},
                                                                   {Reason::kNoGoal, "no_goal"},
                                                                   {Reason::kBus, "bus"},
                                                                   {Reason::kDrive, "drive"},
                                                                   {Reason::kTurnBlocked, "turn_blocked"},
                                                                   {Reason::kTouched, "touched"},
                                                                   {Reason::kWheelsInvalid, "wheels_invalid"},
                                                                   {Reason::kSightLost, "sight_lost"},
                                                                   {Reason::kWheelsDisobey, "wheels_disobey"},
                                                                   {Reason::kMotionMismatch, "motion_mismatch"},
                                                                   {Reason::kStopUnconfirmed, "stop_unconfirmed"},
                                                                   {Reason::kForeignMaster, "foreign_master"},
                                                                   {Reason::kNotRecorded, "not_recorded"},
                                                                   {Reason::kSpeedZone, "speed_zone"},
                                                                   {Reason::kPoseDoubtful, "pose_doubtful"}}};
  std::string words;
  for (const auto& [bit, name] : kNames) {
    if (!has(reasons, bit)) continue;
    if (!words.empty()) words += '|';
    words += name;
  }
  return words;
}

std::string to_string(Reason reasons, std::uint8_t faulty_scanners) {
  std::string words = to_string(reasons);
  for (int number = 1, left = faulty_scanners; left != 0; ++number, left >>= 1) {
    if ((left & 1) != 0) words += (words.empty() ? "scanner_" : "|scanner_") + std::to_string(number);
  }
  return words;
}

}  // namespace jaywalk
