// The far end of the wires: a simulated robot behind real CAN frames and a real TCP scanner, in real time.
#include <poll.h>
#include <signal.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <optional>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>

#include "drivers/can/socketcan.h"
#include "firmware/robot/realtime.h"
#include "hal/shown_text.h"
#include "hal/types/errors.h"
#include "hal/types/trig.h"
#include "hil/emulators/byte_server.h"
#include "hil/emulators/cia402_node.h"
#include "hil/far_end/simulated_robot.h"

namespace jaywalk::rig {
namespace {

using emulators::ScannerFault;
using emulators::Window;

std::string soil(emulators::ScannerServer& scanner, Window window) {
  return scanner.set_window(window) ? "" : "this kind of scanner has no word for dirt";
}

/// What stays so until it is whole again; nothing where it is no such order.
std::optional<std::string> order_loss(const std::string& what, std::istringstream& words,
                                      emulators::ScannerServer& scanner) {
  double first = 0.0, second = 0.0;
  if (what == "soiled") return soil(scanner, Window::kSoiled);
  if (what == "dirty") return soil(scanner, Window::kDirty);
  if (what == "lose") {
    if (!(words >> first >> second)) return "from and to, in degrees?";
    scanner.lose_sector(first * kPi / 180.0, second * kPi / 180.0);
    return "";
  }
  if (what == "damage") {
    if (!(words >> first) || !(first >= 0.0 && first <= 1.0)) return "a share, 0 to 1?";
    scanner.damage_share(first);
    return "";
  }
  if (what != "whole") return std::nullopt;
  scanner.find_beams();
  scanner.damage_share(0.0);
  static_cast<void>(scanner.set_window(Window::kClean));
  return "";
}

struct FaultRow {
  std::string_view order;
  ScannerFault fault;
};
constexpr std::array kFaults{FaultRow{"reset", ScannerFault::kReset},     FaultRow{"half", ScannerFault::kHalfTelegram},
                             FaultRow{"halves", ScannerFault::kHalves},   FaultRow{"silence", ScannerFault::kSilence},
                             FaultRow{"garbage", ScannerFault::kGarbage}, FaultRow{"gone", ScannerFault::kGone}};

std::string order_scanner(std::istringstream& words, SimulatedRobot& robot) {
  std::string what;
  double seconds = 0.0;
  words >> what;
  if (const auto answer = order_loss(what, words, robot.scanner())) return *answer;
  words >> seconds;
  const auto* const row = std::ranges::find(kFaults, what, &FaultRow::order);
  if (row == kFaults.end()) return "no such fault of a scanner: " + what;
  robot.scanner().order(row->fault, duration_from_seconds(seconds));
  return "";
}

/// "701#05": a standard frame, or an extended one where the identifier has eight digits.
std::string order_frame(std::istringstream& words, SimulatedRobot& robot) {
  std::string text;
  words >> text;
  const std::size_t mark = text.find('#');
  CanFrame frame;
  frame.extended = mark == 8;
  const bool fits = mark != std::string::npos && (text.size() - mark - 1) % 2 == 0 && text.size() - mark - 1 <= 16;
  if (!fits) return "no frame: " + text;
  frame.id = static_cast<std::uint32_t>(std::strtoul(text.substr(0, mark).c_str(), nullptr, 16));
  for (std::size_t at = mark + 1; at < text.size(); at += 2)
    frame.bytes[frame.size++] = static_cast<std::uint8_t>(std::strtoul(text.substr(at, 2).c_str(), nullptr, 16));
  robot.say_as_stranger(frame);
  return "";
}

constexpr double kMoves_mps = 0.005;  ///< a wheel that turns faster is under way; at 0 it is at rest

/// What happened at the far end, for judging a run: a line an event, "SECONDS words", seconds since start.
///
/// A drive's state that changes; the wheels begin to turn, come to rest and how; at the end what the world knows.
/// A rest says how long after the controller's last heartbeat it came, where that is what ended the drive:
/// "at rest, 513 ms after the controller was last heard, from 0.612 m/s".
class PlantLog {
 public:
  /// Throws StartupError where the file cannot be written.
  PlantLog(const std::filesystem::path& file, Time start) : file_(file), start_(start) {
    if (!file_) throw StartupError(file.string() + ": cannot be written", "give --log a file that can");
    event(start, "ready");
  }

  void event(Time now, const std::string& words) {
    file_ << formatted("%.3f ", to_seconds(now - start_)) << words << std::endl;
  }

  /// Notes that this program itself ran late; the controller under test is not to blame.
  void late(Time now, Duration by) { event(now, formatted("late by %.0f ms", 1e3 * to_seconds(by))); }

  void follow(SimulatedRobot& robot, Time now) {
    for (std::size_t side = 0; side < 2; ++side) follow_drive(robot, side, now);
    follow_motion(robot, now);
  }

