#include "drivers/can/can_interface.h"

#include <linux/can/netlink.h>
#include <linux/if_link.h>
#include <linux/rtnetlink.h>
#include <net/if.h>
#include <net/if_arp.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <sys/un.h>

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <cstring>

#include "hal/types/errors.h"

namespace jaywalk {
namespace {

template <class T>
T read_as(wire::Bytes bytes) {
  T value{};
  if (bytes.size() >= sizeof value) std::memcpy(&value, bytes.data(), sizeof value);
  return value;
}

/// Payload of the attribute of that type (struct rtattr, each at a multiple of four bytes); empty where there is none.
wire::Bytes attribute(wire::Bytes bytes, std::uint16_t type) {
  while (bytes.size() >= sizeof(rtattr)) {
    const auto head = read_as<rtattr>(bytes);
    if (head.rta_len < sizeof head || head.rta_len > bytes.size()) return {};
    if ((head.rta_type & NLA_TYPE_MASK) == type) return bytes.subspan(sizeof head, head.rta_len - sizeof head);
    bytes = bytes.subspan(std::min<std::size_t>((head.rta_len + 3U) & ~3U, bytes.size()));
  }
  return {};
}

std::optional<CanState> state_of(wire::Bytes bytes) {
  if (bytes.size() < sizeof(std::uint32_t)) return std::nullopt;
  switch (read_as<std::uint32_t>(bytes)) {
    case CAN_STATE_ERROR_ACTIVE: return CanState::kActive;
    case CAN_STATE_ERROR_WARNING: return CanState::kWarning;
    case CAN_STATE_ERROR_PASSIVE: return CanState::kPassive;
    case CAN_STATE_BUS_OFF: return CanState::kBusOff;
    default: return CanState::kDown;
  }
}

/// The kernel's answer to "what is interface `index`?"; empty where none came.
std::vector<std::uint8_t> ask_kernel(int index) {
  struct Question {
    nlmsghdr head;
    ifinfomsg about;
  } question{};
  question.head.nlmsg_len = sizeof question;
  question.head.nlmsg_type = RTM_GETLINK;
  question.head.nlmsg_flags = NLM_F_REQUEST;
  question.about.ifi_index = index;
  const wire::FileDescriptor socket(::socket(AF_NETLINK, SOCK_RAW | SOCK_CLOEXEC, NETLINK_ROUTE));
  const timeval patience{.tv_sec = 1, .tv_usec = 0};
  ::setsockopt(socket.get(), SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
  if (::send(socket.get(), &question, sizeof question, 0) < 0) return {};
  std::vector<std::uint8_t> answer(32768);
  const ssize_t got = ::recv(socket.get(), answer.data(), answer.size(), 0);
  answer.resize(got > 0 ? static_cast<std::size_t>(got) : 0);
  return answer;
}

}  // namespace

LinkFacts link_facts(const std::string& interface) {
  LinkFacts facts;
  const unsigned index = ::if_nametoindex(interface.c_str());
  const std::vector<std::uint8_t> answer =
      index == 0 ? std::vector<std::uint8_t>() : ask_kernel(static_cast<int>(index));
  const wire::Bytes bytes(answer);
  if (bytes.size() < sizeof(nlmsghdr) + sizeof(ifinfomsg) || read_as<nlmsghdr>(bytes).nlmsg_type != RTM_NEWLINK)
    return facts;
  const auto about = read_as<ifinfomsg>(bytes.subspan(sizeof(nlmsghdr)));
  facts.exists = true;
  facts.is_can = about.ifi_type == ARPHRD_CAN;
  facts.is_up = (about.ifi_flags & IFF_UP) != 0;
  const wire::Bytes link = attribute(bytes.subspan(sizeof(nlmsghdr) + sizeof(ifinfomsg)), IFLA_LINKINFO);
  const wire::Bytes kind = attribute(link, IFLA_INFO_KIND), can = attribute(link, IFLA_INFO_DATA);
  for (const std::uint8_t letter : kind)
    if (letter != 0) facts.kind += static_cast<char>(letter);
  if (facts.kind != "can") return facts;
  facts.bitrate = read_as<can_bittiming>(attribute(can, IFLA_CAN_BITTIMING)).bitrate;
  facts.state = state_of(attribute(can, IFLA_CAN_STATE));
  return facts;
}

std::vector<std::string> can_interfaces() {
  std::vector<std::string> names;
  struct if_nameindex* const all = ::if_nameindex();
  for (const struct if_nameindex* at = all; at != nullptr && at->if_index != 0; ++at)
    if (link_facts(at->if_name).is_can) names.emplace_back(at->if_name);
  if (all != nullptr) ::if_freenameindex(all);
  std::sort(names.begin(), names.end());
  return names;
}

// An address that begins with a zero byte is in the abstract namespace: unix(7).
BusLock::BusLock(const std::string& interface) : socket_(::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  const std::string name = "jaywalk-can:" + interface;
  const std::size_t length = std::min(name.size(), sizeof address.sun_path - 1);
  std::memcpy(address.sun_path + 1, name.data(), length);
  const auto bytes = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1 + length);
  if (::bind(socket_.get(), reinterpret_cast<const sockaddr*>(&address), bytes) == 0) return;
  if (errno == EADDRINUSE) {
    throw StartupError(interface + ": another program of jaywalk has the drives on this bus",
                       "end it first: jaywalk status, or: ss -xp | grep " + name);
  }
  throw StartupError(interface + ": cannot be locked: " + std::strerror(errno), "see what this system forbids");
}

std::string restart_link(const std::string& interface) {
  ifreq request{};
  if (interface.size() >= sizeof request.ifr_name) return interface + ": no such interface";
  std::memcpy(request.ifr_name, interface.data(), interface.size());
  const wire::FileDescriptor any(::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0));
  if (::ioctl(any.get(), SIOCGIFFLAGS, &request) != 0) return interface + ": " + std::strerror(errno);
  for (const bool up : {false, true}) {
    const int flags = up ? request.ifr_flags | IFF_UP : request.ifr_flags & ~IFF_UP;
    request.ifr_flags = static_cast<decltype(request.ifr_flags)>(flags);
    if (::ioctl(any.get(), SIOCSIFFLAGS, &request) != 0) {
      return interface + ": not permitted to restart it: " + std::strerror(errno) + "; run as root, or: ip link set " +
             interface + " down && ip link set " + interface + " up";
    }
  }
  return "";
}

}  // namespace jaywalk
