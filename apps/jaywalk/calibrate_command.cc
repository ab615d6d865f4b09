#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <fstream>
#include <iostream>
#include <iterator>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "apps/jaywalk/commands.h"
#include "apps/setup/calibration.h"
#include "apps/setup/watched_drive.h"
#include "apps/why/recorded_run.h"
#include "firmware/control_setup.h"
#include "firmware/recording/recorder.h"
#include "firmware/robot/control_socket.h"
#include "firmware/robot/preflight.h"
#include "firmware/robot/realtime.h"
#include "firmware/robot/robot_devices.h"
#include "hal/shown_text.h"
#include "hal/text_file.h"
#include "hal/types/errors.h"

namespace jaywalk {
namespace {

// The residuals of each motion as a picture.

constexpr double kSide = 360.0, kMargin = 50.0;
constexpr const char* kBelieved = "#b0b0b0";
constexpr const char* kFoundColour = "#1f5fbf";

/// A square panel, `most` of its unit from its middle to its edge.
struct Panel {
  double left, most;

  [[nodiscard]] std::string frame(const std::string& title) const {
    return formatted(
        "<rect x='%.0f' y='%.0f' width='%.0f' height='%.0f' fill='none' stroke='#888'/>"
        "<path d='M%.0f %.0fh%.0fM%.0f %.0fv%.0f' stroke='#ddd'/>"
        "<text x='%.0f' y='%.0f'>%s, to %.3g at the rim</text>\n",
        left, kMargin, kSide, kSide, left, kMargin + 0.5 * kSide, kSide, left + 0.5 * kSide, kMargin, kSide, left,
        kMargin - 12.0, title.c_str(), most);
  }
  [[nodiscard]] std::string dot(double x, double y, const char* colour) const {
    const auto inside = [this](double value) { return 0.5 * kSide * std::clamp(value / most, -1.0, 1.0); };
    return formatted("<circle cx='%.1f' cy='%.1f' r='3' fill='%s'/>\n", left + 0.5 * kSide + inside(x),
                     kMargin + 0.5 * kSide - inside(y), colour);
  }
};

/// The residuals, as believed and as found: x and y (mm) and turns (mrad). An SVG without a script.
std::string svg_of(const Calibration& calibration) {
  double way_m = 1e-6, turn_rad = 1e-6;  // the greatest
  for (const auto* residuals : {&calibration.before, &calibration.after}) {
    for (const Pose2& r : *residuals) {
      way_m = std::max({way_m, std::fabs(r.x), std::fabs(r.y)});
      turn_rad = std::max(turn_rad, std::fabs(r.heading));
    }
  }
  const Panel ways{kMargin, 1e3 * way_m}, turns{2.0 * kMargin + kSide, 1e3 * turn_rad};
  std::string svg = formatted(
      "<svg xmlns='http://www.w3.org/2000/svg' width='%.0f' height='%.0f' font-family='sans-serif' "
      "font-size='13'>\n<rect width='100%%' height='100%%' fill='white'/>\n",
      3.0 * kMargin + 2.0 * kSide, 2.0 * kMargin + kSide);
  svg += ways.frame("wheels less scans: x, y (mm)") + turns.frame("turn (mrad), by motion");
  for (const auto& [residuals, colour] :
       {std::pair{&calibration.before, kBelieved}, std::pair{&calibration.after, kFoundColour}}) {
    for (std::size_t k = 0; k < residuals->size(); ++k) {
      const Pose2& r = (*residuals)[k];
      const double along = 2.0 * static_cast<double>(k + 1) / static_cast<double>(residuals->size() + 1) - 1.0;
      svg += ways.dot(1e3 * r.x, 1e3 * r.y, colour) + turns.dot(along * turns.most, 1e3 * r.heading, colour);
    }
  }
  return svg + formatted("<text x='%.0f' y='%.0f'>grey: as believed; blue: as found</text>\n</svg>\n", kMargin,
                         kSide + 2.0 * kMargin - 18.0);
}

struct SessionOptions {
  std::filesystem::path robot;           ///< ROBOT.toml
  std::filesystem::path control_socket;  ///< empty: the file's
  bool yes = false;                      ///< consent that the wheels may turn: the program does not ask for it
  bool allow_no_realtime = false;        ///< goes on where the kernel refuses what the file asks for
};

std::atomic<bool> to_stop{false};

void require_consent(bool yes, const std::string& name, const std::string& motion) {
  if (yes) return;
  if (::isatty(STDIN_FILENO) == 0)
    throw StartupError(name + ": the wheels will turn, and nobody is there to be asked",
                       "give --yes where the answer is yes: " + motion);
  std::fprintf(stderr, "%s [yes/no] ", motion.c_str());
  std::string answer;
  std::getline(std::cin, answer);
  if (answer != "yes") throw StartupError(name + ": not confirmed", "answer yes, or give --yes");
}

std::string obey_stop(std::string_view line) {
  if (line != "stop" && line != "stop now") return "refused: the wheels are being turned; it knows stop\n";
  to_stop = true;
  return "stopping\n";
}

/// The robot of a file, armed while this lives. The command drives the wheels itself; the control loop does not run.
/// Its motions end where `jaywalk stop`, SIGINT or SIGTERM say so. Once a process.
class ArmedSession {
 public:
  /// `name`: the command's; `motion`: what a person is asked to allow, "The wheels will turn ... Is ... free?" Throws
  /// StartupError where it may not begin.
  ArmedSession(const SessionOptions& options, const std::string& name, const std::string& motion)
      : file_(load_robot_file(options.robot)) {
    if (options.allow_no_realtime) file_.realtime.required = false;
    require_consent(options.yes, name, motion);
    std::filesystem::path place = options.control_socket.empty() ? file_.control_socket : options.control_socket;
    socket_ = std::make_unique<ControlSocket>(place.empty() ? default_control_socket() : place, obey_stop);
    std::signal(SIGINT, [](int) { to_stop = true; });
    std::signal(SIGTERM, [](int) { to_stop = true; });
    devices_ = std::make_unique<RobotDevices>(file_, clock_);
    devices_->start();
    for (const auto& laser : devices_->lasers()) lasers_.push_back(laser.get());
    std::vector<std::string> refused;
    if (file_.realtime.lock_memory) refused = lock_memory();
    std::ranges::move(enter_realtime(file_.realtime), std::back_inserter(refused));
    require_realtime(file_.realtime, refused);  // before the drives may turn a wheel
    static_cast<void>(devices_->drive().arm());
  }
  /// Disarms the drives, which are at rest already.
  ~ArmedSession() {
    const Time limit = clock_.now() + std::chrono::milliseconds(500);
    do {
      static_cast<void>(devices_->drive().latest());
      devices_->drive().disarm();
      clock_.sleep_until(clock_.now() + std::chrono::milliseconds(10));
    } while (devices_->drive().is_enabled() && clock_.now() < limit);
  }

