#include "firmware/robot/preflight.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <time.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <thread>

#include "drivers/panel/joystick.h"
#include "firmware/backends.h"
#include "firmware/robot/control_socket.h"
#include "firmware/robot/operator_desk.h"
#include "firmware/robot/robot_devices.h"
#include "firmware/safety/blind_gaps.h"
#include "firmware/safety/stop_zone.h"
#include "hal/shown_text.h"
#include "hal/types/errors.h"

namespace jaywalk {
namespace {

std::string first_line(const char* path) {
  std::string line;
  std::getline(std::ifstream(path) >> std::ws, line);
  return line;
}

std::string check_clock() {
  const std::string source = first_line("/sys/devices/system/clocksource/clocksource0/current_clocksource");
  timespec step{};
  ::clock_getres(CLOCK_MONOTONIC, &step);
  if (step.tv_sec != 0 || step.tv_nsec > 1000 || source.find("jiffies") != std::string::npos) {
    throw StartupError("steps of " + std::to_string(step.tv_nsec) + " ns, source " + source,
                       "use a kernel with high-resolution timers, and no clocksource= of its own on its command line");
  }
  const bool realtime = first_line("/sys/kernel/realtime") == "1";
  return (source.empty() ? "source not told" : source) +
         std::string(realtime ? ", PREEMPT_RT" : ", no real-time kernel");
}

/// What is said of a thing that may be wished for and not required.
std::string judged(const RealtimeWishes& wishes, const std::vector<std::string>& refused, const std::string& well,
                   const std::string& otherwise) {
  if (refused.empty()) return well;
  if (wishes.required) throw StartupError(refused.front(), otherwise);
  return refused.front() + "; not required";
}

/// In a thread of its own: this one stays as it is.
std::string check_realtime(const RealtimeWishes& wishes) {
  std::vector<std::string> refused;
  std::thread([&] { refused = enter_realtime(wishes); }).join();
  const std::string well =
      wishes.priority == 0 ? "an ordinary thread is asked for" : "SCHED_FIFO " + std::to_string(wishes.priority);
  return judged(wishes, refused, well, "or set [realtime] priority = 0, or required = false");
}

std::string check_memory(const RealtimeWishes& wishes) {
  if (!wishes.lock_memory) return "is not to be locked";
  const std::vector<std::string> refused = lock_memory();
  ::munlockall();
  return judged(wishes, refused, "can be locked", "or set [realtime] lock_memory = false, or required = false");
}

std::string check_socket(const std::filesystem::path& path) {
  const ControlSocket trial(path, [](std::string_view) { return std::string(); });
  return path.string();
}

bool a_run_listens(const std::filesystem::path& path) {
  try {
    return !ask(path, "status").empty();
  } catch (const StartupError&) {
    return false;
  }
}

std::string check_link(const std::string& can) {
  const LinkFacts link = link_facts(can);
  const bool needs_rate = !link.exists || link.kind == "can";  // virtual ones and serial adapters have theirs elsewhere
  const std::string bring_up = "ip link set " + can + (needs_rate ? " up type can bitrate 500000" : " up");
  if (!link.exists) throw StartupError("no such interface", "load its driver, then: " + bring_up);
  if (!link.is_can)
    throw StartupError("is no CAN interface", "give [drive] can the one that is: ip link show type can");
  if (!link.is_up || (needs_rate && link.bitrate == 0)) throw StartupError("is down or has no bit rate", bring_up);
  if (link.state && *link.state != CanState::kActive) {
    throw StartupError("is " + std::string(name(*link.state)),
                       "see to wires, termination and bit rate, then set it down and up");
  }
  const std::string rate = link.bitrate > 0 ? std::to_string(link.bitrate) + " bit/s" : "no bit rate of its own";
  return "up, " + (link.kind.empty() ? std::string("can") : link.kind) + ", " + rate;
}

std::string check_joystick(const panel::JoystickSetup& setup, Clock& clock) {
  require_joystick(setup);
  panel::Joystick joystick(setup);
  joystick.poll(clock.now());
  const panel::JoystickState state = joystick.state();
  if (!state.connected) throw StartupError(setup.path + ": is not there", "plug it in, or correct [panel] joystick");
  refuse_unrenewed(state, setup);
  if (state.stop) throw StartupError(setup.path + ": its stop is pressed, or not known", "release it");
  return setup.path + ": connected, stop released";
}

/// Lists what each part says for itself.
struct Inspection {
  const std::function<void(const std::string&)>& waits_for;
  std::vector<CheckedPart> parts{};

