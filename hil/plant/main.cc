// The far end of the wires: a simulated robot behind real CAN frames and a real TCP scanner, in real time.
#include <poll.h>
#include <signal.h>
#include <sys/mman.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <utility>

#include "drivers/can/socketcan.h"
#include "firmware/robot/realtime.h"
#include "hal/types/errors.h"
#include "hil/emulators/byte_server.h"
#include "hil/plant/orders.h"

namespace {

using namespace jaywalk;

/// Short for drives and scanner. In User-Mode Linux a system call takes 40 us: more often would leave the controller
/// little of the processor.
constexpr Duration kStep = std::chrono::milliseconds(2);
constexpr int kStepsToOrders = 10;
/// A far end that was held up for longer is no fair judge.
constexpr Duration kNoise = std::chrono::milliseconds(15);

volatile sig_atomic_t ending = 0;

struct Options {
  std::filesystem::path scenario, robot, log;
  std::string can;
  std::uint64_t seed = 1;
  double for_s = 600.0;
  std::vector<std::string> orders;
};

Options options_from(int argc, char** argv, CLI::App& app) {
  Options options;
  app.add_option("scenario", options.scenario, "Scenario file (docs/reference/scenarios.md)")->required();
  app.add_option("--log", options.log, "File for what happens")->required();
  app.add_option("--seed", options.seed, "Seed of everything random");
  app.add_option("--for", options.for_s, "Seconds until it ends by itself");
  app.add_option("--robot", options.robot,
                 "The controller's side of the same wires (docs/tutorial/first-real-robot.md)")
      ->required();
  app.add_option("--can", options.can, "CAN interface (default: the controller's)");
  app.add_option("--order", options.orders, "What goes wrong from the start (hil/plant/orders.h)");
  app.parse(argc, argv);
  return options;
}

/// Orders come in lines on standard input; its end is nothing to worry about.
class OrderLines {
 public:
  void take(rig::SimulatedRobot& robot, rig::PlantLog& log, Time now) {
    pollfd in{.fd = STDIN_FILENO, .events = POLLIN, .revents = 0};
    if (ended_ || ::poll(&in, 1, 0) <= 0) return;
    char part[256];
    const ssize_t got = ::read(STDIN_FILENO, part, sizeof part);
    ended_ = got <= 0;
    if (got > 0) text_.append(part, static_cast<std::size_t>(got));
    for (std::size_t end = 0; (end = text_.find('\n')) != std::string::npos; text_.erase(0, end + 1)) {
      const std::string order = text_.substr(0, end);
      const std::string complaint = obey(order, robot);
      log.event(now, complaint.empty() ? "ordered: " + order : complaint);
    }
  }

 private:
  std::string text_;
  bool ended_ = false;
};

std::unique_ptr<CanBus> place_on_bus(const Options& options, const DriveWiring& drive, Clock& clock) {
  if (drive.kind == DriveKind::kPioneer)
    return std::make_unique<emulators::ServedBytes>(rig::make_far_wire(drive.line), clock);
  const std::array all{CanFilter{.id = 0, .mask = 0, .extended = drive.kind == DriveKind::kVesc}};
  return std::make_unique<SocketCan>(open_can(options.can.empty() ? drive.can : options.can, all), clock);
}

int run(int argc, char** argv) {
  CLI::App app{"The simulated robot at the far end of real wires. Orders on standard input: hil/plant/orders.h"};
  Options options;
  try {
    options = options_from(argc, argv, app);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  SteadyClock clock;
  const RobotFile wiring = load_robot_file(options.robot);
  const auto left = place_on_bus(options, wiring.drive, clock);
  const auto right = wiring.drive.is_on_can() ? place_on_bus(options, wiring.drive, clock) : nullptr;
  rig::SimulatedRobot robot(sim::load_scenario(options.scenario), options.seed, wiring,
                            {left.get(), right ? right.get() : left.get()}, rig::make_far_wires(wiring), clock.now());
  for (const std::string& order : options.orders)
    if (const std::string complaint = obey(order, robot); !complaint.empty())
      throw StartupError(complaint, "see --help");
  rig::PlantLog log(options.log, clock.now());
  static_cast<void>(enter_realtime({.priority = 60}));
  OrderLines orders;
  const Time end = clock.now() + duration_from_seconds(options.for_s);
  Time now = clock.now();
  Time due = now;
  for (int step = 0; ending == 0 && now < end; ++step) {
    clock.sleep_until(due);
    const Time before = std::exchange(now, clock.now());
    if (now - before > kNoise) log.late(now, now - before);
    if (step % kStepsToOrders == 0) orders.take(robot, log, now);
    robot.step(now);
    log.follow(robot, now);
    due = std::max(due + kStep, now);
  }
  log.finish(robot, clock.now());
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  ::signal(SIGTERM, [](int) { ending = 1; });
  ::signal(SIGINT, [](int) { ending = 1; });
  try {
    return run(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "plant: %s\n", error.what());
    return 2;
  }
}
