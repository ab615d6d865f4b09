#include <CLI/CLI.hpp>
#include <array>
#include <charconv>
#include <cstdio>

#include "apps/bench/bench.h"
#include "apps/jaywalk/commands.h"
#include "apps/view/run_view.h"
#include "apps/why/why.h"
#include "firmware/backends.h"
#include "firmware/program/program.h"
#include "hal/robot_model_file.h"
#include "hal/setting_keys.h"
#include "hal/shown_text.h"
#include "hal/types/errors.h"

namespace {

using namespace jaywalk;

constexpr std::array<Footer, 13> kFooters{{
    {"sim", "sim crossing --seed 2 --view", "the goal was reached, nobody touched or made to turn", "it was not"},
    {"replay", "replay scans.txt odometry.txt --laser-mount 0.1,0,0", "replayed",
     "a recording's commands come out otherwise"},
    {"field", "field hal/sim/maps/map1.yaml --goal 24,24", "the field is certified", "it is not"},
    {"export", "export out/sim", "exported", "-"},
    {"why", "why out/sim 12.5", "told", "-"},
    {"campaign", "campaign deploy/campaigns/first.toml --out out/first", "all runs are finished",
     "it was stopped, or runs crashed or were refused"},
    {"report", "report out/sim", "told", "runs of the campaign are missing"},
    {"bench", "bench --largest 256 --json rows.json", "measured", "-"},
    {"faults", "faults --out out/faults", "every row is ok", "one is not"},
    {"commission", "commission deploy/config/wheelchair.toml", "wired as the file says", "not so"},
    {"calibrate", "calibrate out/sim", "calibrated", "the drive tells too little"},
    {"setup", "setup --answers answers.toml --out robot.toml", "written, and check finds all well",
     "written, and something is not well"},
    {"config", "config --explain laser.rate_hz", "explained", "-"},
}};

std::uint16_t port_of(const std::string& word) {
  std::uint16_t port = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), port);
  if (error == std::errc() && end == word.data() + word.size()) return port;
  throw StartupError("--view: " + shown(word) + " is no port",
                     "give a whole number from 0 to 65535 (0: any that is free)");
}

/// --view [PORT], --view-address, --view-certificate and --view-origin. Parsing throws StartupError for what is no
/// port.
void add_view(CLI::App& command, std::optional<view::ViewAddress>& chosen) {
  const auto here = [&chosen]() -> view::ViewAddress& { return chosen ? *chosen : chosen.emplace(); };
  command
      .add_option_function<std::string>(
          "--view", [here](const std::string& word) { here().port = word.empty() ? std::uint16_t{0} : port_of(word); },
          "Serve the live page; its address is printed (default port: any that is free)")
      ->expected(0, 1)
      ->type_name("PORT");
  command
      .add_option_function<std::string>(
          "--view-address", [here](const std::string& word) { here().address = word; },
          "Serve it on this IPv4 address, by TLS and with a token (default: 127.0.0.1, this machine alone)")
      ->type_name("ADDRESS");
  command
      .add_option_function<std::string>(
          "--view-certificate", [here](const std::string& word) { here().certificate = word; },
          "Certificate and key for TLS, in PEM (default: self-signed)")
      ->type_name("FILE");
  command
      .add_option_function<std::string>(
          "--view-origin", [here](const std::string& word) { here().origin = word; },
          "Pages of this site may look and steer too, such as a Foxglove that is served from there")
      ->type_name("https://SITE");
}

std::optional<view::ViewAddress> run_page;
SimOptions sim_options;
ReplayOptions replay_options;
FieldOptions field_options;
BenchOptions bench_options;
FaultsOptions faults_options;
ExportOptions export_options;
WhyOptions why_options;
ReportOptions report_options;
CampaignOptions campaign_options;

/// The parser's own numbers stop at the greatest without a word.
std::uint64_t seed_of(const std::string& word) {
  std::uint64_t seed = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), seed);
  if (error == std::errc() && end == word.data() + word.size()) return seed;
  throw StartupError("--seed: " + shown(word) + " is no seed", "give a whole number from 0 to 18446744073709551615");
}

