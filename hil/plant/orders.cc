#include "hil/plant/orders.h"

#include <cstdlib>
#include <optional>
#include <sstream>

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
  if (what == "emergency") {
    drive.raise_fault(static_cast<std::uint16_t>(number));
  } else if (what == "unplug") {
    drive.pull_cable();
  } else if (what == "plug") {
    drive.plug_cable();
  } else if (what == "lie" && drive.objects() != nullptr) {
    drive.objects()->lie_about(object);
  } else if (what == "lack" && drive.objects() != nullptr) {
    drive.objects()->lack(object);
  } else {
    return "no such order: " + std::string(order);
  }
  return "";
}

}  // namespace jaywalk::rig
