// The live page of a run, and what clients of all kinds can do to it.
#include "apps/view/run_view.h"

#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <fstream>
#include <future>
#include <random>

#include "firmware/backends.h"
#include "firmware/robot/control_socket.h"
#include "firmware/robot/robot_file.h"
#include "hal/types/errors.h"
#include "hil/far_end/simulated_robot.h"
#include "tests/recording/scratch.h"
#include "tests/support/catch.h"
#include "tests/support/text.h"
#include "tests/view/hostile_process.h"
#include "tests/view/page_socket.h"

using namespace jaywalk;
using namespace jaywalk::view;
using namespace std::chrono_literals;

namespace {

RobotFile wiring() {
  RobotFile file = load_robot_file(std::string(JAYWALK_RIG) + "/drive/robot.toml");
  file.setup.backend = Backend::kCpu;
  return file;
}

/// The page's address, as the run leaves it beside its control socket.
std::string address_by(const std::filesystem::path& socket) {
  std::ifstream file(socket.string() + ".view");
  std::string url;
  std::getline(file, url);
  return url;
}

/// A page that has asked for the run's WebSocket with the token.
wire::FileDescriptor page_of(const std::string& url) {
  wire::FileDescriptor page = connected(port_of(url));
  say(page, upgrade("/ws" + query_of(url)));
  return page;
}

/// A run's control socket that keeps what it is told, and its page.
struct Bench {
  explicit Bench(const Scratch& scratch) : socket(scratch.folder() / "control") {}
  std::string told() {
    const std::scoped_lock lock(mutex);
    return lines;
  }

  std::filesystem::path socket;
  std::mutex mutex;
  std::string lines;
  std::promise<void> slow;  ///< lets the goal 0, 0 be answered
  ControlSocket control{socket, [this](std::string_view line) -> ControlReply {
                          const std::scoped_lock lock(mutex);
                          lines += std::string(line) + "\n";
                          const std::string said = "heard " + std::string(line) + "\n";
                          if (line != "goto 0 0") return ControlReply(said);
                          return ControlReply([this, said] { return slow.get_future().wait(), said; });
                        }};
  RunView page{{}, socket, "bench", wiring().setup, map_for(wiring().setup)};
};

}  // namespace

TEST_CASE("a goal through 127.0.0.1 wants the token that lies beside the control socket, a stop wants none") {
  const Scratch scratch;
  Bench bench(scratch);
  const std::string url = address_by(bench.socket);
  const std::uint16_t port = port_of(url);
  struct stat kind {};
  REQUIRE(::stat((bench.socket.string() + ".view").c_str(), &kind) == 0);
  CHECK((kind.st_mode & 0777U) == 0640U);

  const auto stranger = connected(port);
  say(stranger, upgrade("/ws") + frame(R"({"goal":[1,2]})"));
  CHECK(holds(heard(stranger), " 403 "));
  const auto stop = connected(port);
  say(stop, request("POST /stop"));
  CHECK(holds(heard(stop), "heard stop"));
  CHECK(bench.told() == "stop now\n");  // it latches

  const auto friendly = page_of(url);
  CHECK(holds(heard(friendly, "\r\n\r\n"), " 101 "));
  say(friendly, frame(R"({"goal":[1,2]})"));
  CHECK(holds(heard(friendly, "heard goto"), "heard goto"));
  CHECK(bench.told() == "stop now\ngoto 1 2\n");
  say(friendly, frame(R"({"here":[1,2,0.5]})"));
  CHECK(holds(heard(friendly, "heard here 1 2 0.5"), "heard here 1 2 0.5"));
}

TEST_CASE("the file with the address goes with the run, and a file of another kind in its place stays as it is") {
  const Scratch scratch;
  { const Bench bench(scratch); }
  const std::filesystem::path socket = scratch.folder() / "control", file = socket.string() + ".view";
  CHECK_FALSE(std::filesystem::exists(file));
  scratch.write("control.view", "precious");
  CHECK_THROWS_AS(AddressFile(socket, "http://127.0.0.1:1/?token=a"), StartupError);
  CHECK(scratch.read("control.view") == "precious");
  std::filesystem::remove(file);
  std::filesystem::create_symlink(scratch.write("elsewhere", "http://127.0.0.1:1/?token=a"), file);
  CHECK_THROWS_AS(AddressFile(socket, "http://127.0.0.1:1/?token=a"), StartupError);
  std::filesystem::remove(file);
  scratch.write("control.view", "http://127.0.0.1:1/?token=left");  // by a run that was killed
  { const AddressFile mine(socket, "http://127.0.0.1:2/?token=b"); }
  CHECK_FALSE(std::filesystem::exists(file));
}

TEST_CASE("a stop waits for no goal, takes back the one that waits, and follows the one on its way") {
  const Scratch scratch;
  Bench bench(scratch);
  const auto page = page_of(address_by(bench.socket));
  REQUIRE(holds(heard(page, "\r\n\r\n"), " 101 "));
  say(page, frame(R"({"goal":[0,0]})"));  // takes its time
  while (bench.told().empty()) std::this_thread::sleep_for(1ms);
  say(page, frame(R"({"goal":[2,2]})") + frame(R"({"stop":true})"));
  CHECK_FALSE(holds(heard(page, "heard stop"), "heard goto"));
  bench.slow.set_value();
  CHECK(holds(heard(page, "taken back"), "heard goto 0 0"));
  say(page, frame(R"({"goal":[3,3]})"));
  CHECK_FALSE(holds(heard(page, "heard goto 3 3"), "2 2"));
  say(page, frame(R"({"reset":true})"));
  CHECK_FALSE(holds(heard(page, "heard reset"), "stop"));
  CHECK(bench.told() == "goto 0 0\nstop now\nstop now\ngoto 3 3\nreset\n");
}