void add_sim(CLI::App& app, int& exit_code) {
  CLI::App* sim = app.add_subcommand("sim", "Run the whole controller on a simulated robot");
  sim->add_option("scenario", sim_options.scenario, "Scenario file (docs/reference/scenarios.md) or shipped name")
      ->required();
  sim->add_option_function<std::string>(
         "--seed", [](const std::string& word) { sim_options.seed = seed_of(word); },
         "Seed of everything random, 0 or more (default: the scenario's)")
      ->type_name("N");
  sim->add_option("--set", sim_options.settings, "A setting in place of the scenario's own: movers.count=16")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
  add_choice<PlanMode>(*sim, "--mode", sim_options.mode, {{"full", PlanMode::kFull}, {"paper", PlanMode::kPaper}},
                       "full: laser only, stops for people; paper: movers given, never stops");
  sim->add_flag("--constant-speed", sim_options.constant_speed,
                "One speed from start to goal, never stopping for a plan");
  add_choice<std::string>(*sim, "--planner", sim_options.rival,
                          {{"ours", ""}, {"none", "none"}, {"replan", "replan"}, {"dwa", "dwa"}, {"orca", "orca"}},
                          "Who decides on motion: ours, or a planner of others to hold it against");
  sim->add_option_function<std::string>(
         "--comfort", [](const std::string& word) { sim_options.settings.push_back("robot.comfort=" + word); },
         "How the ride is to feel, in place of the scenario's own")
      ->check(CLI::IsMember(comfort_names()));
  add_backend(*sim, sim_options.backend, sim_options.device);
  sim->add_option("--out", sim_options.out, "Folder for what the run leaves")->capture_default_str();
  add_parts(*sim, sim_options.parts);
  sim->add_flag("--save-map", sim_options.save_map, "Save what the robot saw: map.yaml and map.pgm (map_server)");
  sim->add_flag("--realtime", sim_options.realtime, "Hold simulated time to the wall clock");
  sim->add_flag("--mcap", sim_options.mcap, "Leave run.mcap as well, as export would");
  sim->add_flag("--json", sim_options.json, "Print the summary, in place of a line");
  add_view(*sim, sim_options.view);
  sim->add_flag("--until-arrived", sim_options.until_arrived, "End at the first arrival, watched or not");
  sim->callback([&exit_code] { exit_code = run_sim(sim_options); });
}

/// `value` when it can be a place (m) or an angle; NaN cannot.
double sound(const char* option, double value) {
  constexpr double kFarthest = 1e6;
  if (value >= -kFarthest && value <= kFarthest) return value;
  char text[32];
  std::snprintf(text, sizeof text, "%g", value);
  throw StartupError(std::string(option) + ": " + text + " is no place", "give metres and radians");
}

void add_replay(CLI::App& app, int& exit_code) {
  CLI::App* replay = app.add_subcommand("replay", "Run recorded laser and odometry through the pipeline");
  replay
      ->add_option("log", replay_options.logs,
                   "SCAN.txt [ODOM.txt], a CARMEN log, a bag (.mcap, a ROS 2 bag's folder or .db3, a ROS 1 .bag), or "
                   "recording.jwr; .gz is read as it is")
      ->required();
  replay
      ->add_option("--format", replay_options.format, "scan-odom, carmen, bag or jaywalk (default: told from the file)")
      ->check(CLI::IsMember({"scan-odom", "carmen", "bag", "jaywalk"}));
  replay->add_option("--scan-topic", replay_options.scan_topic, "A bag's scans (default: the only LaserScan topic)");
  replay->add_option("--odom-topic", replay_options.odom_topic, "A bag's odometry (default: the only Odometry topic)");
  replay
      ->add_option_function<std::vector<double>>(
          "--goal",
          [](const std::vector<double>& v) {
            replay_options.goal = Vec2{sound("--goal", v[0]), sound("--goal", v[1])};
          },
          "Goal X,Y in the recording's frame (default: its last pose)")
      ->delimiter(',')
      ->expected(2);
  replay
      ->add_option_function<std::vector<double>>(
          "--laser-mount",
          [](const std::vector<double>& v) {
            const auto part = [&](std::size_t k) { return sound("--laser-mount", v[k]); };
            replay_options.laser_mount = Pose2{part(0), part(1), wrap_angle(part(2))};
          },
          "X,Y,YAW of the laser on the robot (m, m, rad)")
      ->delimiter(',')
      ->expected(3);
  replay->add_option(
      "--model", replay_options.model,
      "Whose body it is: p3dx, wheelchair, or a robot model file (default: p3dx); its laser's mount too");
  replay->add_flag("--save-map", replay_options.save_map, "Save what the robot saw: map.yaml and map.pgm (map_server)");
  replay->add_option("--out", replay_options.out, "Folder for what the run leaves")->capture_default_str();
  replay->add_flag("--mcap", replay_options.mcap, "Leave run.mcap as well, as export would");
  replay->add_flag("--json", replay_options.json, "Print the summary, in place of a line");
  add_view(*replay, replay_options.view);
  replay->callback([&exit_code] { exit_code = run_replay(replay_options); });
}

