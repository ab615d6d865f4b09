#include <bit>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <memory>
#include <sstream>
#include <thread>

#include "apps/formats/bag_file.h"
#include "apps/formats/logs/log_checks.h"
#include "apps/formats/logs/log_replay.h"
#include "apps/formats/mcap_writer.h"
#include "apps/jaywalk/commands.h"
#include "apps/jaywalk/progress.h"
#include "apps/report/run_observer.h"
#include "apps/setup/clock_search.h"
#include "apps/setup/mount_search.h"
#include "apps/view/live_view.h"
#include "apps/why/recorded_run.h"
#include "firmware/control_loop.h"
#include "firmware/recording/recorded_hal.h"
#include "firmware/recording/run_folders.h"
#include "hal/robot_model_file.h"
#include "hal/shown_text.h"
#include "hal/text_file.h"
#include "hal/types/errors.h"

namespace jaywalk {
namespace {

struct ReplayOptions : LoopOptions {
  std::vector<std::filesystem::path> logs;
  std::string format;                  ///< scan-odom, carmen, bag or jaywalk; empty: by what the file begins with
  std::string scan_topic, odom_topic;  ///< of a bag; empty: the only one of its type
  std::optional<Vec2> goal;            ///< default: the recording's last pose
  std::optional<Pose2> laser_mount;    ///< robot_from_laser; default: the log's own word, else the robot's origin
  std::string model;  ///< p3dx, wheelchair, or a robot model file; empty: p3dx, its laser at the origin
};

constexpr double kGoalTolerance_m = 0.3;

/// A line of numbers begins a scan-odom file; CARMEN's lines begin with a message's name.
bool begins_with_a_name(const std::filesystem::path& file) {
  sim::LineFile lines(file);
  return lines.next() && (std::isalpha(static_cast<unsigned char>(lines.words()[0][0])) != 0);
}

std::string format_of(const ReplayOptions& options) {
  if (!options.format.empty()) return options.format;
  if (!parts_of(options.logs.front()).empty()) return "jaywalk";
  if (exchange::is_bag(options.logs.front())) return "bag";
  if (is_recording(options.logs.front().string())) return "jaywalk";
  return begins_with_a_name(options.logs.front()) ? "carmen" : "scan-odom";
}

sim::RecordedLog load(const ReplayOptions& options, const std::string& format) {
  const std::size_t most = format == "scan-odom" ? 2 : 1;
  if (options.logs.size() > most) {
    throw StartupError(options.logs[most].string() + ": one file too many for " + format,
                       format == "scan-odom" ? "give SCAN.txt and, where there is one, ODOM.txt" : "give one log");
  }
  const Pose2 models = options.model.empty() ? Pose2{} : robot_model(options.model).laser.robot_from_laser;
  if (format == "bag")
    return exchange::load_bag(options.logs[0], {options.scan_topic, options.odom_topic, options.laser_mount, models});
  const Pose2 mount = options.laser_mount.value_or(models);
  if (format == "carmen") return sim::load_carmen(options.logs[0], mount);
  return sim::load_scan_odom(options.logs[0], options.logs.size() > 1 ? std::optional(options.logs[1]) : std::nullopt,
                             mount);
}

/// A recording does not say what carried the laser: a P3-DX stands in where nobody else does, with the log's own laser
/// and drive.
ControlSetup setup_for(const sim::LogReplay& log, const ReplayOptions& options) {
  ControlSetup setup;
  setup.model = options.model.empty() ? p3dx() : robot_model(options.model);
  setup.model.laser = log.log().laser();
  setup.model.drive = log.drive();
  setup.start = log.start_pose();
  setup.goal = options.goal.value_or(log.last_pose().value_or(setup.start).position());
  setup.goal_tolerance_m = kGoalTolerance_m;
  setup.wheels = log.last_pose().has_value();
  setup.judges_motion = false;  // they obeyed another controller
  return setup;
}

/// The page of a replay: it shows any tick and takes no goals.
std::unique_ptr<LiveView> view_for(const ReplayOptions& options, const LoopRunner& runner) {
  if (!options.view) return nullptr;
  auto live = std::make_unique<LiveView>(
      *options.view, runner.setup(), true,
      [](const view::ViewOrder&, const view::Reply& reply) { reply("a recording takes no orders\n"); });
  live->begin({.title = options.logs[0].filename().string(),
               .known = runner.setup().known_map.get(),
               .takes_goals = false,
               .takes_pauses = false});
  return live;
}

/// After a tick. A subscriber to the stream of messages gets it at the recording's own pace.
void show(LiveView* view, const LoopRunner& runner) {
  if (view == nullptr) return;
  view->follow(runner, "");
  if (view->has_subscribers()) std::this_thread::sleep_for(runner.setup().tick());
}

/// Where nobody says how the laser is mounted: as matching has it.
std::optional<double> find_mount(const ReplayOptions& options, sim::RecordedLog& log) {
  const bool said = options.laser_mount || !options.model.empty() || log.robot_from_laser != Pose2{};
  const std::optional<double> yaw = said ? std::nullopt : found_mount_yaw(log);
  if (!yaw) return std::nullopt;
  log.robot_from_laser.heading = *yaw;
  std::fprintf(
      stderr,
      "jaywalk: the laser is mounted turned by %.2f rad, as scans and wheels agree; --laser-mount X,Y,YAW says "
      "otherwise\n",
      *yaw);
  return yaw;
}

/// Brings the odometry to the scans' clock, as the turns of both agree.
std::optional<double> agree_clocks(sim::RecordedLog& log) {
  const std::optional<double> ahead_s = found_clock_offset(log);
  if (!ahead_s) return std::nullopt;
  for (sim::OdometryPose& next : log.odometry) next.stamp -= duration_from_seconds(*ahead_s);
  std::fprintf(stderr, "jaywalk: the odometry's times are %+.2f s off the scans', as both turn; taken off\n", *ahead_s);
  return ahead_s;
}

sim::RecordedLog load_and_complain(const ReplayOptions& options, const std::string& format) {
  refuse_to_overwrite(options.logs, options.out);
  std::error_code missing;
  if (std::filesystem::equivalent(options.logs[0], options.out, missing))
    throw StartupError(options.out.string() + ": the bag's own folder", "choose another --out");
  sim::RecordedLog recorded = load(options, format);
  std::istringstream complaints(recorded.complaint());
  for (std::string line; std::getline(complaints, line);) std::fprintf(stderr, "jaywalk: %s\n", line.c_str());
  return recorded;
}

void suggest_mount(const Pose2& given, double missing_yaw) {
  const std::string text = formatted(
      "jaywalk: the scans slide aside of where the wheels drive: is the laser mounted turned? Try --laser-mount "
      "%.2f,%.2f,%.2f, and on until this line is gone\n",
      given.x, given.y, wrap_angle(given.heading + missing_yaw));
  std::fputs(text.c_str(), stderr);
}

void tell(Progress& progress, const sim::LogReplay& log, Time now) {
  if (!progress.is_due()) return;
  const double lived_s = to_seconds(now - log.start_time()), whole_s = to_seconds(log.end_time() - log.start_time());
  progress.show(lived_s / whole_s, std::to_string(std::lround(lived_s)) + " s");
}

int replay_log(const ReplayOptions& options, const std::string& format) {
  sim::RecordedLog recorded = load_and_complain(options, format);
  const std::optional<double> found_clock = agree_clocks(recorded);
  const std::optional<double> found_yaw = find_mount(options, recorded);
  sim::LogReplay log(std::move(recorded));
  const ControlSetup setup = setup_for(log, options);
  log.set_goal(setup.goal, setup.goal_tolerance_m);
  RunObserver observer(options.mcap);
  LoopRunner runner(setup, log.hal(), {options.out}, observer);
  const std::unique_ptr<LiveView> view = view_for(options, runner);
  MountCheck mount;
  Progress progress;
  const auto own_time = [&](Time t) { return log.log().own_time(t); };
  const Interruption interruption;
  do {  // a recording of a single scan ends where it begins
    mount.add(runner.step().pose.map_from_robot);
    runner.report(nullptr, own_time);
    show(view.get(), runner);
    tell(progress, log, runner.last().now);
  } while (!log.ended() && !interruption.came());
  progress.make_way();
  if (const auto yaw = mount.missing_yaw(); yaw && setup.wheels)
    suggest_mount(setup.model.laser.robot_from_laser, *yaw);
  const std::string name = options.logs[0].filename().string();
  const bool whole = log.ended();
  const std::size_t scans = log.log().scans.size();
  const std::string told = formatted(": %zu %s over %.1f s", scans, scans == 1 ? "scan" : "scans",
                                     to_seconds(log.end_time() - log.start_time()));
  conclude(options, runner,
           {.outcome = whole ? "replayed" : "interrupted",
            .success = whole,
            .found_mount_yaw_rad = found_yaw,
            .found_clock_offset_s = found_clock,
            .scenario = name},
           name + told);
  if (view) view->stay(true, interruption);
  return whole ? 0 : interruption.exit_code();
}

/// What only goes with a log: a recording has its own.
void warn_of_options_of_logs(const ReplayOptions& options) {
  const char* const given = options.goal             ? "--goal"
                            : options.laser_mount    ? "--laser-mount"
                            : !options.model.empty() ? "--model"
                                                     : nullptr;
  if (given == nullptr) return;
  std::fprintf(stderr, "jaywalk: %s is left out of account: %s is a recording and has its own\n", given,
               options.logs[0].c_str());
}

bool same_bits(double a, double b) { return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b); }

/// Replays our own recording and compares every command. `part`: where in the file it stands.
int replay_recording(const ReplayOptions& options, FilePart part) {
  const std::string file = options.logs[0].string();
  if (options.logs.size() > 1)
    throw StartupError(options.logs[1].string() + ": one file too many", "a recording holds everything in one file");
  warn_of_options_of_logs(options);
  RecordedRun run(options.logs[0], part);
  if (run.lies_in(options.out))  // the tables of the run that is replayed know more than a replay can
    throw StartupError("--out " + options.out.string() + ": the recording's own folder, whose run would be overwritten",
                       "choose another --out");
  ControlSetup setup = run.setup();
  if (setup.backend == Backend::kCuda) setup.backend = Backend::kAuto;  // the bits are the same wherever it is replayed
  const TickRecord& recorded = run.last();
  RecordedHal devices(recorded);
  RunObserver observer(options.mcap);
  LoopRunner runner(setup, devices.hal(setup.model.lasers().size()), {.folder = options.out, .records = false},
                    observer, [&](const ControlSetup& wanted) {
                      ChosenPlanner chosen = make_planner(wanted);
                      chosen.planner = std::make_unique<HeldPlanner>(std::move(chosen.planner), recorded);
                      return chosen;
                    });
  const std::unique_ptr<LiveView> view = view_for(options, runner);
  Progress progress;
  std::uint64_t ticks = 0, lost = 0, different = 0;
  const Interruption interruption;
  bool whole = false;
  while (!interruption.came() && !(whole = !run.step())) {
    ++ticks;
    lost += run.lost_before();
    runner.step_at(recorded.now);
    runner.report(nullptr);
    show(view.get(), runner);
    const WheelCommand& now = devices.commanded();
    const bool same = same_bits(now.left_radps, recorded.command.left_radps) &&
                      same_bits(now.right_radps, recorded.command.right_radps);
    if (progress.is_due()) progress.show(run.share_read(), std::to_string(ticks) + " ticks");
    if (!same && different++ == 0 && !run.begins_anew()) {
      progress.make_way();
      std::fprintf(stderr, "jaywalk: %s: at %.3f s the command was %.17g %.17g rad/s and is now %.17g %.17g\n",
                   file.c_str(), to_seconds(recorded.now), recorded.command.left_radps, recorded.command.right_radps,
                   now.left_radps, now.right_radps);
    }
  }
  progress.make_way();
  std::fputs(run.remarks(0, "").c_str(), stderr);
  const bool same = different == 0 || run.begins_anew(), success = same && whole;
  conclude(options, runner,
           {.outcome = whole ? "replayed" : "interrupted",
            .success = success,
            .scenario = options.logs[0].filename().string(),
            .title = "replay of " + file},
           file + ": " + std::to_string(ticks) + " ticks, " + std::to_string(different) + " commands differ, " +
               std::to_string(lost) + " ticks missing");
  if (view) view->stay(true, interruption);
  return whole ? (same ? 0 : 1) : interruption.exit_code();
}

int run_replay(ReplayOptions options) {
  for (std::filesystem::path& log : options.logs) {
    if (std::filesystem::exists(log / "recording.jwr")) log /= "recording.jwr";  // a run's folder
    if (!std::filesystem::is_directory(log)) require_readable(log, log.string() + ": ", "give a recording");
  }
  const std::string format = format_of(options);
  if (format == "jaywalk") return replay_recording(options, {});
  const bool picks_topics = !options.scan_topic.empty() || !options.odom_topic.empty();
  if (format == "bag" && !picks_topics) {
    const FilePart own = exchange::find_attachment(options.logs[0], "recording.jwr");
    if (own.bytes > 0) return replay_recording(options, own);
  }
  return replay_log(options, format);
}

/// `folder`: a run's, or a recording.jwr; `wanted`: the file to write; empty: run.mcap in the run's folder.
void run_export(const std::filesystem::path& folder, const std::filesystem::path& wanted) {
  RecordedRun run(folder);
  const std::filesystem::path place = run.is_in_parts() ? run.file() : run.file().parent_path();
  const std::filesystem::path out = wanted.empty() ? place / "run.mcap" : wanted;
  std::error_code missing;
  if (std::filesystem::equivalent(run.file(), out, missing))
    throw StartupError(run.file().string() + ": would be overwritten", "choose another --out");
  RunExporter exporter(out, run.setup());
  SeenRun again(run);
  Progress progress;
  while (again.step()) {
    exporter.add(again.last(), again.tracker());
    if (progress.is_due()) progress.show(run.share_read(), std::to_string(exporter.file().messages()) + " messages");
  }
  progress.make_way();
  std::fputs(again.remarks().c_str(), stderr);
  exporter.finish(run.is_in_parts() ? std::filesystem::path() : run.file());
  std::printf("%s: %llu messages on %zu topics over %.1f s\n", out.c_str(),
              static_cast<unsigned long long>(exporter.file().messages()), exporter.file().topics().size(),
              static_cast<double>(exporter.file().last_ns() - exporter.file().first_ns()) * 1e-9);
}

}  // namespace

