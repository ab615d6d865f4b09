#include "firmware/robot/armed_mark.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <string_view>
#include <vector>

#include "hal/types/errors.h"

namespace jaywalk {
namespace {

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

}  // namespace

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

ArmedMark::~ArmedMark() {
  if (set_) ::unlinkat(folder_.get(), file_.filename().c_str(), 0);
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
