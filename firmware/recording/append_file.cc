#include "firmware/recording/append_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "hal/types/errors.h"

namespace jaywalk {

AppendFile::AppendFile(const std::string& file)
    : file_(file), descriptor_(::open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666)) {
  if (descriptor_ < 0) {
    throw StartupError(file + ": cannot be written: " + std::strerror(errno),
                       "choose an --out folder that exists and may be written");
  }
}

AppendFile::~AppendFile() { close(); }

std::size_t AppendFile::append(std::span<const unsigned char> bytes) noexcept {
  std::size_t taken = 0;
  while (taken < bytes.size() && error_ == 0) {
    const ssize_t count = ::write(descriptor_, bytes.data() + taken, bytes.size() - taken);
    if (count > 0)
      taken += static_cast<std::size_t>(count);
    else if (count == 0 || errno != EINTR)
      error_ = count == 0 ? ENOSPC : errno;
  }
  size_ += taken;
  return taken;
}

void AppendFile::take_back(std::size_t bytes) noexcept {
  size_ -= bytes;
  if (::ftruncate(descriptor_, static_cast<off_t>(size_)) != 0 && error_ == 0) error_ = errno;
}

bool AppendFile::close() noexcept {
  if (descriptor_ >= 0 && ::close(descriptor_) != 0 && error_ == 0) error_ = errno;
  descriptor_ = -1;
  return error_ == 0;
}

std::string AppendFile::complaint() const {
  return error_ == 0 ? "" : file_ + ": the disk takes no more of it: " + std::strerror(error_);
}

}  // namespace jaywalk
