#include "firmware/robot/run_status.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>

#include "drivers/wired_drive.h"
#include "hal/text_file.h"

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

constexpr const char* kNoRoom = "free some space";

nlohmann::ordered_json json_of(const ScannerHealth& laser) {
  return {{"trouble", name(laser.trouble)},
          {"scans", laser.scans},
          {"lost", laser.protocol.lost},
          {"malformed", laser.malformed},
          {"late", laser.late},
          {"skipped_bytes", laser.protocol.skipped_bytes},
          {"warned", laser.protocol.warned},
          {"connections", laser.connections}};
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

void write_arming(const std::filesystem::path& folder, const std::vector<std::string>& proof) {
  std::string text;
  for (const std::string& line : proof) text += line + '\n';
  write_text(folder / "arming.txt", text, kNoRoom);
}

std::string in_short(const std::vector<std::string>& proof) {
  const auto open = std::count_if(proof.begin(), proof.end(),
                                  [](const std::string& line) { return line.find("NOT PROVED") != std::string::npos; });
  const std::string proved = std::to_string(static_cast<std::ptrdiff_t>(proof.size()) - open) + " settings proved";
  return open == 0 ? proved : proved + ", " + std::to_string(open) + " NOT PROVED";
}

void write_devices(const std::filesystem::path& folder, const DriveWiring& drive, const RunStatus& last,
                   const std::vector<std::string>& not_permitted) {
  nlohmann::ordered_json json;
  json["bus"] = {{"state", name(last.bus.state)},
                 {"frames_lost", last.bus.frames_lost},
                 {"malformed", last.bus.malformed},
                 {"error_frames", last.bus.error_frames},
                 {"bus_offs", last.bus.bus_off_count}};
  json["laser"] = json_of(last.laser);
  for (const ScannerHealth& laser : last.other_lasers) json["other_lasers"].push_back(json_of(laser));
  json["drive"] = name(last.drive);
  json["drive_fault"] = describe(last.drive_fault);
  json["latched_by"] = to_string(last.latched_by);
  json["ticks"] = last.ticks;
  json["missed_ticks"] = last.missed_ticks;
  json["stalls"] = last.stalls;
  json["wheel_radii_m"] = drive.wheel_radii_m;
  json["not_permitted"] = not_permitted;
  write_text(folder / "devices.json", json.dump(2) + '\n', kNoRoom);
}

}  // namespace jaywalk
