#include <asm/termbits.h>  // not with <termios.h>: both define the same names
#include <sys/ioctl.h>

#include "drivers/wire/byte_link.h"

namespace jaywalk::wire {

bool set_raw(int line, std::uint32_t baud) noexcept {
  termios2 settings{};
  if (::ioctl(line, TCGETS2, &settings) != 0) return false;
  settings.c_iflag &= ~static_cast<tcflag_t>(IGNBRK | BRKINT | PARMRK | ISTRIP | INLCR | IGNCR | ICRNL | IXON);
  settings.c_oflag &= ~static_cast<tcflag_t>(OPOST);
  settings.c_lflag &= ~static_cast<tcflag_t>(ECHO | ECHONL | ICANON | ISIG | IEXTEN);
  settings.c_cflag &=
      ~static_cast<tcflag_t>(CSIZE | PARENB | CSTOPB | CRTSCTS | CBAUD | static_cast<tcflag_t>(CBAUD) << IBSHIFT);
  settings.c_cflag |= CS8 | CLOCAL | CREAD | BOTHER | static_cast<tcflag_t>(BOTHER) << IBSHIFT;
  settings.c_ispeed = settings.c_ospeed = baud;
  settings.c_cc[VMIN] = 1;
  settings.c_cc[VTIME] = 0;
  return ::ioctl(line, TCSETS2, &settings) == 0;
}

}  // namespace jaywalk::wire
