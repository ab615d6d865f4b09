#include "firmware/robot/service_manager.h"

#include <sys/socket.h>
#include <sys/un.h>

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <cstring>

#include "drivers/wire/file_descriptor.h"

namespace jaywalk {
namespace {

std::string text_of(const char* variable) {
  const char* const text = std::getenv(variable);
  return text == nullptr ? "" : text;
}

}  // namespace

ServiceManager ServiceManager::from_environment() {
  const std::int64_t watchdog_us = std::strtoll(text_of("WATCHDOG_USEC").c_str(), nullptr, 10);
  return {text_of("NOTIFY_SOCKET"), std::chrono::microseconds(std::max<std::int64_t>(watchdog_us, 0))};
}

void ServiceManager::alive(std::uint64_t ticks, Time now) {
  const bool due = said_ == kNever || now - said_ >= watchdog_ / 4;
  if (watchdog_ <= Duration{0} || ticks == ticks_said_ || !due) return;
  ticks_said_ = ticks;
  said_ = now;
  say("WATCHDOG=1");
}

void ServiceManager::say(std::string_view words) const {
  sockaddr_un to{};
  to.sun_family = AF_UNIX;
  if (socket_.empty() || socket_.size() >= sizeof to.sun_path) return;
  std::memcpy(to.sun_path, socket_.data(), socket_.size());
  if (to.sun_path[0] == '@') to.sun_path[0] = '\0';
  const wire::FileDescriptor sender(::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0));
  const auto length = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + socket_.size());
  // A lost datagram is a beat that is missed: the next one comes in a quarter of the watchdog's time.
  static_cast<void>(::sendto(sender.get(), words.data(), words.size(), MSG_DONTWAIT | MSG_NOSIGNAL,
                             reinterpret_cast<const sockaddr*>(&to), length));
}

}  // namespace jaywalk