  /// Returns whether the part is well.
  bool look(const std::string& part, const std::function<std::string()>& at) {
    if (waits_for) waits_for(part);
    try {
      parts.push_back({part, true, at()});
    } catch (const StartupError& error) {
      parts.push_back({part, false, error.what()});
    }
    return parts.back().is_well;
  }
};

std::string check_drive(const DriveWiring& wiring, std::size_t side, Clock& clock) {
  const BusLock lock(wiring.can);
  const std::unique_ptr<CanBus> bus = make_bus(wiring, clock);
  return make_drive(wiring, *bus, clock)->inspect(side);
}

constexpr Duration kRateSpan = std::chrono::seconds(1);
constexpr double kRateTolerance = 0.1;

void require_rate(const std::string& said, double rate_hz, double wanted_hz) {
  // One more or fewer may fall into the span.
  if (std::fabs(rate_hz - wanted_hz) > std::fmax(kRateTolerance * wanted_hz, 1.0))
    throw StartupError(said, "correct [laser] rate_hz, or set the scanner's");
}

/// "[[laser.blanked]] from_deg = 10.5, to_deg = 14.0" and so on: the beams that end on the robot, and the next ones.
std::string sectors_on_body(const StopZone& zone, const LaserScan& scan) {
  constexpr double kDegPerRad = 180.0 / kPi;
  const double step_deg = static_cast<double>(scan.angle_step_rad) * kDegPerRad;
  std::string sectors;
  for (std::size_t beam = 0; beam < scan.beam_count; ++beam) {
    if (!zone.is_on_body(scan, beam)) continue;
    const double first_deg = scan.angle_rad(beam) * kDegPerRad - step_deg;
    while (beam + 1 < scan.beam_count && zone.is_on_body(scan, beam + 1)) ++beam;
    const double last_deg = scan.angle_rad(beam) * kDegPerRad + step_deg;
    sectors += formatted(" [[laser.blanked]] from_deg = %.1f, to_deg = %.1f", std::min(first_deg, last_deg),
                         std::max(first_deg, last_deg));
  }
  return sectors;
}

void require_free_body(const std::string& said, const LaserScan& scan, const Footprint& body, const Pose2& mount) {
  const StopZone zone({.footprint = body, .robot_from_laser = mount});
  const std::size_t on_body = zone.beams_on_body(scan);
  if (on_body == 0) return;
  throw StartupError(said + ", " + std::to_string(on_body) + " of the beams end within the robot's own outline",
                     "take away what is before it, or correct [laser] mount or the model's footprint; for what belongs "
                     "there write" +
                         sectors_on_body(zone, scan));
}

/// Throws where the loop would take the sight for lost by and by.
void require_sight(const std::string& said, const LaserScan& scan, const LaserModel& laser) {
  BlindGaps gaps(laser);
  gaps.update(scan);
  const BeamCounts& counts = gaps.counts();
  SightLoss sight;
  const bool at_once = sight.is_lost(counts, Time{}), in_time = sight.is_lost(counts, Time{std::chrono::minutes(1)});
  if (!at_once && !in_time) return;
  throw StartupError(said + ", " + std::to_string(counts.lost) + " of the beams measured nothing, " +
                         std::to_string(counts.lost_ahead) + " of them ahead",
                     "clean its window, take away what covers it, or shade it");
}

}  // namespace

void require_joystick(const panel::JoystickSetup& setup) {
  const std::string& path = setup.path;
  const char* const remedy = "give an evdev device (/dev/input/by-id/...-event-joystick), and join the group input";
  if (!std::filesystem::exists(path)) return;
  const wire::FileDescriptor device(::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC));
  if (device.get() < 0) throw StartupError(path + ": is no joystick that this user may read", remedy);
  const std::string lacks = panel::lacking(panel::keys_of(device.get()), setup);
  if (lacks.empty()) return;
  const bool has_others = lacks.rfind("has no ", 0) == 0;
  throw StartupError(path + ": " + lacks, has_others ? "press it and read its number: evtest " + path : remedy);
}

std::vector<CheckedPart> preflight(const RobotFile& file, const std::filesystem::path& control_socket, Clock& clock,
                                   const std::function<void(const std::string&)>& waits_for) {
  Inspection inspection{waits_for};
  inspection.look("clock", check_clock);
  inspection.look("priority", [&] { return check_realtime(file.realtime); });
  inspection.look("memory", [&] { return check_memory(file.realtime); });
  const bool has_socket = inspection.look("control socket", [&] { return check_socket(control_socket); });
  if (!has_socket && a_run_listens(control_socket)) return inspection.parts;
  inspection.look("planner", [&] { return tried_backend(file.setup.backend, file.setup.device); });
  if (!file.drive.is_on_can() || inspection.look(file.drive.can, [&] { return check_link(file.drive.can); })) {
    inspection.look("left drive", [&] { return check_drive(file.drive, 0, clock); });
    inspection.look("right drive", [&] { return check_drive(file.drive, 1, clock); });
  }
  for (std::size_t k = 0; k < file.lasers().size(); ++k) {
    const std::string name = scanner_name(file.setup.model, k);
    inspection.look(name.empty() ? "scanner" : name + " scanner", [&] { return check_scanner(file, clock, k); });
  }
  if (file.panel) inspection.look("joystick", [&] { return check_joystick(*file.panel, clock); });
  return inspection.parts;
}

std::string check_scanner(const RobotFile& file, Clock& clock, std::size_t scanner) {
  const std::unique_ptr<ScannerConnection> laser = make_laser(file, clock, scanner);
  const LaserModel& model = file.setup.model.lasers()[scanner];
  await_first_scan(*laser, file, clock, scanner);
  const std::uint32_t before = laser->latest().sequence;
  clock.sleep_until(clock.now() + kRateSpan);
  LaserScan scan = laser->latest();
  blank(model.blanked, scan);
  const double rate_hz = (scan.sequence - before) / to_seconds(kRateSpan);
  const std::string said = laser->name() + formatted(": %u beams, %.0f scans a second", scan.beam_count, rate_hz);
  require_free_body(said, scan, file.setup.model.footprint, model.robot_from_laser);
  require_sight(said, scan, model);
  require_rate(said, rate_hz, model.rate_hz);
  return said;
}

}  // namespace jaywalk
