// jaywalk_relive: a recording seen again by this build's localizer and tracker alone: no plan, no command, twenty times
// as quick. bench/tracking/recordings.py uses it.
#include <CLI/CLI.hpp>
#include <cctype>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "apps/formats/logs/log_checks.h"
#include "apps/formats/logs/log_replay.h"
#include "apps/report/run_report.h"
#include "bench/command_line.h"
#include "bench/tracking/run_folder.h"
#include "firmware/estimator.h"
#include "firmware/recording/recorder.h"
#include "hal/types/errors.h"

namespace jaywalk::bench {
namespace {
struct ReliveOptions {
  std::string recording;                ///< recording.jwr, or scans as `jaywalk replay` takes them
  std::optional<std::string> odometry;  ///< beside scans
  Pose2 robot_from_laser{};             ///< of scans; a recording.jwr has its own
  std::filesystem::path out;            ///< gets robot.csv, tracks.csv and, of a simulation, movers.csv
};

constexpr Duration kTick = std::chrono::milliseconds(20);

/// Sees what the devices said, as ControlLoop::tick() does, and writes down what comes of it.
class Watcher {
 public:
  Watcher(const ControlSetup& setup, const std::filesystem::path& out, const RunFolder* truth)
      : estimator_(setup), tables_(out), truth_(truth) {}

  void see(TickRecord& tick) {
    (void)estimator_.update(tick);
    estimator_.forget_where_stuck(tick);
    estimator_.end_tick(tick);
    tick.pose = estimator_.pose();
    TrueState state;
    if (truth_ != nullptr) state.map_from_robot = *truth_->truth_at(to_seconds(tick.now));
    tables_.add(
        {.record = tick, .tracks = estimator_.tracker().tracks(), .truth = truth_ != nullptr ? &state : nullptr});
  }
  void close() { tables_.close(); }

 private:
  Estimator estimator_;
  RunTables tables_;
  const RunFolder* truth_;
};

void relive_simulation(const ReliveOptions& options) {
  const std::filesystem::path folder = std::filesystem::path(options.recording).parent_path();
  const RunFolder truth(folder);
  RecordingReader reader(options.recording);
  Watcher watcher(setup_from_text(reader.setup(), options.recording), options.out, &truth);
  TickRecord tick;
  while (reader.next(tick)) watcher.see(tick);
  watcher.close();
  std::filesystem::remove(options.out / "movers.csv");  // a header alone
  for (const char* const file : {"movers.csv", "recording.jwr"})
    std::filesystem::create_symlink(std::filesystem::absolute(folder / file), options.out / file);
}

/// CARMEN's lines begin with a message's name, those of others with a number.
sim::RecordedLog load(const ReliveOptions& options) {
  sim::LineFile lines(options.recording);
  const bool carmen = lines.next() && std::isalpha(static_cast<unsigned char>(lines.words()[0][0])) != 0;
  if (carmen) return sim::load_carmen(options.recording, options.robot_from_laser);
  return sim::load_scan_odom(options.recording, options.odometry, options.robot_from_laser);
}

void relive_log(const ReliveOptions& options) {
  sim::LogReplay log(load(options));
  ControlSetup setup;
  setup.model = p3dx();
  setup.model.laser = log.log().laser();
  setup.model.drive = log.drive();
  setup.start = log.start_pose();
  setup.goal = log.last_pose().value_or(setup.start).position();
  Watcher watcher(setup, options.out, nullptr);
  Hal hal = log.hal();
  TickRecord tick;
  for (Time next = hal.clock.now() + kTick; !log.ended(); next += kTick) {
    tick.now = hal.clock.now();
    tick.scan = hal.laser.latest();
    tick.wheels = hal.drive.latest();
    watcher.see(tick);
    hal.clock.sleep_until(next);
  }
  watcher.close();
}

/// Ticks 50 times a second, as the control loop does. The folder of a simulation's recording says where its robot and
/// movers really were. Throws StartupError.
void relive(const ReliveOptions& options) {
  std::filesystem::create_directories(options.out);
  if (std::filesystem::equivalent(options.out, std::filesystem::absolute(options.recording).parent_path())) {
    throw StartupError("--out " + options.out.string() + ": the recording's own folder", "choose another --out");
  }
  for (const char* const file : {"movers.csv", "recording.jwr"}) std::filesystem::remove(options.out / file);  // links
  is_recording(options.recording) ? relive_simulation(options) : relive_log(options);
}

}  // namespace
}  // namespace jaywalk::bench

int main(int argc, char** argv) {
  jaywalk::bench::ReliveOptions options;
  std::vector<double> mount{0.0, 0.0, 0.0};
  CLI::App app("Lives through a recording with localizer and tracker alone", "jaywalk_relive");
  app.add_option("RECORDING", options.recording, "recording.jwr of a simulation, or SCAN.txt")
      ->required()
      ->check(CLI::ExistingFile);
  app.add_option("ODOMETRY", options.odometry, "beside SCAN.txt")->check(CLI::ExistingFile);
  app.add_option("--out", options.out, "folder for robot.csv and tracks.csv")->required();
  app.add_option("--laser-mount", mount, "X,Y,YAW: m and rad, in the robot's frame")->delimiter(',')->expected(3);
  return jaywalk::bench::run(app, argc, argv, [&] {
    options.robot_from_laser = {mount[0], mount[1], mount[2]};
    jaywalk::bench::relive(options);
  });
}
