#include "firmware/robot/service_manager.h"

#include <string>

#include "drivers/wire/file_descriptor.h"
#include "tests/recording/scratch.h"
#include "tests/robot/socket_address.h"
#include "tests/support/catch.h"

namespace jaywalk {
namespace {

/// systemd's end: a datagram socket.
class Listener {
 public:
  explicit Listener(const std::string& path) : socket_(::socket(AF_UNIX, SOCK_DGRAM, 0)) {
    const sockaddr_un at = tests::address_of(path);
    REQUIRE(::bind(socket_.get(), reinterpret_cast<const sockaddr*>(&at), sizeof at) == 0);
  }
  /// The next message; empty where none has come.
  [[nodiscard]] std::string next() const {
    char text[256];
    const ssize_t length = ::recv(socket_.get(), text, sizeof text, MSG_DONTWAIT);
    return length < 0 ? std::string() : std::string(text, static_cast<std::size_t>(length));
  }

 private:
  wire::FileDescriptor socket_;
};

Time at(double seconds) { return time_from_seconds(seconds); }

TEST_CASE("systemd is told ready, stopping, and that no loop is to be watched any more") {
  const Scratch scratch;
  const Listener systemd(scratch.path("notify"));
  const ServiceManager run(scratch.path("notify"), {});
  run.ready();
  CHECK(systemd.next() == "READY=1\nSTATUS=armed");
  run.stopping();
  CHECK(systemd.next() == "STOPPING=1");
  run.loop_has_ended();
  CHECK(systemd.next() == "STOPPING=1\nWATCHDOG_USEC=0");
}

TEST_CASE("the watchdog hears a loop that ticks, four times in its time, and none that hangs") {
  const Scratch scratch;
  const Listener systemd(scratch.path("notify"));
  ServiceManager run(scratch.path("notify"), std::chrono::seconds(2));
  run.alive(1, at(10.0));
  CHECK(systemd.next() == "WATCHDOG=1");
  run.alive(2, at(10.4));
  CHECK(systemd.next().empty());
  run.alive(3, at(10.5));
  CHECK(systemd.next() == "WATCHDOG=1");
  for (double t = 11.0; t < 20.0; t += 0.5) run.alive(3, at(t));  // the loop hangs
  CHECK(systemd.next().empty());
}

TEST_CASE("without systemd, without its watchdog and with a socket that is gone nothing happens") {
  ServiceManager alone("", std::chrono::seconds(2));
  alone.ready();
  alone.alive(1, at(1.0));
  ServiceManager("/nowhere/at/all", std::chrono::seconds(2)).alive(1, at(1.0));
  const Scratch scratch;
  const Listener systemd(scratch.path("notify"));
  ServiceManager(scratch.path("notify"), {}).alive(1, at(1.0));
  CHECK(systemd.next().empty());
}

}  // namespace
}  // namespace jaywalk