  [[nodiscard]] const RobotFile& file() const { return file_; }
  [[nodiscard]] ArmedRobot robot() {
    const auto stopped = [] { return to_stop.load(); };
    return {file_.setup.model, devices_->drive(), lasers_, clock_, stopped, file_.setup.tick()};
  }

 private:
  RobotFile file_;
  SteadyClock clock_;
  std::unique_ptr<ControlSocket> socket_;
  std::unique_ptr<RobotDevices> devices_;
  std::vector<LaserScanner*> lasers_;  ///< devices_'s
};

SessionOptions calibrate_options;
std::filesystem::path plot_folder = "out/calibrate";

/// A calibration drive: a log of each scanner, and the wheel radii in the drives' settings. The loop counts with the
/// model's radius for both wheels.
struct Drive {
  std::vector<CalibrationLog> logs;
  RobotModel model;
  std::array<double, 2> radii_m;
};

Drive drive_robot() {
  ArmedSession session(
      calibrate_options, "calibrate",
      "The robot will drive 1.5 m ahead and back, and a circle to each side, for about a minute. Are 2 m "
      "free ahead, and a metre to each side and behind?");
  const RobotFile& file = session.file();
  return {drive_guided(session.robot()), file.setup.model, file.drive.wheel_radii_m};
}

/// What devices.json of the run says; the model's where there is none, as of a simulation.
std::array<double, 2> radii_beside(const std::filesystem::path& folder, const RobotModel& model) {
  std::ifstream file(folder / "devices.json");
  const nlohmann::json json = nlohmann::json::parse(file, nullptr, false);
  const std::array<double, 2> models{model.drive.wheel_radius_m, model.drive.wheel_radius_m};
  return json.is_object() && json.contains("wheel_radii_m") ? json["wheel_radii_m"].get<std::array<double, 2>>()
                                                            : models;
}

Drive read_recording(const std::filesystem::path& run) {
  RecordedRun recorded(run);
  const RobotModel& model = recorded.setup().model;
  std::vector<CalibrationLog> logs(model.lasers().size(), CalibrationLog(model.drive));
  while (recorded.step())
    for (std::size_t k = 0; k < logs.size(); ++k) logs[k].take(recorded.last().wheels, recorded.last().scans()[k]);
  return {std::move(logs), model, radii_beside(recorded.folder(), model)};
}

/// "calibration.svg"; of several scanners "calibration_rear.svg" and so on.
std::filesystem::path plot_of(const RobotModel& model, std::size_t scanner) {
  const std::string name = scanner_name(model, scanner);
  return plot_folder / (name.empty() ? "calibration.svg" : "calibration_" + name + ".svg");
}

void print_line(const char* what, const char* unit, double believed, double found, double within) {
  std::printf("%-20s %10.5f %-4s %10.5f %-4s +-%.5f\n", what, believed, unit, found, unit, within);
}

/// The radii as a robot file has them: `calibration` has them as the loop counted.
std::array<double, 2> in_file(const Drive& drive, const RobotGeometry& as_counted) {
  const double believed_m = drive.model.drive.wheel_radius_m;
  return {drive.radii_m[0] * as_counted.left_radius_m / believed_m,
          drive.radii_m[1] * as_counted.right_radius_m / believed_m};
}

void print_found(const Drive& drive, std::size_t scanner, const Calibration& calibration) {
  const RobotGeometry &found = calibration.found, &within = calibration.within;
  const auto radii_m = in_file(drive, found), radii_within_m = in_file(drive, within);
  const LaserModel& laser = drive.model.lasers()[scanner];
  const Pose2 &mount = found.robot_from_laser, &was = laser.robot_from_laser, &off = within.robot_from_laser;
  const std::string name = scanner_name(drive.model, scanner);
  std::printf("%-20s %10s %-4s %10s %-4s %s\n", name.empty() ? "" : ("by the " + name + " scanner").c_str(), "was", "",
              "is", "", "95 %");
  print_line("left wheel radius", "m", drive.radii_m[0], radii_m[0], radii_within_m[0]);
  print_line("right wheel radius", "m", drive.radii_m[1], radii_m[1], radii_within_m[1]);
  print_line("track width", "m", drive.model.drive.track_width_m, found.track_width_m, within.track_width_m);
  print_line("laser x", "m", was.x, mount.x, off.x);
  print_line("laser y", "m", was.y, mount.y, off.y);
  print_line("laser yaw", "rad", was.heading, mount.heading, off.heading);
  std::printf("%zu motions, and %zu that fit nothing; residuals: %s\n\n", calibration.after.size(),
              calibration.left_out, plot_of(drive.model, scanner).c_str());
}

/// Prints the robot file's keys. Wheel radii and track width come from the scanner that finds the track width with the
/// smallest uncertainty. Each scanner's mount comes from its own scans.
void print_keys(const Drive& drive, const std::vector<Calibration>& each) {
  const RobotGeometry& wheels =
      std::ranges::min_element(each, {}, [](const Calibration& c) { return c.within.track_width_m; })->found;
  const auto radii_m = in_file(drive, wheels);
  std::printf(
      "# for ROBOT.toml; then jaywalk commission again\n[drive]\nleft_wheel_radius_m = %.5f\n"
      "right_wheel_radius_m = %.5f\ntrack_width_m = %.5f\n",
      radii_m[0], radii_m[1], wheels.track_width_m);
  for (std::size_t k = 0; k < each.size(); ++k) {
    const Pose2& mount = each[k].found.robot_from_laser;
    const std::string name = scanner_name(drive.model, k);
    std::printf("%s\nmount = [%.4f, %.4f, %.5f]\n", name.empty() ? "[laser]" : ("[[laser]]  # " + name).c_str(),
                mount.x, mount.y, mount.heading);
  }
}

/// Half a per cent of a radius, one of the track, a centimetre, half a degree.
bool is_sharp(const Calibration& calibration) {
  const RobotGeometry &found = calibration.found, &within = calibration.within;
  const Pose2& mount = within.robot_from_laser;
  return within.left_radius_m < 0.005 * found.left_radius_m && within.right_radius_m < 0.005 * found.right_radius_m &&
         within.track_width_m < 0.01 * found.track_width_m && mount.x < 0.01 && mount.y < 0.01 &&
         mount.heading < 0.5 * kPi / 180.0;
}

int calibrate_robot() {
  const std::filesystem::path& what = calibrate_options.robot;
  const bool is_folder = std::filesystem::is_directory(what);
  if (!is_folder)
    require_readable(what, what.string() + ": ", "give a robot file, a run's folder or its recording.jwr");
  const bool is_run = is_folder || is_recording(what.string());
  const Drive drive = is_run ? read_recording(what) : drive_robot();
  std::vector<Calibration> each;
  for (std::size_t k = 0; k < drive.logs.size(); ++k) {
    const std::string name = scanner_name(drive.model, k);
    each.push_back(calibrate(drive.logs[k], believed_of(drive.model, k),
                             name.empty() ? "scans" : "the " + name + " scanner's scans"));
    std::filesystem::create_directories(plot_folder);
    write_text(plot_of(drive.model, k), svg_of(each.back()), "see to the folder's rights and the disk's room");
    print_found(drive, k, each.back());
  }
  print_keys(drive, each);
  if (std::ranges::all_of(each, is_sharp)) return 0;
  std::fputs("jaywalk: the intervals are too wide to be of use; drive farther, straight on and round\n", stderr);
  return 1;
}

// Commissioning: each wheel is turned a little.

std::vector<Nudge> nudge_robot(const SessionOptions& options, RobotFile& file) {
  ArmedSession session(options, "commission",
                       "The wheels will turn, each by 12 cm, forward and back. Is half a metre free all round?");
  file = session.file();
  withdraw_commissioned(options.robot, file);
  return nudge_wheels(session.robot());
}

int commission_robot(const SessionOptions& options) {
  RobotFile file;
  const std::vector<Nudge> nudges = nudge_robot(options, file);
  const std::vector<CheckedPart> checks = judge_nudges(nudges, file.setup.model);
  for (const CheckedPart& check : checks)
    std::printf("%-4s  %-15s %s\n", check.is_well ? "ok" : "FAIL", check.part.c_str(), check.said.c_str());
  write_commissioned(options.robot, file, checks);
  return std::ranges::all_of(checks, &CheckedPart::is_well) ? 0 : 1;
}

/// Options of a command that arms the drives.
void add_session_options(CLI::App& command, SessionOptions& options, const char* may) {
  command.add_option("--socket", options.control_socket, "Control socket (default: the file's)");
  command.add_flag("--yes", options.yes, may);
  command.add_flag("--allow-no-realtime", options.allow_no_realtime,
                   "Go on where the kernel refuses real-time priority or locked memory");
}

}  // namespace

void add_commission(CLI::App& app, int& exit_code) {
  static SessionOptions options;
  CLI::App* command = app.add_subcommand("commission", "Turn each wheel a little and check how all is wired");
  command->add_option("robot", options.robot, "Robot file (TOML; docs/tutorial/first-real-robot.md)")->required();
  add_session_options(*command, options, "The wheels may turn: do not ask");
  command->callback([&exit_code] { exit_code = commission_robot(options); });
}

void add_calibrate(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand("calibrate", "Wheel radii, track width and laser mount, by a drive or a run");
  command
      ->add_option("robot", calibrate_options.robot, "Robot file, which is driven; or a run's folder, or recording.jwr")
      ->required();
  command->add_option("--out", plot_folder, "Folder for calibration.svg, the residuals")->capture_default_str();
  add_session_options(*command, calibrate_options, "The robot may drive: do not ask");
  command->callback([&exit_code] { exit_code = calibrate_robot(); });
}

}  // namespace jaywalk
