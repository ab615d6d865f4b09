#include <fcntl.h>
#include <stdlib.h>
#include <termios.h>

#include <array>
#include <filesystem>
#include <utility>

#include "hal/types/errors.h"
#include "hil/emulators/byte_server.h"

namespace jaywalk::emulators {

PtyServer::PtyServer(std::string path) : path_(std::move(path)) { plug_in(); }

PtyServer::~PtyServer() {
  std::error_code ignored;
  std::filesystem::remove(path_, ignored);
}

void PtyServer::plug_in() {
  wire::FileDescriptor mine(::posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC));
  std::array<char, 128> name{};
  if (mine.get() < 0 || ::grantpt(mine.get()) != 0 || ::unlockpt(mine.get()) != 0 ||
      ::ptsname_r(mine.get(), name.data(), name.size()) != 0) {
    throw StartupError(path_ + ": no pseudo terminal for it", "mount /dev/pts");
  }
  wire::FileDescriptor theirs(::open(name.data(), O_RDWR | O_NOCTTY | O_CLOEXEC));
  termios settings{};
  if (theirs.get() < 0 || ::tcgetattr(theirs.get(), &settings) != 0) {
    throw StartupError(path_ + ": " + name.data() + " cannot be opened", "mount /dev/pts");
  }
  ::cfmakeraw(&settings);  // or what is sent comes back as an echo
  ::tcsetattr(theirs.get(), TCSANOW, &settings);
  std::error_code failure;
  std::filesystem::remove(path_, failure);
  std::filesystem::create_symlink(name.data(), path_, failure);
  if (failure)
    throw StartupError(path_ + ": cannot be made (" + failure.message() + ")", "choose a folder that is yours");
  fresh_ = std::move(mine);
  other_ = std::move(theirs);
}

wire::FileDescriptor PtyServer::accept() noexcept { return std::exchange(fresh_, wire::FileDescriptor()); }

void PtyServer::set_present(bool present) {
  if (present == (other_.get() >= 0)) return;
  if (present) return plug_in();
  drop_peer();
  fresh_ = wire::FileDescriptor();
  other_ = wire::FileDescriptor();
  std::error_code ignored;
  std::filesystem::remove(path_, ignored);
}

}  // namespace jaywalk::emulators