void add_replay(CLI::App& app, int& exit_code) {
  static ReplayOptions options;
  CLI::App* replay = app.add_subcommand("replay", "Run recorded laser and odometry through the pipeline");
  replay
      ->add_option("log", options.logs,
                   "SCAN.txt [ODOM.txt], a CARMEN log, a bag (.mcap, a ROS 2 bag's folder or .db3, a ROS 1 .bag), or "
                   "recording.jwr; .gz is read as it is")
      ->required();
  replay->add_option("--format", options.format, "scan-odom, carmen, bag or jaywalk (default: told from the file)")
      ->check(CLI::IsMember({"scan-odom", "carmen", "bag", "jaywalk"}));
  replay->add_option("--scan-topic", options.scan_topic, "A bag's scans (default: the only LaserScan topic)");
  replay->add_option("--odom-topic", options.odom_topic, "A bag's odometry (default: the only Odometry topic)");
  add_place(*replay, "--goal", options.goal, "Goal X,Y in the recording's frame (default: its last pose)");
  add_place(*replay, "--laser-mount", options.laser_mount, "X,Y,YAW of the laser on the robot (m, m, rad)");
  replay->add_option(
      "--model", options.model,
      "Whose body it is: p3dx, wheelchair, or a robot model file (default: p3dx); its laser's mount too");
  options.out = "out/replay";
  add_loop_options(*replay, options);
  replay->callback([&exit_code] { exit_code = run_replay(options); });
}

void add_export(CLI::App& app, int& /*exit_code*/) {
  static std::filesystem::path run, out;
  CLI::App* command = app.add_subcommand("export", "A run's recording as MCAP, for Foxglove and ros2 bag");
  command->add_option("run", run, "A run's folder, or its recording.jwr")->required();
  command->add_option("--out", out, "File to write (default: run.mcap in the run's folder)");
  command->callback([] { run_export(run, out); });
}

}  // namespace jaywalk
