#pragma once
// What a commissioning run found, kept beside the robot file: ROBOT.commissioned.json.
#include <filesystem>
#include <string>
#include <vector>

#include "drivers/wire/file_descriptor.h"
#include "firmware/robot/preflight.h"
#include "firmware/robot/robot_file.h"

namespace jaywalk {

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

/// Before the wheels turn: what was found before holds no longer, and counts as failed until write_commissioned().
/// Throws StartupError where it cannot be written.
void withdraw_commissioned(const std::filesystem::path& robot, const RobotFile& file);

/// A file that cannot be read counts as never; one that is of other wiring as changed.
[[nodiscard]] CommissioningRecord read_commissioned(const std::filesystem::path& robot, const RobotFile& file);

/// For `jaywalk run`: a remark, empty where all is well. Throws StartupError where commissioning failed, and where
/// there was none of this wiring unless a person takes it upon themselves (`uncommissioned`).
[[nodiscard]] std::string require_commissioned(const std::filesystem::path& robot, const RobotFile& file,
                                               bool uncommissioned);

/// A folder that is this user's alone and lasts until the next boot: the first of $RUNTIME_DIRECTORY (systemd's),
/// $XDG_RUNTIME_DIR, /run/user/UID, /run/jaywalk and jaywalk-UID in the folder for temporary files that is, or can be
/// made. What is a link, another user's, or writable for others is left out. Throws StartupError where there is none.
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
