#include <fcntl.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string_view>

#include "firmware/recording/run_folders.h"
#include "firmware/robot/preflight.h"
#include "hal/shown_text.h"
#include "hal/types/errors.h"

namespace jaywalk {
namespace {

/// `text` takes the file's place in one step, and is on the disk by then: a power cut leaves the old or the new.
void replace(const std::filesystem::path& path, const std::string& text) {
  const std::filesystem::path beside = path.string() + ".new",
                              folder = path.has_parent_path() ? path.parent_path() : ".";
  static_cast<void>(::unlink(beside.c_str()));  // a link that was put there is not followed
  const int file = ::open(beside.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0644);
  bool kept = ::write(file, text.data(), text.size()) == static_cast<ssize_t>(text.size()) && ::fsync(file) == 0;
  kept = file >= 0 && ::close(file) == 0 && kept;
  if (!kept || std::rename(beside.c_str(), path.c_str()) != 0) {
    static_cast<void>(::unlink(beside.c_str()));
    throw StartupError(path.string() + ": cannot be written", "see to the folder's rights and the disk's room");
  }
  const wire::FileDescriptor entry(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  static_cast<void>(::fsync(entry.get()));
}

constexpr std::string_view kSaid = "The drives are armed.\n";

std::vector<std::filesystem::path> candidates() {
  std::vector<std::filesystem::path> all;
  for (const char* variable : {"RUNTIME_DIRECTORY", "XDG_RUNTIME_DIR"}) {
    const char* const named = std::getenv(variable);
    if (named != nullptr && *named != '\0') all.emplace_back(std::string(named, std::strcspn(named, ":")));
  }
  const std::string user = std::to_string(::geteuid());
  all.push_back("/run/user/" + user);
  all.push_back("/run/jaywalk");
  all.push_back(std::filesystem::temp_directory_path() / ("jaywalk-" + user));
  return all;
}

bool is_ours_alone(const std::filesystem::path& folder) {
  struct stat there {};
  return ::lstat(folder.c_str(), &there) == 0 && S_ISDIR(there.st_mode) && there.st_uid == ::geteuid() &&
         (there.st_mode & (S_IWGRP | S_IWOTH)) == 0;
}

/// "can0", and a path's parts with '-' between them.
std::string name_for(std::string robot) {
  std::replace(robot.begin(), robot.end(), '/', '-');
  return "jaywalk-" + robot + ".armed";
}

/// A number that another drive, scale, node, wheel, track, scanner or mount changes (FNV-1a, hexadecimal).
std::string wiring_digest(const RobotFile& file) {
  const RobotModel& model = file.setup.model;
  std::vector<double> facts{static_cast<double>(file.drive.kind)};
  for (const CanAxis& axis : file.drive.axes())
    facts.insert(facts.end(), {static_cast<double>(axis.node), axis.per_rad});
  facts.insert(facts.end(), {model.drive.wheel_radius_m, model.drive.track_width_m});
  for (std::size_t k = 0; k < file.lasers().size(); ++k) {
    const LaserModel& laser = model.lasers()[k];
    const Pose2& mount = laser.robot_from_laser;
    facts.insert(facts.end(), {static_cast<double>(file.lasers()[k].kind), mount.x, mount.y, mount.heading,
                               laser.fov_rad, static_cast<double>(laser.beams)});
  }
  std::uint64_t digest = 14695981039346656037ULL;
  for (const double fact : facts) {
    char text[32];
    std::snprintf(text, sizeof text, "%.9g;", fact);
    for (const char* c = text; *c != '\0'; ++c) digest = (digest ^ static_cast<std::uint8_t>(*c)) * 1099511628211ULL;
  }
  return formatted("%016llx", static_cast<unsigned long long>(digest));
}

}  // namespace

std::filesystem::path commissioned_path(const std::filesystem::path& robot) {
  std::filesystem::path path = robot;
  return path.replace_extension(".commissioned.json");
}

void write_commissioned(const std::filesystem::path& robot, const RobotFile& file,
                        const std::vector<CheckedPart>& checks) {
  nlohmann::ordered_json json;
  json["date"] = utc_text(std::chrono::system_clock::now(), "%Y-%m-%dT%H:%M:%SZ");
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

std::string require_commissioned(const std::filesystem::path& robot, const RobotFile& file, bool uncommissioned) {
  const CommissioningRecord record = read_commissioned(robot, file);
  if (record.state == Commissioned::kFailed)
    throw StartupError(
        robot.string() + ": commissioning failed on " + record.date,
        "mend what " + commissioned_path(robot).string() + " says, then jaywalk commission " + robot.string());
  if (record.state == Commissioned::kPassed) return "";
  if (!uncommissioned)
    throw StartupError(robot.string() + ": " + record.said, "or run it unproved on your own account: --uncommissioned");
  return robot.string() + ": " + record.said;
}

std::filesystem::path own_runtime_folder() {
  const std::vector<std::filesystem::path> all = candidates();
  for (const std::filesystem::path& folder : all) {
    ::mkdir(folder.c_str(), S_IRWXU);
    if (is_ours_alone(folder)) return folder;
  }
  throw StartupError(all.back().string() + ": is no folder of this user's alone",
                     "see to its owner and rights, or name another in $XDG_RUNTIME_DIR");
}

std::filesystem::path folder_of_marks(const std::filesystem::path& shared) {
  struct stat there {};
  if (::lstat(shared.c_str(), &there) != 0) return own_runtime_folder();
  if (!S_ISDIR(there.st_mode) || (there.st_mode & S_IWOTH) != 0)
    throw StartupError(shared.string() + ": is no folder that its group alone may write to",
                       "make it anew: systemd-tmpfiles --create jaywalk.conf");
  if (::access(shared.c_str(), W_OK | X_OK) != 0)
    throw StartupError(shared.string() + ": this user may not write there", "join the group jaywalk, and log in anew");
  return shared;
}

ArmedMark::ArmedMark(const std::filesystem::path& folder, std::string robot)
    : file_(folder / name_for(std::move(robot))),
      folder_(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)),
      was_left_(::faccessat(folder_.get(), file_.filename().c_str(), F_OK, AT_SYMLINK_NOFOLLOW) == 0) {
  if (folder_.get() < 0) throw StartupError(folder.string() + ": " + std::strerror(errno), "see to its rights");
}

void ArmedMark::set() {
  const wire::FileDescriptor file(::openat(folder_.get(), file_.filename().c_str(),
                                           O_WRONLY | O_CREAT | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC, 0644));
  if (file.get() < 0 || ::write(file.get(), kSaid.data(), kSaid.size()) != static_cast<ssize_t>(kSaid.size())) {
    throw StartupError(file_.string() + ": cannot be written: " + std::strerror(errno),
                       "take away what lies there, or free some space");
  }
  ::fchmod(file.get(), S_IRUSR | S_IWUSR | S_IRGRP | S_IWGRP);  // the next run may be another's of the group
  set_ = true;
}

}  // namespace jaywalk
