#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <string>

#include "firmware/robot/service_manager.h"
#include "tests/support/catch.h"

using namespace jaywalk;
using namespace std::chrono_literals;

namespace {

/// In a process of its own: its exit code, or the signal that killed it, negative.
template <class Lives>
int outcome_of(Lives lives) {
  const pid_t child = ::fork();
  if (child == 0) {
    ::alarm(600);  // a test that hangs ends
    ::_exit(lives());
  }
  int status = 0;
  REQUIRE(::waitpid(child, &status, 0) == child);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
}

void await(const std::atomic<bool>& flag) {
  while (!flag) std::this_thread::sleep_for(1ms);
}

/// Standard error becomes a pipe that nobody reads and that takes no more; the process's own end of it is closed.
void hold_standard_error() {
  int ends[2];
  static_cast<void>(::pipe(ends));
  ::dup2(ends[1], STDERR_FILENO);
  ::fcntl(STDERR_FILENO, F_SETFL, O_NONBLOCK);
  const std::string much(65'536, 'x');
  static_cast<void>(!::write(STDERR_FILENO, much.data(), much.size()));
  ::fcntl(STDERR_FILENO, F_SETFL, 0);
}

int hears(int signal) {
  SignalThread thread(0);
  std::atomic<bool> heard{false}, round{false};
  const SignalThread::Handler handler(
      thread, [&] { heard = true; }, [&] { round = true; });
  await(round);
  ::kill(::getpid(), signal);
  await(heard);
  return 0;
}

}  // namespace

TEST_CASE(
    "SIGINT, SIGTERM and SIGHUP are heard by a thread of their own, nohup and a reader that is gone end nothing") {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) CHECK(outcome_of([signal] { return hears(signal); }) == 0);
  CHECK(outcome_of([] {
          ::signal(SIGHUP, SIG_IGN);
          const SignalThread thread(0);
          for (const int signal : {SIGHUP, SIGPIPE, SIGTSTP, SIGTTIN, SIGTTOU}) ::raise(signal);
          return 7;
        }) == 7);
}

TEST_CASE("before there is a loop to end, a signal does what it does to any program") {
  CHECK(outcome_of([] {
          const SignalThread thread(0);
          ::kill(::getpid(), SIGTERM);
          for (;;) ::pause();
          return 0;
        }) == -SIGTERM);
}

TEST_CASE("with a terminal that is held, remarks go on, signals are heard, and the end comes") {
  CHECK(outcome_of([] {
          hold_standard_error();
          const StderrRelay relay;
          for (int k = 0; k < 5000; ++k) remark("goal reached " + std::string(60, '.'));
          return hears(SIGTERM);
        }) == 0);
}

TEST_CASE("what standard error takes is passed on in order, and the next remark says how many lines were lost") {
  int ends[2];
  REQUIRE(::pipe(ends) == 0);
  const int code = outcome_of([&] {
    ::dup2(ends[1], STDERR_FILENO);
    {
      const StderrRelay relay;
      for (int k = 0; k < 10'000; ++k) remark("line " + std::to_string(k));  // far more than pipes take
      std::string part(4096, '\0');
      while (part.find("lost") == std::string::npos) {
        part.resize(4096);
        part.resize(static_cast<std::size_t>(std::max<ssize_t>(::read(ends[0], part.data(), part.size()), 0)));
        remark("another");
      }
    }
    return 0;
  });
  CHECK(code == 0);
  ::close(ends[0]), ::close(ends[1]);
}

TEST_CASE("where the reader of standard error is gone, remarks go nowhere and nothing ends") {
  CHECK(outcome_of([] {
          int ends[2];
          static_cast<void>(::pipe(ends));
          ::dup2(ends[1], STDERR_FILENO);
          ::close(ends[0]), ::close(ends[1]);
          const SignalThread thread(0);
          const StderrRelay relay;
          for (int k = 0; k < 5000; ++k) remark("to nobody");
          return 0;
        }) == 0);
}
