#include "firmware/robot/run_status.h"

#include <cmath>
#include <sstream>

#include "drivers/drive_fault_words.h"

namespace jaywalk {
namespace {

const char* state_of(const RunStatus& status) {
  if (!status.running) return "starting";
  if (status.latched) return "latched";
  if (status.steered) return "steered";
  if (status.has_goal) return status.turns_at_goal ? "turning" : "driving";
  return status.goal_reached ? "reached" : "waiting";
}

/// `laser`: "laser", or "laser_2" of the second of several.
void put(std::ostream& out, const std::string& laser, const ScannerHealth& health) {
  out << '\n'
      << laser << ": " << name(health.trouble) << '\n'
      << laser << "_last_trouble: " << name(health.last_trouble) << '\n'
      << laser << "_scans: " << health.scans << '\n'
      << laser << "_malformed: " << health.malformed << '\n'
      << laser << "_lost: " << health.protocol.lost << '\n'
      << laser << "_warned: " << health.protocol.warned << '\n'
      << laser << "_connections: " << health.connections;
}

}  // namespace

std::string describe(const RunStatus& status) {
  std::ostringstream out;
  const Pose2& pose = status.map_from_robot;
  out << "state: " << state_of(status) << "\npose: " << pose.x << ' ' << pose.y << ' ' << pose.heading
      << "\nspeed_mps: " << status.speed_mps << "\nenabled: " << (status.enabled ? "yes" : "no") << "\ngoal: ";
  if (status.has_goal) out << status.goal_in_map.x << ' ' << status.goal_in_map.y;
  if (status.has_goal && !std::isnan(status.goal_heading_rad)) out << ' ' << status.goal_heading_rad;
  out << "\nreasons: " << to_string(status.reasons, status.faulty_scanners) << "\nplan: " << name_of(status.plan)
      << "\nbackend: " << status.backend << "\ngoals_left: " << status.goals_left
      << "\nlatched_by: " << to_string(status.latched_by) << "\ndrive: " << name(status.drive)
      << "\ndrive_fault: " << describe(status.drive_fault) << "\ndrives_proved: " << (status.proved ? "yes" : "no")
      << "\nforeign_frame: " << (status.foreign_frame ? to_text(*status.foreign_frame) : "");
  put(out, "laser", status.laser);
  for (std::size_t k = 0; k < status.other_lasers.size(); ++k)
    put(out, "laser_" + std::to_string(k + 2), status.other_lasers[k]);
  out << "\nbus: " << name(status.bus.state) << "\nbus_error_frames: " << status.bus.error_frames
      << "\nbus_lost: " << status.bus.frames_lost << "\nbus_malformed: " << status.bus.malformed
      << "\nticks: " << status.ticks << "\nmissed_ticks: " << status.missed_ticks << "\nstalls: " << status.stalls
      << "\nwake_late_max_us: " << status.wake_late_max_us << "\npage_faults: " << status.page_faults.minor
      << " minor, " << status.page_faults.major << " major" << '\n';
  return out.str();
}

}  // namespace jaywalk
