#pragma once
// Checks before a robot is let run, and the record of its commissioning beside its file: ROBOT.commissioned.json.
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "firmware/robot/robot_file.h"
#include "hal/hal.h"

namespace jaywalk {

struct CheckedPart {
  std::string part;  ///< "scanner", "left drive", ...
  bool is_well = false;
  std::string said;    ///< what it is; where it is not well, the cause and what to do about it
  bool warns = false;  ///< well, but a run wants a word about it
};

/// "ok", "warn" or "fail".
[[nodiscard]] inline const char* state_of(const CheckedPart& part) {
  return !part.is_well ? "fail" : part.warns ? "warn" : "ok";
}

/// Throws StartupError for a device that is there and is no joystick, or lacks a button or the stick of the file.
void require_joystick(const panel::JoystickSetup& setup);

/// Looks at all that a run needs, some seconds long, and tells `waits_for` of each part before. Nothing moves, no
/// setting of a device is changed but what makes a scanner send. Where a run has the robot already, that is said and
/// its devices are left alone.
[[nodiscard]] std::vector<CheckedPart> preflight(const RobotFile& file, const std::filesystem::path& control_socket,
                                                 Clock& clock,
                                                 const std::function<void(const std::string&)>& waits_for = {});

/// Connects to a scanner of the robot's and listens for a second: what it is, how many beams and scans a second. Throws
/// StartupError where none come, not as often as the file says, where too many beams measure nothing, or where beams
/// end on the robot's own outline, with which it would never drive: the sectors to blank. Before the loop.
[[nodiscard]] std::string check_scanner(const RobotFile& file, Clock& clock, std::size_t scanner = 0);

enum class Commissioned { kNotYet, kChangedSince, kFailed, kPassed };

struct CommissioningRecord {
  Commissioned state = Commissioned::kNotYet;
  std::string date;  ///< of the run, UTC; empty where there was none
  std::string said;  ///< a sentence for a person, with what to do where it is not kPassed
};

/// "mine.commissioned.json" for "mine.toml".
[[nodiscard]] std::filesystem::path commissioned_path(const std::filesystem::path& robot);

/// The old record is replaced whole, or stays where the new one cannot be written. Throws StartupError there.
void write_commissioned(const std::filesystem::path& robot, const RobotFile& file,
                        const std::vector<CheckedPart>& checks);

/// Before the wheels turn: the record counts as failed until write_commissioned(). Throws likewise.
void withdraw_commissioned(const std::filesystem::path& robot, const RobotFile& file);

/// A file that cannot be read counts as never; one that is of other wiring as changed.
[[nodiscard]] CommissioningRecord read_commissioned(const std::filesystem::path& robot, const RobotFile& file);

/// For `jaywalk run`: a remark, empty where all is well. Throws StartupError where commissioning failed, and where
/// there was none of this wiring unless a person takes it upon themselves (`uncommissioned`).
[[nodiscard]] std::string require_commissioned(const std::filesystem::path& robot, const RobotFile& file,
                                               bool uncommissioned);

/// A folder that lasts until the next boot: the first of $RUNTIME_DIRECTORY (systemd's), $XDG_RUNTIME_DIR,
/// /run/user/UID, /run/jaywalk and jaywalk-UID in the folder for temporary files that is, or can be made, and is this
/// user's alone: no link, and not writable for others. Throws StartupError where there is none.
[[nodiscard]] std::filesystem::path own_runtime_folder();

/// Folder of the marks, for every user of a machine with the package: `shared`, of the group jaywalk, which systemd
/// makes at boot and a stopped service leaves. Elsewhere own_runtime_folder(). Throws StartupError where `shared` is
/// there and this user may not write to it: its run and the service's would not see each other's marks.
[[nodiscard]] std::filesystem::path folder_of_marks(const std::filesystem::path& shared = "/run/jaywalk-armed");

/// A file that exists while a robot's drives are armed. Where it is there at start, the last run on that robot ended
/// without disarming them: it was killed or it crashed. Start-up and end only, not for the loop.
class ArmedMark {
 public:
  /// `robot` tells it from others: what its drives are wired to. Throws StartupError where `folder` cannot be opened.
  ArmedMark(const std::filesystem::path& folder, std::string robot);
  /// An orderly end takes the file away.
  ~ArmedMark() {
    if (set_) ::unlinkat(folder_.get(), file_.filename().c_str(), 0);
  }

  /// Whether the run before this one left it.
  [[nodiscard]] bool was_left() const noexcept { return was_left_; }
  /// Throws StartupError where the file cannot be written; a link is not followed.
  void set();

 private:
  std::filesystem::path file_;
  wire::FileDescriptor folder_;
  bool was_left_, set_ = false;
};

}  // namespace jaywalk
