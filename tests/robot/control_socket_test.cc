#include "firmware/robot/control_socket.h"

#include <fstream>
#include <thread>

#include "hal/text_file.h"
#include "hal/types/errors.h"
#include "tests/robot/local_socket.h"
#include "tests/support/catch.h"

using namespace jaywalk;

namespace {

const auto place = tests::control_place;

std::string echo(std::string_view line) { return "heard " + std::string(line) + "\n"; }

/// What the socket answers to raw bytes.
std::string answer_to(const std::string& bytes) {
  const wire::FileDescriptor peer = tests::connected_to(place());
  tests::say(peer, bytes);
  ::shutdown(peer.get(), SHUT_WR);
  return tests::heard_by(peer, MSG_WAITALL);
}

}  // namespace

TEST_CASE("the answer to a place is waited for while the run searches its map") {
  const ControlSocket socket(place(), [](std::string_view) {
    return ControlReply(
        [] { return std::this_thread::sleep_for(std::chrono::milliseconds(3500)), std::string("there\n"); });
  });
  CHECK(ask(place(), "here 1 2 0") == "there\n");
}

TEST_CASE("a line without end, too long or of odd bytes hurts nobody") {
  const ControlSocket socket(place(), echo);
  CHECK(answer_to("").empty());
  CHECK(answer_to("stat").empty());
  CHECK(answer_to(std::string(5000, 'x')).starts_with("refused: too long a line"));
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
  { const wire::FileDescriptor dead = tests::bound_to(place(), SOCK_STREAM); }
  const ControlSocket socket(place(), echo);
  CHECK(ask(place(), "status") == "heard status\n");
}

TEST_CASE("what has the socket's name and is none is kept, whatever it is, and the run is refused") {
  std::ofstream(place()) << "precious";
  CHECK_THROWS_WITH(ControlSocket(place(), echo), Catch::Matchers::Contains("is there, and no socket of this user's"));
  CHECK(text_in(place()) == "precious");
  const std::filesystem::path link = place().string() + ".link";
  std::filesystem::remove(link);
  std::filesystem::create_symlink(place(), link);
  CHECK_THROWS_AS(ControlSocket(link, echo), StartupError);
  CHECK(std::filesystem::is_symlink(link));
  CHECK(std::filesystem::is_regular_file(place()));
  std::filesystem::remove(link);
  std::filesystem::remove(place());
}

TEST_CASE("the end of a run takes its own socket away and nothing that lies there by then") {
  {
    const ControlSocket socket(place(), echo);
    std::filesystem::remove(place());
    std::ofstream(place()) << "precious";
  }
  CHECK(std::filesystem::is_regular_file(place()));
  std::filesystem::remove(place());
}

TEST_CASE("a stop is one however it is said, as the last words of a client and after others in one write") {
  const ControlSocket socket(place(), echo);
  const auto check_heard = [](const char* said, const std::string& line) {
    INFO(said);
    CHECK(answer_to(said) == "heard " + line);
  };
  for (const char* said : {"stop now\r\n", "STOP NOW\n", "stop  now \n", "  Stop\tnow", "stop now",
                           "goto 1 2\nstop now\n", "status\nstop now", "stop\nstop now\n", "emergency stop\n",
                           "Emergency!", "estop\n", "halt now\n", "\xEF\xBB\xBFstop now\n"})
    check_heard(said, "stop now\n");
  for (const char* said : {"stop", "stop\r\n", "stop here!\n", "goto 1 2\r\nSTOP\r\n", "Stopp\n", "halt\n", "HALT \r\n",
                           "\xEF\xBB\xBFstop\n", "stop \t\r\r\n", "/stop\n", "\"stop\"\n"})
    check_heard(said, "stop\n");
  for (const char* said : {"goto 1 2\n", "non stop\n", "sto\n"}) check_heard(said, said);
}

TEST_CASE("a socket that cannot be made is refused") {
  CHECK_THROWS_AS(ControlSocket("/proc/nowhere/jaywalk.sock", echo), StartupError);
  CHECK_THROWS_AS(ControlSocket(std::string(200, 'a'), echo), StartupError);
}