namespace {

struct Figures {
  long grown_kB = 0;
  std::uint64_t ticks = 0, missed = 0;
  double slowest_stop_ms = 0.0;
  int stops = 0, stops_heard = 0, pages = 0, pages_served = 0;
};

long resident_kB() {
  long pages = 0, resident = 0;
  std::ifstream("/proc/self/statm") >> pages >> resident;
  return resident * (::sysconf(_SC_PAGESIZE) / 1024);
}

/// A run in real time with its control socket and its page.
class PagedRun {
 public:
  PagedRun() {
    clock_.live = [this] { robot_.step_far_end(); };
    robot_.laser().start();
    while (robot_.laser().latest().sequence == 0) clock_.sleep_until(clock_.now() + 1ms);
    REQUIRE(robot_.loop().prepare({.priority = 50}).size() <= 2);  // what this machine does not permit
    static_cast<void>(robot_.drive().arm());
    robot_.loop().start();
  }
  ~PagedRun() { end(); }
  void end() {
    robot_.loop().end();
    while (!robot_.loop().has_ended()) follow(10ms);
  }
  /// Text that a page hears after its first frame, until it is told the end.
  std::string heard_to_the_end() {
    const auto page = page_of(address_by(socket_));
    std::string text, part(4096, '\0');
    while (!holds(text, R"("kind":"frame")")) {
      follow(10ms);
      const ssize_t got = ::recv(page.get(), part.data(), part.size(), MSG_DONTWAIT);
      if (got > 0) text.append(part, 0, static_cast<std::size_t>(got));
    }
    end();
    robot_.runner().finish({.outcome = "stopped"});
    return heard(page, R"("ended":"stopped")");
  }
  /// Beset for that long by clients in a process of their own, after two seconds in peace.
  Figures besiege(HostileProcess& hostile, std::chrono::seconds long_) {
    const std::string url = address_by(socket_), query = query_of(url);
    const auto page = page_of(url);
    follow(2s);
    const long before = resident_kB();
    const std::uint64_t missed = figures_.missed, ticks = figures_.ticks;
    hostile.begin(port_of(url), query);
    const auto end = std::chrono::steady_clock::now() + long_;
    while (std::chrono::steady_clock::now() < end) {
      follow(200ms);
      stop_once(port_of(url));
      const auto newcomer = connected(port_of(url));
      say(newcomer, request("GET /" + query));
      figures_.pages_served += holds(heard(newcomer), "<canvas") ? 1 : 0;
      ++figures_.pages;
      figures_.grown_kB = std::max(figures_.grown_kB, resident_kB() - before);
    }
    figures_.missed -= missed, figures_.ticks -= ticks;
    return figures_;
  }

 private:
  void follow(std::chrono::milliseconds for_) {
    SteadyClock mine;
    for (const Time end = mine.now() + for_; mine.now() < end; mine.sleep_until(mine.now() + 5ms)) {
      robot_.runner().drain();
      for (; robot_.loop().traces().front() != nullptr; robot_.loop().traces().pop()) {
        figures_.ticks = robot_.loop().traces().front()->status.ticks;
        figures_.missed = robot_.loop().traces().front()->status.missed_ticks;
      }
      page_.follow();
    }
  }
  void stop_once(std::uint16_t port) {
    const auto began = std::chrono::steady_clock::now();
    const auto peer = connected(port);
    say(peer, request("POST /stop"));
    figures_.stops_heard += holds(heard(peer), "\"said\"") ? 1 : 0;
    ++figures_.stops;
    const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - began;
    figures_.slowest_stop_ms = std::max(figures_.slowest_stop_ms, took.count());
  }

  Figures figures_;
  Scratch scratch_;
  std::filesystem::path folder_ = scratch_.folder() / "run", socket_ = scratch_.folder() / "beset";
  rig::RealLivingClock clock_;
  RunView page_{{}, socket_, "beset", wiring().setup, map_for(wiring().setup)};
  rig::InProcessRobot robot_{wiring(),
                             sim::load_scenario(std::string(JAYWALK_RIG) + "/drive/hall.toml"),
                             3,
                             clock_,
                             {folder_,
                              [this](const ControlSetup& setup) {
                                ChosenPlanner chosen = make_planner(setup);
                                chosen.planner =
                                    std::make_unique<PlannerThread>(std::move(chosen.planner), map_for(setup), page_);
                                return chosen;
                              },
                              &page_}};
  ControlSocket control_{socket_, [this](std::string_view line) { return robot_.desk().reply_to(line); }};
};

void beset(int clients, std::chrono::seconds for_) {
  HostileProcess hostile(clients);
  Figures figures;
  {
    PagedRun run;
    figures = run.besiege(hostile, for_);
  }
  std::printf("%d hostile clients: memory +%ld kB, %lu of %lu ticks missed, slowest of %d stops %.1f ms\n", clients,
              figures.grown_kB, figures.missed, figures.ticks, figures.stops, figures.slowest_stop_ms);
  CHECK(figures.stops_heard == figures.stops);
  CHECK(figures.pages_served == figures.pages);
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)  // these keep what was given back
  CHECK(figures.grown_kB < 20'000);
#endif
  CHECK(figures.ticks > 0);
}

}  // namespace

TEST_CASE("the page of a run on a robot is told that the run has ended, and how") {
  PagedRun run;
  CHECK(holds(run.heard_to_the_end(), R"("ended":"stopped")"));
}

TEST_CASE("a hundred hostile clients take neither memory nor a stop's or a newcomer's place") { beset(100, 5s); }

TEST_CASE("a thousand hostile clients take neither memory nor a stop's or a newcomer's place for a minute", "[long]") {
  beset(1000, 60s);
}
