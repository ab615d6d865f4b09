#include "firmware/robot/commissioned.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <ctime>
#include <fstream>
#include <nlohmann/json.hpp>

#include "hal/types/errors.h"

namespace jaywalk {
namespace {

/// Node numbers and units a radian, of the drives that the file has.
std::array<double, 4> axes_of(const DriveWiring& drive) {
  const auto& odrive = drive.odrive.axes;
  const auto& vesc = drive.vesc.axes;
  const auto& cia402 = drive.cia402.axes;
  switch (drive.kind) {
    case DriveKind::kOdrive:
      return {static_cast<double>(odrive[0].node), odrive[0].turns_per_rad, static_cast<double>(odrive[1].node),
              odrive[1].turns_per_rad};
    case DriveKind::kVesc:
      return {static_cast<double>(vesc[0].controller), vesc[0].electrical_turns_per_rad,
              static_cast<double>(vesc[1].controller), vesc[1].electrical_turns_per_rad};
    case DriveKind::kCia402:
      break;
  }
  return {static_cast<double>(cia402[0].node), cia402[0].counts_per_rad, static_cast<double>(cia402[1].node),
          cia402[1].counts_per_rad};
}

std::string today() {
  const std::time_t now = std::time(nullptr);
  std::tm utc{};
  ::gmtime_r(&now, &utc);
  std::array<char, 32> text{};
  const std::size_t length = std::strftime(text.data(), text.size(), "%Y-%m-%dT%H:%M:%SZ", &utc);
  return {text.data(), length};
}

/// `text` takes the file's place in one step, and is on the disk by then: a power cut leaves the old or the new.
void replace(const std::filesystem::path& path, const std::string& text) {
  const std::filesystem::path beside = path.string() + ".new",
                              folder = path.has_parent_path() ? path.parent_path() : ".";
  static_cast<void>(::unlink(beside.c_str()));  // a link that was put there is not followed
  const int file = ::open(beside.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0644);
  bool kept = file >= 0 && ::write(file, text.data(), text.size()) == static_cast<ssize_t>(text.size());
  kept = file >= 0 && ::fsync(file) == 0 && kept;
  kept = file >= 0 && ::close(file) == 0 && kept;
  kept = kept && std::rename(beside.c_str(), path.c_str()) == 0;
  if (!kept) {
    static_cast<void>(::unlink(beside.c_str()));
    throw StartupError(path.string() + ": cannot be written", "see to the folder's rights and the disk's room");
  }
  const int entry = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (entry < 0) return;
  static_cast<void>(::fsync(entry));
  static_cast<void>(::close(entry));
}

}  // namespace

std::filesystem::path commissioned_path(const std::filesystem::path& robot) {
  std::filesystem::path path = robot;
  return path.replace_extension(".commissioned.json");
}

std::string wiring_digest(const RobotFile& file) {
  const RobotModel& model = file.setup.model;
  const Pose2& mount = model.laser.robot_from_laser;
  const auto axes = axes_of(file.drive);
  std::uint64_t digest = 14695981039346656037ULL;
  for (const double fact :
       {static_cast<double>(file.drive.kind), axes[0], axes[1], axes[2], axes[3], model.drive.wheel_radius_m,
        model.drive.track_width_m, static_cast<double>(file.laser.kind), mount.x, mount.y, mount.heading,
        model.laser.fov_rad, static_cast<double>(model.laser.beams)}) {
    char text[32];
    std::snprintf(text, sizeof text, "%.9g;", fact);
    for (const char* c = text; *c != '\0'; ++c) digest = (digest ^ static_cast<std::uint8_t>(*c)) * 1099511628211ULL;
  }
  char hex[20];
  std::snprintf(hex, sizeof hex, "%016llx", static_cast<unsigned long long>(digest));
  return hex;
}

void write_commissioned(const std::filesystem::path& robot, const RobotFile& file,
                        const std::vector<CheckedPart>& checks) {
  nlohmann::ordered_json json;
  json["date"] = today();
  json["wiring"] = wiring_digest(file);
  json["passed"] = std::all_of(checks.begin(), checks.end(), [](const CheckedPart& check) { return check.is_well; });
  for (const CheckedPart& check : checks)
    json["checks"].push_back({{"part", check.part}, {"ok", check.is_well}, {"said", check.said}});
  replace(commissioned_path(robot), json.dump(2) + '\n');
}

void withdraw_commissioned(const std::filesystem::path& robot, const RobotFile& file) {
  write_commissioned(robot, file, {{"commissioning", false, "broken off before its end; do it again"}});
}

CommissioningRecord read_commissioned(const std::filesystem::path& robot, const RobotFile& file) {
  const std::string again = "; turn the wheels once: jaywalk commission " + robot.string();
  std::ifstream in(commissioned_path(robot));
  const nlohmann::json json = nlohmann::json::parse(in, nullptr, false);
  const auto text = [&json](const char* key) {
    return json.contains(key) && json[key].is_string() ? json[key].get<std::string>() : std::string();
  };
  if (!json.is_object() || text("wiring").empty() || !json.contains("passed") || !json["passed"].is_boolean())
    return {Commissioned::kNotYet, "", "never commissioned" + again};
  const std::string date = text("date");
  if (text("wiring") != wiring_digest(file))
    return {Commissioned::kChangedSince, date, "drive, scanner or model changed since it was commissioned" + again};
  if (!json["passed"].get<bool>()) return {Commissioned::kFailed, date, "commissioning failed on " + date + again};
  return {Commissioned::kPassed, date, "commissioned on " + date};
}

std::string require_commissioned(const std::filesystem::path& robot, const RobotFile& file) {
  const CommissioningRecord record = read_commissioned(robot, file);
  if (record.state == Commissioned::kFailed)
    throw StartupError(
        robot.string() + ": commissioning failed on " + record.date,
        "mend what " + commissioned_path(robot).string() + " says, then jaywalk commission " + robot.string());
  return record.state == Commissioned::kPassed ? "" : robot.string() + ": " + record.said;
}

}  // namespace jaywalk