void add_field(CLI::App& app, int& exit_code) {
  CLI::App* field = app.add_subcommand("field", "The potential field of a map alone");
  field->add_option("map", field_options.map, "map_server YAML, ARIA .map, cylinders .txt, or a picture")->required();
  field
      ->add_option_function<std::vector<double>>(
          "--goal",
          [](const std::vector<double>& v) {
            field_options.goal = Vec2{sound("--goal", v[0]), sound("--goal", v[1])};
          },
          "Goal X,Y in the map (default: the free cell nearest its middle)")
      ->delimiter(',')
      ->expected(2);
  field->add_option("--inflation,--inflation_m", field_options.inflation_m, "Walls grow by this (m)")
      ->capture_default_str();
  field->add_option("--resolution", field_options.cell_m, "Metres a cell: of a picture, of lines or cylinders");
  add_backend(*field, field_options.backend, field_options.device);
  field->add_flag("--start-field", field_options.start_only,
                  "The start field alone: shortest ways, no potential solved");
  field->add_option("--out", field_options.out, "Folder for field.npy and field.json")->capture_default_str();
  field->callback([&exit_code] { exit_code = run_field(field_options); });
}

void add_bench(CLI::App& app, int& exit_code) {
  CLI::App* bench = app.add_subcommand("bench", "Measure solver and planner against what a user would pick instead");
  bench->add_option("--json", bench_options.json, "File for the rows");
  bench->add_option("--map", bench_options.map, "One more map (.map or .txt), scaled to each size");
  bench->add_option("--largest", bench_options.largest, "Largest map, cells a side")
      ->check(CLI::IsMember({256, 512, 1024, 2048}))
      ->capture_default_str();
  bench->callback([&exit_code] { exit_code = run_bench(bench_options); });
}

void add_faults(CLI::App& app, int& exit_code) {
  CLI::App* faults =
      app.add_subcommand("faults", "The fault matrix: every fault, drive and speed on the simulated robot");
  faults->add_option("--out", faults_options.out, "Folder for faults.csv")->capture_default_str();
  faults->add_option("--rate-hz", faults_options.rate_hz, "Rate of the control loop")
      ->check(CLI::Range(25.0, 200.0))
      ->capture_default_str();
  faults->callback([&exit_code] { exit_code = run_faults(faults_options); });
}

void add_export(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand("export", "A run's recording as MCAP, for Foxglove and ros2 bag");
  command->add_option("run", export_options.run, "A run's folder, or its recording.jwr")->required();
  command->add_option("--out", export_options.out, "File to write (default: run.mcap in the run's folder)");
  command->callback([&exit_code] { exit_code = run_export(export_options); });
}

void add_why(CLI::App& app, int& exit_code) {
  CLI::App* why = app.add_subcommand("why", "One moment of a recording: what it saw, wanted, was permitted, and why");
  why->add_option("run", why_options.run, "A run's folder, or its recording.jwr")->required();
  why->add_option("t_s", why_options.at_s, "When, in seconds of the recording's clock")->required();
  why->add_option("--out", why_options.out, "Folder for why.png")->capture_default_str();
  why->callback([&exit_code] { exit_code = run_why(why_options); });
}

void add_report(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand("report", "A run in plain words, or a campaign's tables, charts and failures");
  command->add_option("folders", report_options.folders, "A run's folder, or those of a campaign's shards")->required();
  command->add_option("--out", report_options.out, "Folder of a campaign's report (default: report in the first)");
  command->callback([&exit_code] { exit_code = run_report(report_options); });
}

void add_campaign(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand("campaign", "Many simulated runs, as one experiment that can be interrupted");
  command->add_option("campaign", campaign_options.file, "Campaign file (TOML; docs/how-to/campaigns.md)")->required();
  command->add_option("--jobs", campaign_options.jobs, "Runs at a time (default: all processors)")
      ->check(CLI::Range(1, 4096));
  command
      ->add_option_function<std::string>(
          "--shard", [](const std::string& word) { campaign_options.shard = shard_from(word); },
          "The I-th of N shares of the runs alone")
      ->type_name("I/N");
  command->add_option("--out", campaign_options.out, "Folder for the runs; shares may have one in common")
      ->capture_default_str();
  command->callback([&exit_code] { exit_code = run_campaign(campaign_options); });
}

/// Tables and pictures, and the live page where it was asked for.
std::unique_ptr<TickObserver> observe_run(const RunOptions& options, const RobotFile& file,
                                          const std::filesystem::path& control_socket) {
  if (!run_page) return std::make_unique<RunObserver>();
  return std::make_unique<RunView>(*run_page, control_socket, options.robot.filename().string(), file.setup,
                                   map_for(file.setup));
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"jaywalk: plans for where things will be. Not certified; a navigation laser is not a safety scanner.",
               "jaywalk"};
  const MakeObserver observe = observe_run;
  return run_program(app, argc, argv, [&](CLI::App& to, int& exit_code) {
    for (const auto add :
         {add_sim, add_replay, add_field, add_bench, add_faults, add_export, add_why, add_campaign, add_report})
      add(to, exit_code);
    add_robot_commands(to, exit_code, observe);
    add_view(*to.get_subcommand("run"), run_page);
    for (const auto add : {add_commission, add_calibrate, add_setup, add_config}) add(to, exit_code);
    add_footers(to, kFooters);
    add_manual_options(to);
  });
}
