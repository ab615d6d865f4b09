#pragma once
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "drivers/can/can_bus.h"
#include "drivers/laser/scanner_connection.h"
#include "firmware/robot/drive_wiring.h"
#include "firmware/robot/place_check.h"
#include "firmware/robot/realtime.h"
#include "firmware/safety/reasons.h"
#include "hal/types/operator_input.h"
#include "hal/types/wheels.h"
#include "planner/cost_to_go/planner.h"

namespace jaywalk {

/// How a run goes, as the loop tells it after each tick: a field a line of the status, so more than elsewhere.
struct RunStatus {
  bool running = false;  ///< the loop has begun
  Pose2 map_from_robot;
  bool at_rest = true;     ///< told to stand, and not felt to move
  double speed_mps = 0.0;  ///< felt at the wheels; of the faster one; NaN where they were not heard lately
  bool enabled = false;
  bool proved = false;                    ///< the drives passed their whole proof since their last trouble
  std::optional<CanFrame> foreign_frame;  ///< of another master, while that is the trouble
  bool steered = false;                   ///< a person drives by the stick; an earlier goal must be given anew
  bool has_goal = false;
  bool turns_at_goal = false;  ///< has come to the goal and turns to the heading wanted there
  std::size_t goals_left = 0;  ///< of the route, the one driven to among them
  bool goal_reached = false;   ///< the last one that there was
  Vec2 goal_in_map;
  double goal_heading_rad = kAnyHeading;   ///< wanted at the goal; NaN: any
  double heading_error_rad = kAnyHeading;  ///< from the robot's heading to that, the short way; NaN where any will do
  Reason reasons = Reason::kNone;
  std::uint8_t faulty_scanners = 0;     ///< Verdict's
  PlanStatus plan = PlanStatus::kNone;  ///< how the last plan that came went
  const char* backend = "";             ///< that plans: cpu, cuda
  std::uint32_t revoked = 0;            ///< how often goals and resets were revoked by a stop, a fault or a latch
  std::uint32_t stops_done = 0;         ///< orders to stop that were obeyed to rest, of all that there were
  bool latched = false;
  Reason latched_by = Reason::kNone;  ///< since the last reset, one that was revoked among them
  PlaceAnswer place;                  ///< to the last `here`
  DriveTrouble drive = DriveTrouble::kNone;
  DriveFault drive_fault;
  bool drive_is_silent = false;  ///< WiredDrive's
  ScannerHealth laser;
  OfOthers<ScannerHealth> other_lasers;
  CanHealth bus;
  std::uint64_t ticks = 0;
  std::uint64_t missed_ticks = 0;
  std::uint64_t stalls = 0;
  double wake_late_max_us = 0.0;
  PageFaults page_faults;  ///< of the loop's thread since its first tick
};

/// Lines of "word: value" for a person and for scripts. Not for the loop.
[[nodiscard]] std::string describe(const RunStatus& status);

/// arming.txt: what each drive said to each setting. Throws StartupError where the folder cannot be written to.
void write_arming(const std::filesystem::path& folder, const std::vector<std::string>& proof);

/// "66 settings proved", "64 settings proved, 2 NOT PROVED".
[[nodiscard]] std::string in_short(const std::vector<std::string>& proof);

/// devices.json: wheel radii, frames, scans and ticks lost or bad, what the kernel did not permit. Throws likewise.
void write_devices(const std::filesystem::path& folder, const DriveWiring& drive, const RunStatus& last,
                   const std::vector<std::string>& not_permitted);

}  // namespace jaywalk
