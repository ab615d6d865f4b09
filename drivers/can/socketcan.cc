#include "drivers/can/socketcan.h"

#include <fcntl.h>
#include <linux/can/error.h>
#include <linux/can/netlink.h>
#include <linux/can/raw.h>
#include <linux/if_link.h>
#include <linux/rtnetlink.h>
#include <net/if.h>
#include <net/if_arp.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <sys/uio.h>
#include <sys/un.h>

#include <array>
#include <cerrno>
#include <cstring>

#include "hal/types/errors.h"

namespace jaywalk {
namespace {

/// Error frames that one call of receive passes over: a storm of them must not hold up a tick.
constexpr int kMostErrorFrames = 64;

[[noreturn]] void refuse(const std::string& interface, const std::string& doing, int error) {
  throw StartupError(interface + ": " + doing + ": " + std::strerror(error),
                     "see that it is a CAN interface: ip -details link show " + interface);
}

template <class T>
void set_option(int socket, int level, int option, const T& value, const std::string& interface, const char* doing) {
  if (::setsockopt(socket, level, option, &value, sizeof value) != 0) refuse(interface, doing, errno);
}

void set_filters(int socket, std::span<const CanFilter> filters, const std::string& interface) {
  std::vector<can_filter> raw;
  for (const CanFilter& filter : filters) raw.push_back(to_kernel(filter));
  const auto bytes = static_cast<socklen_t>(raw.size() * sizeof(can_filter));
  if (::setsockopt(socket, SOL_CAN_RAW, CAN_RAW_FILTER, raw.data(), bytes) != 0) refuse(interface, "filters", errno);
}

void bind_to(int socket, int index, const std::string& interface) {
  sockaddr_can address{};
  address.can_family = AF_CAN;
  address.can_ifindex = index;
  if (::bind(socket, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0)
    refuse(interface, "bind", errno);
}

/// What the kernel sends along with a frame.
struct Ancillary {
  std::optional<Duration> stamp;      ///< CLOCK_REALTIME
  std::optional<std::uint32_t> lost;  ///< frames dropped by this socket since it was opened
};

Ancillary read_ancillary(msghdr& message) noexcept {
  Ancillary found;
  for (cmsghdr* item = CMSG_FIRSTHDR(&message); item != nullptr; item = CMSG_NXTHDR(&message, item)) {
    if (item->cmsg_level != SOL_SOCKET) continue;
    if (item->cmsg_type == SCM_TIMESTAMPNS) {
      timespec stamp{};
      std::memcpy(&stamp, CMSG_DATA(item), sizeof stamp);
      found.stamp = std::chrono::seconds(stamp.tv_sec) + std::chrono::nanoseconds(stamp.tv_nsec);
    } else if (item->cmsg_type == SO_RXQ_OVFL) {
      std::memcpy(&found.lost.emplace(), CMSG_DATA(item), sizeof(std::uint32_t));
    }
  }
  return found;
}

/// CLOCK_REALTIME.
Duration wall_clock() noexcept { return std::chrono::system_clock::now().time_since_epoch(); }

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

can_frame to_kernel(const CanFrame& frame) noexcept {
  can_frame raw{};
  raw.can_id = frame.id | (frame.extended ? CAN_EFF_FLAG : 0U) | (frame.remote ? CAN_RTR_FLAG : 0U);
  raw.can_dlc = frame.size;
  if (!frame.remote) std::copy_n(frame.bytes.begin(), frame.size, raw.data);
  return raw;
}

// Format and request bit are part of the mask: without the first a filter for 081h lets 29-bit frames through as well.
can_filter to_kernel(const CanFilter& filter) noexcept {
  return {.can_id = filter.id | (filter.extended ? CAN_EFF_FLAG : 0U) | (filter.remote ? CAN_RTR_FLAG : 0U),
          .can_mask = filter.mask | CAN_EFF_FLAG | CAN_RTR_FLAG};
}

std::optional<CanFrame> from_kernel(const can_frame& raw) noexcept {
  if (is_error(raw)) return std::nullopt;
  CanFrame frame{.id = raw.can_id & CAN_EFF_MASK,
                 .extended = (raw.can_id & CAN_EFF_FLAG) != 0,
                 .remote = (raw.can_id & CAN_RTR_FLAG) != 0,
                 .size = raw.can_dlc};
  if (!is_valid(frame)) return std::nullopt;
  if (!frame.remote) std::copy_n(raw.data, frame.size, frame.bytes.begin());
  return frame;
}

CanState state_after(const can_frame& error, CanState before) noexcept {
  if ((error.can_id & CAN_ERR_BUSOFF) != 0) return CanState::kBusOff;
  if ((error.can_id & CAN_ERR_RESTARTED) != 0) return CanState::kActive;
  if ((error.can_id & CAN_ERR_CRTL) == 0) return before;
  const unsigned status = error.data[1];
  if ((status & (CAN_ERR_CRTL_RX_PASSIVE | CAN_ERR_CRTL_TX_PASSIVE)) != 0) return CanState::kPassive;
  if ((status & (CAN_ERR_CRTL_RX_WARNING | CAN_ERR_CRTL_TX_WARNING)) != 0) return CanState::kWarning;
  if ((status & CAN_ERR_CRTL_ACTIVE) != 0) return CanState::kActive;
  return before;
}

wire::FileDescriptor open_can(const std::string& interface, std::span<const CanFilter> filters) {
  const unsigned index = ::if_nametoindex(interface.c_str());
  if (index == 0) {
    throw StartupError(interface + ": no such interface",
                       "bring it up: ip link set " + interface + " up type can bitrate 500000");
  }
  wire::FileDescriptor socket(::socket(PF_CAN, SOCK_RAW | SOCK_NONBLOCK | SOCK_CLOEXEC, CAN_RAW));
  if (socket.get() < 0 && (errno == EAFNOSUPPORT || errno == EPROTONOSUPPORT))
    throw StartupError(interface + ": this kernel has no raw CAN sockets", "load them: modprobe can_raw");
  if (socket.get() < 0) refuse(interface, "socket", errno);
  set_filters(socket.get(), filters, interface);
  set_option(socket.get(), SOL_CAN_RAW, CAN_RAW_ERR_FILTER, can_err_mask_t{CAN_ERR_MASK}, interface, "error frames");
  set_option(socket.get(), SOL_SOCKET, SO_TIMESTAMPNS, int{1}, interface, "time stamps");
  set_option(socket.get(), SOL_SOCKET, SO_RXQ_OVFL, int{1}, interface, "count of lost frames");
  bind_to(socket.get(), static_cast<int>(index), interface);
  return socket;
}

SocketCan::SocketCan(wire::FileDescriptor socket, Clock& clock) noexcept
    : socket_(std::move(socket)), clock_(clock), arrivals_(clock.now()) {}

wire::FileDescriptor SocketCan::second() const {
  wire::FileDescriptor copy(::fcntl(socket_.get(), F_DUPFD_CLOEXEC, 0));
  if (copy.get() < 0) refuse("CAN", "second use of its socket", errno);
  return copy;
}

void SocketCan::listen(std::span<const CanFilter> filters) { set_filters(socket_.get(), filters, "CAN"); }

bool SocketCan::send(const CanFrame& frame) noexcept {
  if (!is_valid(frame)) return false;
  const can_frame raw = to_kernel(frame);
  if (::send(socket_.get(), &raw, sizeof raw, MSG_DONTWAIT | MSG_NOSIGNAL) == sizeof raw) return true;
  if (errno == ENETDOWN || errno == ENXIO || errno == ENODEV) health_.state = CanState::kDown;
  return false;
}

bool SocketCan::receive(ReceivedFrame& received) noexcept {
  for (int attempt = 0; attempt < kMostErrorFrames; ++attempt) {
    can_frame raw{};
    alignas(cmsghdr) std::array<char, 256> control{};
    iovec part{.iov_base = &raw, .iov_len = sizeof raw};
    msghdr message{};
    message.msg_iov = &part;
    message.msg_iovlen = 1;
    message.msg_control = control.data();
    message.msg_controllen = control.size();
    const ssize_t got = ::recvmsg(socket_.get(), &message, MSG_DONTWAIT);
    if (got < 0) {
      if (errno == EINTR) continue;
      if (errno == ENETDOWN || errno == ENODEV) health_.state = CanState::kDown;
      if (errno == EAGAIN) arrivals_.note_empty(clock_.now(), wall_clock());
      return false;
    }
    const Ancillary ancillary = read_ancillary(message);
    if (ancillary.lost) health_.frames_lost = *ancillary.lost;
    if (got == sizeof raw && is_error(raw)) {
      note_error(raw);
      continue;
    }
    const auto frame = got == sizeof raw ? from_kernel(raw) : std::nullopt;
    if (!frame) {
      ++health_.malformed;
      continue;
    }
    // Frames come only from a link that is up and a controller that takes part.
    const bool was_off = health_.state == CanState::kDown || health_.state == CanState::kBusOff;
    if (was_off) health_.state = CanState::kActive;
    const Time now = clock_.now();
    received = {*frame, ancillary.stamp ? arrivals_.arrival(*ancillary.stamp, wall_clock(), now) : now};
    return true;
  }
  return false;
}

void SocketCan::note_error(const can_frame& error) noexcept {
  ++health_.error_frames;
  const CanState after = state_after(error, health_.state);
  if (after == CanState::kBusOff && health_.state != CanState::kBusOff) ++health_.bus_off_count;
  health_.state = after;
}

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
