#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <thread>

#include "drivers/wired_drive.h"
#include "firmware/backends.h"
#include "firmware/program/program.h"
#include "firmware/recording/map_files.h"
#include "firmware/robot/control_socket.h"
#include "firmware/robot/operator_desk.h"
#include "firmware/robot/preflight.h"
#include "firmware/robot/realtime.h"
#include "firmware/robot/robot_devices.h"
#include "firmware/robot/robot_loop.h"
#include "firmware/robot/run_status.h"
#include "firmware/robot/service_manager.h"
#include "hal/shown_text.h"
#include "hal/types/errors.h"

namespace jaywalk {
namespace {

/// SAFETY: a stall of the loop that is longer than this stops the drives, whatever else happens.
constexpr Duration kLongestStall = std::chrono::milliseconds(100);
constexpr std::chrono::milliseconds kReportPeriod{20};

/// What the loop's thread left for the report, and a line for a person where something happened.
class LoopReport {
 public:
  LoopReport(LoopRunner& runner, RobotLoop& loop, TickObserver& observer)
      : runner_(runner), loop_(loop), observer_(observer) {}

  void follow() {
    runner_.drain();
    for (const TickTrace* t = loop_.traces().front(); t != nullptr; t = loop_.traces().front()) {
      runner_.report({.record = t->record,
                      .tracks = {t->tracks.begin(), t->tracks.size()},
                      .tick_took = t->took,
                      .plan_took = t->plan_took});
      tell(t->status);
      last_ = t->status;
      loop_.traces().pop();
    }
    observer_.follow();
  }
  [[nodiscard]] const RunStatus& last() const { return last_; }

 private:
  void tell(const RunStatus& now) const {
    if (now.latched && (!last_.latched || now.latched_by != last_.latched_by)) {
      std::string drive = now.drive == DriveTrouble::kNone ? "" : " (" + std::string(name(now.drive)) + ")";
      if (now.drive_fault.is_told()) drive += " (" + describe(now.drive_fault) + ")";
      if (now.foreign_frame) drive += " (" + to_text(*now.foreign_frame) + ")";
      remark("stopped by " + to_string(now.latched_by, now.faulty_scanners) + drive +
             "; see to it, then jaywalk reset");
    }
    if (!now.latched && last_.latched) remark("reset; say anew where to go");
    if (now.place.number != last_.place.number && now.place.why == PlaceAnswer::Why::kForced)
      remark("a person says by force where the robot is: no scan was held against it");
    if (now.goal_reached && !last_.goal_reached) remark("goal reached");
  }

