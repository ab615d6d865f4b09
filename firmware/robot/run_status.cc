#include "firmware/robot/run_status.h"

#include <cmath>
#include <sstream>

namespace jaywalk {
namespace {

const char* state_of(const RunStatus& status) {
  if (!status.running) return "starting";
  if (status.latched) return "latched";
  if (status.steered) return "steered";
  if (status.has_goal) return status.turns_at_goal ? "turning" : "driving";
  return status.goal_reached ? "reached" : "waiting";
}

}  // namespace

std::string describe(const RunStatus& status) {
  std::ostringstream out;
  const Pose2& pose = status.map_from_robot;
  out << "state: " << state_of(status) << "\npose: " << pose.x << ' ' << pose.y << ' ' << pose.heading
      << "\nspeed_mps: " << status.speed_mps << "\nenabled: " << (status.enabled ? "yes" : "no") << "\ngoal: ";
  if (status.has_goal) out << status.goal_in_map.x << ' ' << status.goal_in_map.y;
  if (status.has_goal && !std::isnan(status.goal_heading_rad)) out << ' ' << status.goal_heading_rad;
  out << "\nreasons: " << to_string(status.reasons) << "\nplan: " << name_of(status.plan)
      << "\ngoals_left: " << status.goals_left << "\nlatched_by: " << to_string(status.latched_by)
      << "\ndrive: " << name(status.drive) << "\ndrives_proved: " << (status.proved ? "yes" : "no")
      << "\nforeign_frame: " << (status.foreign_frame ? to_text(*status.foreign_frame) : "")
      << "\nlaser: " << name(status.laser.trouble) << "\nlaser_last_trouble: " << name(status.laser.last_trouble)
      << "\nlaser_scans: " << status.laser.scans << "\nlaser_malformed: " << status.laser.malformed
      << "\nlaser_lost: " << status.laser.protocol.lost << "\nlaser_warned: " << status.laser.protocol.warned
      << "\nlaser_connections: " << status.laser.connections << "\nbus: " << name(status.bus.state)
      << "\nbus_error_frames: " << status.bus.error_frames << "\nbus_lost: " << status.bus.frames_lost
      << "\nbus_malformed: " << status.bus.malformed << "\nticks: " << status.ticks
      << "\nmissed_ticks: " << status.missed_ticks << "\nstalls: " << status.stalls
      << "\nwake_late_max_us: " << status.wake_late_max_us << "\npage_faults: " << status.page_faults.minor
      << " minor, " << status.page_faults.major << " major" << '\n';
  return out.str();
}

}  // namespace jaywalk