  void finish(SimulatedRobot& robot, Time now) {
    const sim::Truth& truth = robot.truth();
    const CanHealth bus = robot.bus_health();
    event(now, formatted("ends at %.3f %.3f %.3f", truth.map_from_robot.x, truth.map_from_robot.y,
                         truth.map_from_robot.heading));
    event(now, formatted("drove %.2f m", way_m_));
    event(now,
          formatted("contacts %u caused %u forced %u", truth.contacts, truth.contacts_caused, truth.forced_movers));
    event(now, formatted("frames lost %llu malformed %llu", static_cast<unsigned long long>(bus.frames_lost),
                         static_cast<unsigned long long>(bus.malformed)));
    event(now, "drives " + std::string(robot.drive(0).state_name()) + " " + std::string(robot.drive(1).state_name()));
  }

 private:
  void follow_drive(SimulatedRobot& robot, std::size_t side, Time now) {
    const WheelDrive& drive = robot.drive(side);
    if (drive.heard_controller() != kNever && drive.heard_controller() != heard_[side]) {
      heard_[side] = drive.heard_controller();
      speed_heard_mps_ = robot.rim_speed();
    }
    if (drive.state_name() == state_[side]) return;
    state_[side] = drive.state_name();
    event(now, std::string(side == 0 ? "left " : "right ") + state_[side]);
  }

  void follow_motion(SimulatedRobot& robot, Time now) {
    const Vec2 place = robot.truth().map_from_robot.position();
    if (place_) way_m_ += distance(*place_, place);
    place_ = place;
    const double speed = robot.rim_speed();
    if (!moving_ && speed > kMoves_mps) {
      moving_ = true;
      event(now, "moving");
    }
    if (moving_ && speed == 0.0) {
      moving_ = false;
      const double silent_ms = 1e3 * to_seconds(now - std::max(heard_[0], heard_[1]));
      event(now, formatted("at rest, %.0f ms after the controller was last heard, from %.3f m/s", silent_ms,
                           speed_heard_mps_));
    }
  }

  std::ofstream file_;
  Time start_;
  std::array<std::string, 2> state_{"off", "off"};
  std::array<Time, 2> heard_{kNever, kNever};
  bool moving_ = false;
  double speed_heard_mps_ = 0.0;  ///< of the faster wheel, at the controller's last heartbeat
  double way_m_ = 0.0;
  std::optional<Vec2> place_;
};

/// What the far end is told to do wrong, a line an order:
///
///   emergency left|right CODE    a drive breaks, and says so (CODE as in CiA 301, or its own; hexadecimal)
///   unplug left|right            its cable is pulled; plug puts it back
///   lie left|right INDEX SUB     a CiA 402 drive acknowledges writes to an object (hexadecimal) and ignores them
///   lack left|right INDEX SUB    it has no such object
///   say 701#05                   a frame as another program would send it; eight digits: an extended identifier
///   scanner reset|half           the connection is torn; half a telegram comes
///   scanner halves|silence|garbage|gone SECONDS
///   scanner lose FROM_DEG TO_DEG a sector measures nothing, counter-clockwise in the laser's frame
///   scanner damage SHARE         of all messages so many are damaged, 0 to 1
///   scanner soiled|dirty         it warns of dirt on its window; it says that it can measure no more
///   scanner whole                an end of the last four
///
/// Returns what is wrong with the order; empty where it was obeyed.
std::string obey(std::string_view order, SimulatedRobot& robot) {
  std::istringstream words{std::string(order)};
  std::string what, side;
  words >> what;
  if (what == "scanner") return order_scanner(words, robot);
  if (what == "say") return order_frame(words, robot);
  unsigned number = 0, sub = 0;
  words >> side >> std::hex >> number >> sub;
  if (side != "left" && side != "right") return "left or right? " + std::string(order);
  WheelDrive& drive = robot.drive(side == "left" ? 0 : 1);
  auto* const canopen = dynamic_cast<emulators::Cia402Node*>(&drive);
  const jaywalk::canopen::ObjectAddress object{static_cast<std::uint16_t>(number), static_cast<std::uint8_t>(sub)};
  if (what == "emergency")
    drive.raise_fault(static_cast<std::uint16_t>(number));
  else if (what == "unplug")
    drive.pull_cable();
  else if (what == "plug")
    drive.plug_cable();
  else if (what == "lie" && canopen != nullptr)
    canopen->objects().lie_about(object);
  else if (what == "lack" && canopen != nullptr)
    canopen->objects().lack(object);
  else
    return "no such order: " + std::string(order);
  return "";
}

}  // namespace
}  // namespace jaywalk::rig

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
  app.add_option("--order", options.orders, "What goes wrong from the start (hil/plant/main.cc)");
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
      const std::string complaint = rig::obey(order, robot);
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
  CLI::App app{"The simulated robot at the far end of real wires. Orders on standard input: hil/plant/main.cc"};
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
    if (const std::string complaint = rig::obey(order, robot); !complaint.empty())
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