  LoopRunner& runner_;
  RobotLoop& loop_;
  TickObserver& observer_;
  RunStatus last_;
};

/// The last run was killed or crashed on the way: this one waits for a person (SAFETY 6: no automatic restart).
void latch_at_start(OperatorDesk& desk) {
  static_cast<void>(desk.obey("stop now"));
  remark("the last run ended without disarming the drives: latched; see to it, then jaywalk reset");
}

/// Before the drives may turn a wheel: what the kernel did not permit, a line each.
std::vector<std::string> entered_realtime(const RealtimeWishes& wishes, RobotLoop& loop) {
  std::vector<std::string> not_permitted;
  if (wishes.lock_memory) not_permitted = lock_memory();
  if (wishes.priority > 0) keep_processors_awake();
  for (const std::string& line : loop.prepare(wishes)) not_permitted.push_back(line);
  require_realtime(wishes, not_permitted);
  return not_permitted;
}

std::string outcome(const RunStatus& last) {
  if (last.latched) return "fault";
  return last.goal_reached ? "reached" : "stopped";
}

std::filesystem::path socket_for(const RunOptions& options, const RobotFile& file) {
  if (!options.control_socket.empty()) return options.control_socket;
  return file.control_socket.empty() ? default_control_socket() : file.control_socket;
}

/// [{"part": "file", "ok": true, "state": "ok", "said": "..."}, ...]
void print_json(const std::vector<CheckedPart>& parts) {
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (const CheckedPart& part : parts)
    rows.push_back({{"part", part.part}, {"ok", part.is_well}, {"state", state_of(part)}, {"said", part.said}});
  std::printf("%s\n", rows.dump(1).c_str());
}

/// With a map and no start: where the first scan was taken.
void locate_on_map(const std::filesystem::path& path, RobotFile& file, Clock& clock) {
  if (!file.setup.known_map || file.knows_start) return;
  const std::unique_ptr<ScannerConnection> laser = make_laser(file, clock);
  await_first_scan(*laser, file, clock);
  LaserScan scan = laser->latest();
  blank(file.setup.model.laser.blanked, scan);
  file.setup.start = located_on(*file.setup.known_map, scan, file.setup.model.laser, path.string() + ": map: ");
  file.setup.goal = file.setup.start.position();
  const Pose2& start = file.setup.start;
  remark(formatted("found on the map at %.2f, %.2f, heading %.2f", start.x, start.y, start.heading));
}

RobotFile load_robot(const RunOptions& options) {
  RobotFile file = load_robot_file(options.robot);
  file.setup.backend = options.backend;
  file.setup.device = options.device;
  if (options.allow_no_realtime) file.realtime.required = false;
  return file;
}

/// Where this run leaves its files: a folder of its own below --runs, or --out, where no earlier run's are.
void choose_folder(RunOptions& options, std::optional<RunFolder>& folder) {
  if (!options.runs.empty()) options.out = folder.emplace(options.runs, std::chrono::system_clock::now()).path();
  const std::filesystem::path kept = set_aside(options.out);
  if (!kept.empty()) remark("the recording of an earlier run lies in " + kept.string() + " now");
}

/// The drives are disarmed: writes what a run leaves. Returns the process's exit code.
int conclude(const RunOptions& options, LoopRunner& runner, const LoopReport& report, const LoopTimes& times) {
  const RunStatus& last = report.last();
  const std::string robot = options.robot.filename().string();
  const double off_rad = last.heading_error_rad;
  const std::filesystem::path shown =
      runner.finish({.outcome = outcome(last),
                     .success = outcome(last) == "reached",
                     .heading_error_rad = std::isnan(off_rad) ? std::nullopt : std::optional(off_rad),
                     .missed_ticks = last.missed_ticks,
                     .loop_times = &times,
                     .scenario = robot,
                     .title = robot + ": " + outcome(last)});
  if (options.save_map) save_map(runner.loop().tracker().still(), options.out);
  runner.require_recorded();
  remark("disarmed; " + outcome(last) + "; see " + shown.string());
  return last.latched ? 1 : 0;
}

}  // namespace

int run_robot(RunOptions options, const MakeObserver& make_observer) {
  RobotFile file = load_robot(options);
  const StderrRelay relay;
  SignalThread signals(order_priority(file.realtime));
  if (const std::string said = require_commissioned(options.robot, file, options.uncommissioned); !said.empty())
    remark(said);
  if (file.panel) require_joystick(*file.panel);
  std::optional<RunFolder> folder;
  choose_folder(options, folder);
  ServiceManager service = ServiceManager::from_environment();
  ArmedMark armed(folder_of_marks(), file.drive.can);
  SteadyClock clock;
  locate_on_map(options.robot, file, clock);
  RobotDevices devices(file, clock);
  OperatorControls controls(file, devices.drive(), clock, [&] { return restart_link(file.drive.can); });
  OperatorDesk& desk = controls.desk();
  const ControlSocket::Answer answer = [&](std::string_view line) { return desk.reply_to(line); };
  const ControlSocket socket(socket_for(options, file), answer, order_priority(file.realtime));
  const std::unique_ptr<TickObserver> observer = make_observer(options, file, socket_for(options, file));
  file.setup.unix_from_loop = std::chrono::system_clock::now().time_since_epoch() - clock.now().time_since_epoch();
  LoopRunner runner(
      file.setup,
      {devices.laser(), devices.drive(), controls.panel(), desk.told_place(), clock, devices.other_lasers()},
      {options.out, options.parts}, *observer, [&](const ControlSetup& setup) {
        ChosenPlanner chosen = make_planner(setup);
        remark("plans on " + std::string(chosen.planner->backend()) +
               (chosen.why_not_cuda.empty() ? "" : " (" + chosen.why_not_cuda + ")"));
        chosen.planner = std::make_unique<PlannerThread>(std::move(chosen.planner), map_for(setup), *observer);
        return chosen;
      });
  StallGuard guard(devices.brake(), clock, kLongestStall);
  RobotLoop loop(runner, {devices.drive(), devices.lasers(), devices.bus(), controls.resets()}, desk, clock, guard,
                 *observer);
  const std::vector<std::string> not_permitted = entered_realtime(file.realtime, loop);
  controls.start(order_priority(file.realtime));
  devices.start();
  armed.set();
  const std::vector<std::string> proof = devices.drive().arm();
  write_arming(options.out, proof);
  if (folder) folder->keep(options.kept);
  if (armed.was_left()) latch_at_start(desk);
  guard.start(guard_priority(file.realtime));
  loop.start();
  while (loop.ticks() == 0 && !loop.has_ended())
    std::this_thread::sleep_for(kReportPeriod);  // no goal is accepted before the first tick
  for (const std::string& line : not_permitted) remark(line);
  remark("armed: " + in_short(proof) + "; ready for jaywalk goto X,Y [HEADING]");
  service.ready();

  const SignalThread::Handler ends(
      signals, [&] { service.stopping(), loop.end(); }, [&] { service.alive(loop.ticks(), clock.now()); });
  LoopReport report(runner, loop, *observer);
  for (; !loop.has_ended(); std::this_thread::sleep_for(kReportPeriod)) report.follow();
  service.loop_has_ended();
  report.follow();
  write_devices(options.out, file.drive, report.last(), not_permitted);
  return conclude(options, runner, report, loop.times());
}

int check_robot(const RunOptions& options) {
  const RobotFile file = load_robot(options);
  const CommissioningRecord record = read_commissioned(options.robot, file);
  std::vector<CheckedPart> parts{
      {"file", true, options.robot.string()},
      {"commissioned", record.state != Commissioned::kFailed, record.said, record.state != Commissioned::kPassed}};
  SteadyClock clock;
  const auto waits_for = [](const std::string& part) { remark("waits for " + printable(part)); };
  for (const CheckedPart& part : preflight(file, socket_for(options, file), clock, waits_for)) parts.push_back(part);
  if (options.json) {
    print_json(parts);
  } else {
    for (const CheckedPart& part : parts)
      std::printf("%-4s  %-15s %s\n", part.is_well ? state_of(part) : "FAIL", part.part.c_str(),
                  printable(part.said).c_str());
  }
  return std::all_of(parts.begin(), parts.end(), [](const CheckedPart& part) { return part.is_well; }) ? 0 : 1;
}

}  // namespace jaywalk
