#pragma once
#include <filesystem>
#include <string>

#include "drivers/wire/file_descriptor.h"

namespace jaywalk {

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
  ~ArmedMark();
  ArmedMark(const ArmedMark&) = delete;
  ArmedMark& operator=(const ArmedMark&) = delete;

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
