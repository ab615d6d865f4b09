#include "firmware/robot/device_report.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "drivers/drive_fault_words.h"
#include "hal/text_file.h"

namespace jaywalk {
namespace {

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
