// Two serial CAN adapters joined by a wire, behind the kernel's slcan: what a CAN controller does when its bus goes bad
// can be had to order. The Lawicel protocol, as far as Linux uses it: frames are lines that go to the other side as
// they are; "s" and a letter is an adapter's state with its two error counters.
//
// Prints the two interfaces' names; orders are lines on standard input, for the first of them:
//   warning | passive | bus-off | active     its state
//   deaf | hearing                           it reads nothing more, so that the kernel's queue fills up; or again
#include <fcntl.h>
#include <linux/tty.h>
#include <net/if.h>
#include <poll.h>
#include <stdlib.h>
#include <sys/ioctl.h>
#include <termios.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <cstring>
#include <string>
#include <string_view>

#include "drivers/wire/file_descriptor.h"

namespace {

using jaywalk::wire::FileDescriptor;

/// One adapter: the master is its own side, the slave the computer's.
struct Adapter {
  FileDescriptor master, slave;
  std::string name;
  std::string line;
  bool on_bus = true;  ///< not after bus-off, until it is opened anew

  Adapter() : master(::posix_openpt(O_RDWR | O_NOCTTY)) {
    ::grantpt(master.get());
    ::unlockpt(master.get());
    slave = FileDescriptor(::open(::ptsname(master.get()), O_RDWR | O_NOCTTY));
    termios raw{};
    ::tcgetattr(slave.get(), &raw);
    ::cfmakeraw(&raw);
    ::tcsetattr(slave.get(), TCSANOW, &raw);
    const int discipline = N_SLCAN;
    std::array<char, IFNAMSIZ> interface {};
    if (::ioctl(slave.get(), TIOCSETD, &discipline) != 0 || ::ioctl(slave.get(), SIOCGIFNAME, interface.data()) != 0) {
      std::perror("slcan");
      std::exit(2);
    }
    name = interface.data();
  }
  void say(const std::string& text) const { static_cast<void>(!::write(master.get(), text.data(), text.size())); }
  /// Hands whole frames to the other; settings are taken and forgotten.
  void pass_on(const Adapter& other) {
    std::array<char, 1024> bytes{};
    const ssize_t got = ::read(master.get(), bytes.data(), bytes.size());
    for (ssize_t k = 0; k < got; ++k) {
      const char letter = bytes[static_cast<std::size_t>(k)];
      line += letter;
      if (letter != '\r') continue;
      if (line[0] == 'O') on_bus = true;
      if (std::strchr("tTrR", line[0]) != nullptr && on_bus && other.on_bus) other.say(line);
      line.clear();
    }
  }
};

/// False at the orders' end.
bool obey(Adapter& first, bool& deaf) {
  std::array<char, 64> order{};
  const ssize_t got = ::read(STDIN_FILENO, order.data(), order.size() - 1);
  if (got <= 0) return false;
  const std::string_view said(order.data());
  if (said.starts_with("warning")) first.say("sw100010\r");
  if (said.starts_with("passive")) first.say("sp130010\r");
  if (said.starts_with("bus-off")) {
    first.say("sb255010\r");
    first.on_bus = false;
  }
  if (said.starts_with("active")) first.say("sa000000\r");
  if (said.starts_with("deaf")) deaf = true;
  if (said.starts_with("hearing")) deaf = false;
  return true;
}

}  // namespace

int main() {
  Adapter first, second;
  std::printf("%s %s\n", first.name.c_str(), second.name.c_str());
  std::fflush(stdout);
  bool deaf = false;
  for (;;) {
    std::array<pollfd, 3> waiting{pollfd{STDIN_FILENO, POLLIN, 0}, pollfd{second.master.get(), POLLIN, 0},
                                  pollfd{deaf ? -1 : first.master.get(), POLLIN, 0}};
    if (::poll(waiting.data(), waiting.size(), -1) < 0) return 1;
    if (waiting[0].revents != 0 && !obey(first, deaf)) return 0;
    if (waiting[1].revents != 0) second.pass_on(first);
    if (waiting[2].revents != 0) first.pass_on(second);
  }
}
