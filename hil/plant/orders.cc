#include "hil/plant/orders.h"

#include <cstdio>
#include <cstdlib>
#include <optional>
#include <sstream>

#include "hal/types/errors.h"
#include "hal/types/trig.h"

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

std::string order_scanner(std::istringstream& words, SimulatedRobot& robot) {
  std::string what;
  double seconds = 0.0;
  words >> what;
  if (const auto answer = order_loss(what, words, robot.scanner())) return *answer;
  words >> seconds;
  ScannerFault fault = ScannerFault::kNone;
  if (what == "reset") fault = ScannerFault::kReset;
  if (what == "half") fault = ScannerFault::kHalfTelegram;
  if (what == "halves") fault = ScannerFault::kHalves;
  if (what == "silence") fault = ScannerFault::kSilence;
  if (what == "garbage") fault = ScannerFault::kGarbage;
  if (what == "gone") fault = ScannerFault::kGone;
  if (fault == ScannerFault::kNone) return "no such fault of a scanner: " + what;
  robot.scanner().order(fault, duration_from_seconds(seconds));
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

template <class... Values>
std::string text(const char* format, Values... values) {
  char line[200];
  std::snprintf(line, sizeof line, format, values...);
  return line;
}

}  // namespace

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
  const canopen::ObjectAddress object{static_cast<std::uint16_t>(number), static_cast<std::uint8_t>(sub)};
  if (what == "emergency")
    drive.raise_fault(static_cast<std::uint16_t>(number));
  else if (what == "unplug")
    drive.pull_cable();
  else if (what == "plug")
    drive.plug_cable();
  else if (what == "lie" && drive.objects() != nullptr)
    drive.objects()->lie_about(object);
  else if (what == "lack" && drive.objects() != nullptr)
    drive.objects()->lack(object);
  else
    return "no such order: " + std::string(order);
  return "";
}

PlantLog::PlantLog(const std::filesystem::path& file, Time start) : file_(file), start_(start) {
  if (!file_) throw StartupError(file.string() + ": cannot be written", "give --log a file that can");
  event(start, "ready");
}

void PlantLog::event(Time now, const std::string& words) {
  file_ << text("%.3f ", to_seconds(now - start_)) << words << std::endl;
}

void PlantLog::late(Time now, Duration by) { event(now, text("late by %.0f ms", 1e3 * to_seconds(by))); }

void PlantLog::follow(SimulatedRobot& robot, Time now) {
  for (std::size_t side = 0; side < 2; ++side) follow_drive(robot, side, now);
  follow_motion(robot, now);
}

void PlantLog::follow_drive(SimulatedRobot& robot, std::size_t side, Time now) {
  const WheelDrive& drive = robot.drive(side);
  if (drive.heard_controller() != kNever && drive.heard_controller() != heard_[side]) {
    heard_[side] = drive.heard_controller();
    speed_heard_mps_ = robot.rim_speed();
  }
  if (drive.state_name() == state_[side]) return;
  state_[side] = drive.state_name();
  event(now, std::string(side == 0 ? "left " : "right ") + state_[side]);
}

void PlantLog::follow_motion(SimulatedRobot& robot, Time now) {
  const Vec2 place = robot.truth().map_from_robot.position();
  if (has_place_) way_m_ += distance(place_, place);
  place_ = place;
  has_place_ = true;
  const double speed = robot.rim_speed();
  if (!moving_ && speed > kMoves_mps) {
    moving_ = true;
    event(now, "moving");
  }
  if (moving_ && speed == 0.0) {
    moving_ = false;
    const double silent_ms = 1e3 * to_seconds(now - std::max(heard_[0], heard_[1]));
    event(now,
          text("at rest, %.0f ms after the controller was last heard, from %.3f m/s", silent_ms, speed_heard_mps_));
  }
}

void PlantLog::finish(SimulatedRobot& robot, Time now) {
  const sim::Truth& truth = robot.truth();
  const CanHealth bus = robot.bus_health();
  event(now,
        text("ends at %.3f %.3f %.3f", truth.map_from_robot.x, truth.map_from_robot.y, truth.map_from_robot.heading));
  event(now, text("drove %.2f m", way_m_));
  event(now, text("contacts %u caused %u forced %u", truth.contacts, truth.contacts_caused, truth.forced_movers));
  event(now, text("frames lost %llu malformed %llu", static_cast<unsigned long long>(bus.frames_lost),
                  static_cast<unsigned long long>(bus.malformed)));
  event(now, "drives " + std::string(robot.drive(0).state_name()) + " " + std::string(robot.drive(1).state_name()));
}

}  // namespace jaywalk::rig
