#include "apps/report/disk_reserve.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "hal/types/errors.h"

namespace jaywalk {
namespace {

constexpr off_t kBytes = 64 * 1024;  // a summary.json and a devices.json have 2 to 5 kB

}  // namespace

DiskReserve::DiskReserve(const std::filesystem::path& folder) : file_(folder / ".reserve") {
  const int descriptor = ::open(file_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  const int error = descriptor < 0 ? errno : ::posix_fallocate(descriptor, 0, kBytes);
  if (descriptor >= 0) ::close(descriptor);
  if (error != ENOSPC && error != EDQUOT) return;
  release();
  throw StartupError(folder.string() + ": " + std::strerror(error), "free some space, or choose another --out folder");
}

void DiskReserve::release() noexcept {
  std::error_code gone;
  std::filesystem::remove(file_, gone);
}

}  // namespace jaywalk
