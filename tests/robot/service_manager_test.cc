#include "firmware/robot/service_manager.h"

#include <fcntl.h>
#include <fnmatch.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <string>
#include <vector>

#include "tests/recording/scratch.h"
#include "tests/robot/local_socket.h"
#include "tests/support/catch.h"

using namespace jaywalk;
using namespace std::chrono_literals;

namespace {

Time at(double seconds) { return time_from_seconds(seconds); }

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

/// Patterns of DeviceAllow: names as in /proc/devices, or paths.
std::vector<std::string> permitted_devices() {
  std::ifstream unit(std::string(JAYWALK_EXAMPLES) + "/../systemd/jaywalk.service");
  std::vector<std::string> patterns;
  for (std::string line; std::getline(unit, line);) {
    const std::string key = "DeviceAllow=";
    if (line.starts_with(key)) patterns.push_back(line.substr(key.size(), line.find(' ') - key.size()));
  }
  return patterns;
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

TEST_CASE("systemd is told ready, stopping, and that no loop is to be watched any more") {
  const Scratch scratch;
  const wire::FileDescriptor systemd = tests::bound_to(scratch.path("notify"), SOCK_DGRAM);
  const ServiceManager run(scratch.path("notify"), {});
  run.ready();
  CHECK(tests::heard_by(systemd) == "READY=1\nSTATUS=armed");
  run.stopping();
  CHECK(tests::heard_by(systemd) == "STOPPING=1");
  run.loop_has_ended();
  CHECK(tests::heard_by(systemd) == "STOPPING=1\nWATCHDOG_USEC=0");
}

TEST_CASE("the watchdog hears a loop that ticks, four times in its time, and none that hangs") {
  const Scratch scratch;
  const wire::FileDescriptor systemd = tests::bound_to(scratch.path("notify"), SOCK_DGRAM);
  ServiceManager run(scratch.path("notify"), std::chrono::seconds(2));
  run.alive(1, at(10.0));
  CHECK(tests::heard_by(systemd) == "WATCHDOG=1");
  run.alive(2, at(10.4));
  CHECK(tests::heard_by(systemd).empty());
  run.alive(3, at(10.5));
  CHECK(tests::heard_by(systemd) == "WATCHDOG=1");
  for (double t = 11.0; t < 20.0; t += 0.5) run.alive(3, at(t));  // the loop hangs
  CHECK(tests::heard_by(systemd).empty());
}

TEST_CASE("without systemd, without its watchdog and with a socket that is gone nothing happens") {
  ServiceManager alone("", std::chrono::seconds(2));
  alone.ready();
  alone.alive(1, at(1.0));
  ServiceManager("/nowhere/at/all", std::chrono::seconds(2)).alive(1, at(1.0));
  const Scratch scratch;
  const wire::FileDescriptor systemd = tests::bound_to(scratch.path("notify"), SOCK_DGRAM);
  ServiceManager(scratch.path("notify"), {}).alive(1, at(1.0));
  CHECK(tests::heard_by(systemd).empty());
}

// The sandbox lets the planner open the GPUs of a PC and of a Jetson, and the joystick and scanners it had.
TEST_CASE("the service may open the devices of GPUs, serial scanners and joysticks") {
  const std::vector<std::string> patterns = permitted_devices();
  REQUIRE(patterns.size() > 5);
  const auto permits = [&](const char* name) {
    return std::ranges::any_of(patterns, [&](const std::string& p) { return fnmatch(p.c_str(), name, 0) == 0; });
  };
  // /proc/devices of drivers 470 to 570 on a PC, and of JetPack 6 on an Orin; nvmap there is of "misc", by its path.
  for (const char* name :
       {"char-nvidia-frontend", "char-nvidia", "char-nvidiactl", "char-nvidia-uvm", "char-nvidia-caps",
        "char-nvidia-modeset", "char-nvhost-ctrl-gpu", "char-nvhost", "char-nvgpu", "char-nvgpu-ctrl", "char-host1x",
        "char-drm", "/dev/nvmap", "/dev/host1x-fence", "/dev/cpu_dma_latency", "char-ttyUSB", "char-ttyACM",
        "char-ttyTHS", "char-input"}) {
    CAPTURE(name);
    CHECK(permits(name));
  }
  for (const char* name : {"char-mem", "char-misc", "block-sd", "/dev/kvm"}) {
    CAPTURE(name);
    CHECK_FALSE(permits(name));
  }
}
