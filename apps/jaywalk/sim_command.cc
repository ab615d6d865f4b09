#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <memory>
#include <thread>

#include "apps/jaywalk/commands.h"
#include "apps/jaywalk/progress.h"
#include "apps/report/run_observer.h"
#include "apps/rivals/paper_mode.h"
#include "apps/view/live_view.h"
#include "firmware/control_loop.h"
#include "firmware/program/program.h"
#include "firmware/recording/map_files.h"
#include "firmware/safety/stop_zone.h"
#include "hal/robot_model_file.h"
#include "hal/setting_keys.h"
#include "hal/shown_text.h"
#include "hal/sim/simulation.h"
#include "hal/types/errors.h"
#include "hal/types/wheels.h"

namespace jaywalk {
namespace {

struct SimOptions : LoopOptions {
  std::filesystem::path scenario;
  std::vector<std::string> settings = {};  ///< KEY=VALUE each, in place of the scenario's own
  std::optional<std::uint64_t> seed;       ///< default: the scenario's
  PlanMode mode = PlanMode::kFull;
  bool constant_speed = false;
  std::string rival;  ///< ControlSetup's
  Backend backend = Backend::kAuto;
  int device = 0;        ///< CUDA's number
  PartsKept parts = {};  ///< of recording and tables
  bool realtime = false;
  bool until_arrived = false;  ///< with the page too: ends at the first arrival
  bool endless = false;        ///< goes on until it is interrupted, and its page may change the world
};

/// PREFIX/bin/jaywalk has PREFIX/share/jaywalk/scenarios; a build lies in its sources, or a folder or two below.
std::filesystem::path shipped_folder() {
  std::error_code failed;
  std::filesystem::path above = std::filesystem::read_symlink("/proc/self/exe", failed).parent_path();
  for (int depth = 0; depth < 4 && above.has_relative_path(); ++depth, above = above.parent_path()) {
    for (const char* const place : {"share/jaywalk/scenarios", "hal/sim/scenarios"})
      if (std::filesystem::is_directory(above / place, failed)) return above / place;
  }
  return {};
}

std::vector<std::string> names_in(const std::filesystem::path& folder) {
  std::vector<std::string> names;
  std::error_code failed;
  for (const auto& entry : std::filesystem::directory_iterator(folder, failed))
    if (entry.path().extension() == ".toml") names.push_back(entry.path().stem().string());
  std::sort(names.begin(), names.end());
  return names;
}

/// `given` itself where there is such a file, or it has a folder; else the scenario of that name that comes with the
/// program. Throws StartupError for a name that is none of theirs, with the nearest.
std::filesystem::path scenario_named(const std::filesystem::path& given) {
  if (std::filesystem::exists(given) || given.has_parent_path()) return given;
  const std::filesystem::path folder = shipped_folder();
  const std::string name = given.extension() == ".toml" ? given.stem().string() : given.string();
  if (std::filesystem::exists(folder / (name + ".toml"))) return folder / (name + ".toml");
  const std::vector<std::string> names = names_in(folder);
  if (given.extension() == ".toml" || names.empty()) return given;
  throw StartupError(name + ": no such file, and no scenario of that name",
                     did_you_mean(name, names, "give a file, or one of " + joined(names)));
}

/// The simulator's truth in the report's words; `movers` holds those that it refers to.
TrueState state_for_report(const sim::Truth& truth, std::vector<TrueMover>& movers) {
  movers.clear();
  for (const sim::MoverTruth& m : truth.movers) movers.push_back({m.id, m.position, m.velocity, m.radius_m, m.forced});
  return {.map_from_robot = truth.map_from_robot,
          .twist = truth.twist,
          .movers = movers,
          .clearance_m = truth.clearance_m,
          .mover_clearance_m = truth.mover_clearance_m,
          .contacts = truth.contacts,
          .contacts_caused = truth.contacts_caused,
          .forced_movers = truth.forced_movers,
          .social = truth.social};
}

sim::Scenario scenario_for(const SimOptions& options) {
  sim::Scenario scenario = sim::load_scenario(options.scenario, options.settings);
  const bool never_stops = options.mode == PlanMode::kPaper || options.constant_speed;
  const std::string stopping = "run without --mode paper and --constant-speed", file = options.scenario.string();
  if (never_stops && std::isfinite(scenario.goal_heading_rad))
    throw StartupError(scenario.goal_place + "a robot that never stops cannot turn to a heading at the goal",
                       "leave the third number out, or " + stopping);
  if (never_stops && std::ranges::count(scenario.zones, ZoneKind::kSpeed, &MapZone::kind) > 0)
    throw StartupError(file + ": [[zones]]: a robot that keeps its speed cannot slow down in a zone",
                       "leave the speed zones out, or " + stopping);
  if (never_stops && !options.rival.empty())
    throw StartupError("--planner: the planners of others stop and turn on the spot", stopping);
  if (scenario.stick && (never_stops || !options.rival.empty()))
    throw StartupError(file + ": [stick]: a person who steers is obeyed by no other planner",
                       "run without --mode paper, --constant-speed and --planner");
  if (never_stops && options.endless)
    throw StartupError("--endless: a robot that keeps its speed takes no goals from the page", stopping);
  if (options.mode == PlanMode::kPaper) scenario.pose_source.enabled = true;  // the paper's localisation system
  return scenario;
}

std::vector<std::filesystem::path> files_of(const sim::Scenario& scenario, const std::filesystem::path& file) {
  std::vector<std::filesystem::path> files{file, scenario.map_file};
  for (const sim::RecordedSpec& movers : scenario.recorded) files.push_back(movers.file);
  if (scenario.stick && scenario.stick->kind == sim::StickKind::kTable) files.push_back(scenario.stick->file);
  return files;
}

ControlSetup setup_for(const sim::Scenario& scenario, const SimOptions& options) {
  const double cell_m = ControlSetup{}.planner().cell_m;
  ControlSetup setup{.model = scenario.model,
                     .mode = options.mode,
                     .constant_speed = options.constant_speed,
                     .rival = options.rival,
                     .steering = scenario.stick ? scenario.stick->steering : StickUse::kNone,
                     .backend = options.backend,
                     .given_movers = scenario.pose_source.enabled && scenario.pose_source.gives_movers,
                     .device = options.device,
                     .start = scenario.start,
                     .goal = scenario.goal,
                     .goal_tolerance_m = scenario.goal_tolerance_m,
                     .known_map = scenario.map_is_known ? load_known_map(scenario.map_file, cell_m) : nullptr,
                     .zones = scenario.zones,
                     .comfort_distance_m = profile_of(scenario.comfort).comfort_distance_m};
  equip(setup);
  return setup;
}

std::unique_ptr<SimView> view_for(const SimOptions& options, const ControlSetup& setup, const sim::Scenario& scenario,
                                  sim::Simulation& simulation) {
  if (!options.view) return nullptr;
  auto view = std::make_unique<SimView>(*options.view, setup, simulation.hal().panel);
  view->begin(scenario.name, simulation.walls(), options.endless ? &simulation : nullptr);
  return view;
}

Hal hal_for(sim::Simulation& simulation, SimView* view) {
  const Hal hal = simulation.hal();
  return view == nullptr ? hal : Hal{hal.laser, hal.drive, view->panel(), hal.pose_source, hal.clock, hal.other_lasers};
}

/// A steering person has the goal in mind.
OperatorInput with_goal(const OperatorInput& input) {
  OperatorInput wanted = input;
  wanted.has_goal = input.has_goal || input.steers;
  return wanted;
}

/// Outcome of a run, empty while it goes on; its time to arrive counts from `set_out`. A forced mover does not end the
/// run. A latched stop ends it, since no person resets a simulated robot.
std::string outcome(const sim::Scenario& scenario, const sim::Truth& truth, const TickRecord& t, bool applied,
                    Time set_out) {
  if (truth.contacts > 0) return "collision";
  const bool waits_for_reset = has(t.verdict.reasons, Reason::kLatched) && !t.input.emergency_stop;
  if (applied && waits_for_reset && t.verdict.permitted == Twist2{}) return "fault";
  const OperatorInput wanted = with_goal(t.input);
  if (wanted.has_goal && wanted.is_reached_at(truth.map_from_robot) &&
      (!wanted.wants_heading() || is_at_rest(truth.twist)))
    return truth.forced_movers > 0 ? "forced_mover" : "reached";
  return to_seconds(t.now - set_out) >= scenario.timeout_s ? "timeout" : "";
}

bool has_arrived(const std::string& ended) { return ended == "reached" || ended == "forced_mover"; }

/// A run to a goal that no way leads to would only end by its timeout, without a word of why.
void remark_unreachable(const sim::Scenario& scenario, const sim::Simulation& simulation) {
  if (std::isfinite(simulation.static_shortest_path_m())) return;
  std::fprintf(stderr,
               "jaywalk: %sno way leads from start to goal, as wide as the robot is: the run can only time out\n",
               scenario.goal_place.c_str());
}

/// As the crow flies: the bar goes back where the way does.
void tell(Progress& progress, const sim::Scenario& scenario, const sim::Truth& truth) {
  if (!progress.is_due()) return;
  const double whole_m = distance(scenario.start.position(), scenario.goal);
  const double left_m = distance(truth.map_from_robot.position(), scenario.goal);
  const std::string words = formatted("%.0f s, %.1f m to the goal", to_seconds(truth.now), left_m);
  progress.show(1.0 - left_m / whole_m, words);
}

RunEnd end_of(const SimOptions& options, const sim::Scenario& scenario, std::uint64_t seed,
              const sim::Simulation& simulation, const LoopRunner& runner, const std::string& ended) {
  const OperatorInput wanted = with_goal(runner.last().input);
  std::optional<double> heading_error;
  if (wanted.wants_heading()) heading_error = wanted.heading_error_rad(simulation.truth().map_from_robot);
  return {.outcome = ended,
          .success = ended == "reached",
          .static_shortest_path_m = simulation.static_shortest_path_m(),
          .heading_error_rad = heading_error,
          .missed_ticks = options.realtime ? runner.overruns() : 0,
          .seed = seed,
          .scenario = scenario.name,
          .settings = options.settings,
          .planner = options.rival.empty() ? "ours" : options.rival,
          .mover_rule = sim::Simulation::mover_rule(),
          .title = scenario.name + ", seed " + std::to_string(seed) + ": " + ended};
}

int run_sim(SimOptions options) {
  options.scenario = scenario_named(options.scenario);
  const sim::Scenario scenario = scenario_for(options);
  const std::uint64_t seed = options.seed.value_or(scenario.seed);
  sim::Simulation simulation(scenario, seed);
  refuse_to_overwrite(files_of(scenario, options.scenario), options.out);
  remark_unreachable(scenario, simulation);
  const ControlSetup setup = setup_for(scenario, options);
  if (setup.has_long_body() && !options.rival.empty())
    throw StartupError(
        options.scenario.string() + ": --planner: the planners of others are for robots that are nearly round",
        "choose another model");
  if (!setup.keeps_speed()) require_zone_in_reach(setup.model, setup.tick(), options.scenario.string());
  const std::unique_ptr<SimView> view = view_for(options, setup, scenario, simulation);
  RunObserver observer(options.mcap);
  observer.show_walls({simulation.walls().begin(), simulation.walls().end()});
  LoopRunner runner(setup, hal_for(simulation, view.get()), {options.out, options.parts}, observer);
  Progress progress;
  std::vector<TrueMover> movers;
  std::string ended;
  Time set_out{};
  const Interruption interruption;
  const auto began = std::chrono::steady_clock::now();
  while (ended.empty()) {
    const TickRecord& t = runner.step();
    const TrueState state = state_for_report(simulation.truth(), movers);
    runner.report(&state);
    tell(progress, scenario, simulation.truth());
    ended = outcome(scenario, simulation.truth(), t, runner.setup().applies_verdict(), set_out);
    const bool may_go_on = view && !options.until_arrived && !interruption.came() && view->is_watched();
    if (may_go_on && (has_arrived(ended) || !t.input.has_goal)) set_out = t.now;
    if (options.endless || (may_go_on && has_arrived(ended))) ended.clear();
    if (ended.empty() && interruption.came()) ended = "interrupted";
    if (view) view->follow(runner, ended, interruption);
    if (options.realtime && !view) std::this_thread::sleep_until(began + t.now.time_since_epoch());
  }
  progress.make_way();
  const double took_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
  const double lasted_s = to_seconds(simulation.truth().now);
  conclude(options, runner, end_of(options, scenario, seed, simulation, runner, ended),
           scenario.name + ": " + ended +
               formatted(" after %.1f s, %.1f times faster than real time", lasted_s, lasted_s / took_s));
  if (view) view->stay(interruption);
  if (ended == "interrupted") return interruption.exit_code();
  return ended == "reached" ? 0 : 1;
}

/// The parser's own numbers stop at the greatest without a word.
std::uint64_t seed_of(const std::string& word) {
  if (const auto seed = number_in<std::uint64_t>(word)) return *seed;
  throw StartupError("--seed: " + shown(word) + " is no seed", "give a whole number from 0 to 18446744073709551615");
}

}  // namespace

void add_sim(CLI::App& app, int& exit_code) {
  static SimOptions options;
  CLI::App* sim = app.add_subcommand("sim", "Run the whole controller on a simulated robot");
  sim->add_option("scenario", options.scenario, "Scenario file (docs/reference/scenarios.md) or shipped name")
      ->required();
  sim->add_option_function<std::string>(
         "--seed", [](const std::string& word) { options.seed = seed_of(word); },
         "Seed of everything random, 0 or more (default: the scenario's)")
      ->type_name("N");
  sim->add_option("--set", options.settings, "A setting in place of the scenario's own: movers.count=16")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
  add_choice<PlanMode>(*sim, "--mode", options.mode, {{"full", PlanMode::kFull}, {"paper", PlanMode::kPaper}},
                       "full: laser only, stops for people; paper: movers given, never stops");
  sim->add_flag("--constant-speed", options.constant_speed, "One speed from start to goal, never stopping for a plan");
  add_choice<std::string>(*sim, "--planner", options.rival,
                          {{"ours", ""}, {"none", "none"}, {"replan", "replan"}, {"dwa", "dwa"}, {"orca", "orca"}},
                          "Who decides on motion: ours, or a planner of others to hold it against");
  sim->add_option_function<std::string>(
         "--comfort", [](const std::string& word) { options.settings.push_back("robot.comfort=" + word); },
         "How the ride is to feel, in place of the scenario's own")
      ->check(CLI::IsMember(comfort_names()));
  add_backend(*sim, options.backend, options.device);
  add_parts(*sim, options.parts);
  options.out = "out/sim";
  add_loop_options(*sim, options);
  sim->add_flag("--realtime", options.realtime, "Hold simulated time to the wall clock");
  CLI::Option* const until =
      sim->add_flag("--until-arrived", options.until_arrived, "End at the first arrival, watched or not");
  sim->add_flag_callback(
         "--endless", [] { options.endless = true, options.view = options.view.value_or(view::ViewAddress{}); },
         "Play with the world on the live page: goals, faults, walkers, the speed of time; Ctrl-C ends it")
      ->excludes(until);
  sim->callback([&exit_code] { exit_code = run_sim(options); });
}

}  // namespace jaywalk
