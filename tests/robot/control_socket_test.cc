#include "firmware/robot/control_socket.h"

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <cstring>
#include <fstream>

#include "hal/types/errors.h"
#include "tests/support/catch.h"

using namespace jaywalk;

namespace {

std::filesystem::path place() {
  return std::filesystem::temp_directory_path() / ("desk" + std::to_string(::getpid()) + ".sock");
}

std::string echo(std::string_view line) { return "heard " + std::string(line) + "\n"; }

/// What the socket answers to raw bytes.
std::string answer_to(const std::string& bytes) {
  const wire::FileDescriptor peer(::socket(AF_UNIX, SOCK_STREAM, 0));
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  std::strcpy(address.sun_path, place().c_str());
  REQUIRE(::connect(peer.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0);
  static_cast<void>(::send(peer.get(), bytes.data(), bytes.size(), MSG_NOSIGNAL));
  ::shutdown(peer.get(), SHUT_WR);
  std::string answer(1000, '\0');
  const ssize_t got = ::recv(peer.get(), answer.data(), answer.size(), MSG_WAITALL);
  answer.resize(got > 0 ? static_cast<std::size_t>(got) : 0);
  return answer;
}

}  // namespace

TEST_CASE("a line said to the control socket is answered") {
  const ControlSocket socket(place(), echo);
  CHECK(ask(place(), "status") == "heard status\n");
  CHECK(ask(place(), "goto 1 2") == "heard goto 1 2\n");
}

TEST_CASE("a line without end, too long or of odd bytes hurts nobody") {
  const ControlSocket socket(place(), echo);
  CHECK(answer_to("").empty());
  CHECK(answer_to("stat").empty());
  CHECK(answer_to(std::string(5000, 'x')).rfind("refused: too long a line", 0) == 0);
  CHECK(answer_to(std::string("\0\xff\n", 3)).size() == 9);
  CHECK(ask(place(), "status") == "heard status\n");
}

TEST_CASE("a second run does not take the first one's socket, and a dead one's is taken") {
  {
    const ControlSocket socket(place(), echo);
    CHECK_THROWS_AS(ControlSocket(place(), echo), StartupError);
    CHECK(ask(place(), "still there") == "heard still there\n");
  }
  CHECK_FALSE(std::filesystem::exists(place()));
  CHECK_THROWS_AS(ask(place(), "status"), StartupError);
  std::ofstream(place()) << "left behind";
  const ControlSocket socket(place(), echo);
  CHECK(ask(place(), "status") == "heard status\n");
}

TEST_CASE("a socket that cannot be made is refused") {
  CHECK_THROWS_AS(ControlSocket("/proc/nowhere/jaywalk.sock", echo), StartupError);
  CHECK_THROWS_AS(ControlSocket(std::string(200, 'a'), echo), StartupError);
}
