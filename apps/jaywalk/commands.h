#pragma once
// The commands of `jaywalk` with their options, a function each.
#include <CLI/CLI.hpp>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "apps/campaign/campaign_folder.h"
#include "apps/view/view_server.h"
#include "firmware/control_setup.h"
#include "firmware/recording/run_folders.h"
#include "hal/types/geometry.h"

namespace jaywalk {

/// `jaywalk calibrate ROBOT.toml|RUN`: from a guided drive or a recording, the keys that put wheels and mount right.
void add_calibrate(CLI::App& app, int& exit_code);

struct CampaignOptions {
  std::filesystem::path file;
  std::filesystem::path out = "out/campaign";
  int jobs = 0;  ///< runs at a time; 0: as many as this process may use processors
  campaign::Shard shard;
};

/// "2/4": the second of four. Throws StartupError for what is none.
[[nodiscard]] campaign::Shard shard_from(const std::string& word);

/// Runs what of the campaign's share is not finished. Returns the process's exit code: 0 when all of it is finished,
/// whatever came of the runs; 1 when it was stopped, or runs of it crashed or were refused. Throws StartupError for bad
/// input.
[[nodiscard]] int run_campaign(const CampaignOptions& options);

/// `jaywalk commission ROBOT.toml`: turns each wheel a little and checks motors, encoders, sides, counts and the
/// scanner against what the scans show; prints a line a check and leaves ROBOT.commissioned.json. Returns 0 where all
/// is well, else 1. Throws StartupError where it may not begin: nothing is written then; or had to be broken off: then
/// what was found before is withdrawn.
void add_commission(CLI::App& app, int& exit_code);

/// Adds `jaywalk config`: what may stand in the settings files, from the tables that their parsers use.
void add_config(CLI::App& app, int& exit_code);

struct ExportOptions {
  std::filesystem::path run;  ///< a run's folder, or a recording.jwr
  std::filesystem::path out;  ///< empty: run.mcap in the run's folder
};

/// A run's recording as MCAP, profile ros2, and a metadata.yaml beside it. The controller lives through the recording
/// again, since tracks, plans and map are not in it. Returns 0. Throws StartupError for bad input.
[[nodiscard]] int run_export(const ExportOptions& options);

struct FaultsOptions {
  std::filesystem::path out = "out/faults";
  double rate_hz = 50.0;  ///< of the control loop
};

/// The fault matrix on the simulated robot: prints it, and leaves faults.csv in the folder (docs/reference/outputs.md).
/// Returns 0 where every row is ok, else 1. Throws StartupError.
[[nodiscard]] int run_faults(const FaultsOptions& options);

struct FieldOptions {
  std::filesystem::path map;     ///< .yaml (map_server), .map (ARIA), .txt (cylinders), .png or .pgm
  std::optional<Vec2> goal;      ///< in the map; default: the free cell nearest its middle
  double inflation_m = 0.3;      ///< walls grow by this
  std::optional<double> cell_m;  ///< of a picture without a YAML file, or of what has no cells (default there: 0.1 m)
  Backend backend = Backend::kAuto;
  int device = 0;           ///< CUDA's number
  bool start_only = false;  ///< the start field alone: shortest ways, no potential solved
  std::filesystem::path out = "out/field";
};

/// The potential of a map alone, as field.npy and field.json. Returns 0 when it is certified, 1 when not. Throws
/// StartupError for bad input.
[[nodiscard]] int run_field(const FieldOptions& options);

struct ReplayOptions {
  std::vector<std::filesystem::path> logs;
  std::string format;                  ///< scan-odom, carmen, bag or jaywalk; empty: by what the file begins with
  std::string scan_topic, odom_topic;  ///< of a bag; empty: the only one of its type
  std::optional<Vec2> goal;            ///< default: the recording's last pose
  std::optional<Pose2> laser_mount;    ///< robot_from_laser; default: the log's own word, else the robot's origin
  std::string model;  ///< p3dx, wheelchair, or a robot model file; empty: p3dx, its laser at the origin
  std::filesystem::path out = "out/replay";
  bool save_map = false;                  ///< what the robot saw, as map_server files
  bool mcap = false;                      ///< leave run.mcap as well
  bool json = false;                      ///< print the summary, in place of a line
  std::optional<view::ViewAddress> view;  ///< serve the live page here, until an interruption
};

/// Recorded laser and odometry through the whole pipeline except the wheels. For a recording of our own every command
/// is compared, bit for bit. Returns 0, or 1 when such a command differs. Throws StartupError for bad input.
[[nodiscard]] int run_replay(ReplayOptions options);

struct ReportOptions {
  std::vector<std::filesystem::path> folders;
  std::filesystem::path out;  ///< of a campaign's report; empty: "report" in the first folder
};

/// Tells a single run in words, or writes the report of a campaign. Returns the process's exit code: 1 where runs of
/// the campaign are missing, else 0. Throws StartupError for bad input.
[[nodiscard]] int run_report(const ReportOptions& options);

/// `jaywalk setup`: writes a ROBOT.toml from what is found and what a person knows, then looks at it as `check` does.
void add_setup(CLI::App& app, int& exit_code);

/// A field an option of the command line: more than a struct has elsewhere.
struct SimOptions {
  std::filesystem::path scenario;
  std::vector<std::string> settings = {};  ///< KEY=VALUE each, in place of the scenario's own
  std::optional<std::uint64_t> seed;       ///< default: the scenario's
  PlanMode mode = PlanMode::kFull;
  bool constant_speed = false;
  std::string rival;  ///< ControlSetup's
  Backend backend = Backend::kAuto;
  int device = 0;  ///< CUDA's number
  std::filesystem::path out = "out/sim";
  PartsKept parts = {};   ///< of recording and tables
  bool save_map = false;  ///< what the robot saw, as map_server files
  bool realtime = false;
  bool mcap = false;                           ///< leave run.mcap as well
  bool json = false;                           ///< print the summary, in place of a line
  std::optional<view::ViewAddress> view = {};  ///< serve the live page there
  bool until_arrived = false;                  ///< with it too: ends at the first arrival
};

/// The whole controller on the simulated robot; the scenario may be the name of one that comes with the program.
/// Returns the process's exit code: 0 when the robot reached the goal, touched nothing and made no mover turn (the
/// strict rule), 1 when not. Throws StartupError for bad input.
[[nodiscard]] int run_sim(SimOptions options);

/// --man, --markdown and --completion: printed from what --help prints from, so that they cannot differ.
void add_manual_options(CLI::App& app);

/// The manual page of the program and all its commands, for man(1).
[[nodiscard]] std::string man_page(const CLI::App& app);

/// The reference page of the command line. An option that several commands have stands in it once.
[[nodiscard]] std::string markdown_page(const CLI::App& app);

[[nodiscard]] inline std::vector<const CLI::App*> commands_of(const CLI::App& app) {
  return app.get_subcommands([](const CLI::App*) { return true; });
}

/// What bash, zsh or fish offer to complete: commands, options, and the words of options that take one of a few. Made
/// from what --help prints from. Throws StartupError for another shell.
[[nodiscard]] std::string completion_for(const CLI::App& app, const std::string& shell);

}  // namespace jaywalk
