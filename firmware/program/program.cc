#include "firmware/program/program.h"

#include <fcntl.h>

#include <array>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>

#include "firmware/backends.h"
#include "firmware/robot/control_socket.h"
#include "firmware/robot/goal_order.h"
#include "hal/setting_keys.h"

namespace jaywalk {
namespace {

constexpr int kBadInput = 2;

/// The first option that `command` does not have, with the one that was meant; empty where all are known.
std::string unknown_option(const std::string& program, const CLI::App& command) {
  std::vector<std::string> known;
  for (const CLI::Option* option : command.get_options())
    for (const std::string& name : option->get_lnames()) known.push_back("--" + name);
  for (const std::string& word : command.remaining()) {
    if (word.rfind('-', 0) != 0) continue;
    const std::string see = "see " + program + " " + command.get_name() + " --help";
    return shown(word) + ": no such option; " + did_you_mean(word.substr(0, word.find('=')), known, see);
  }
  return "";
}

/// One line for a command line that the parser refuses.
std::string parse_message(const CLI::App* app, const CLI::Error& error) {
  const auto given = app->get_subcommands();
  const std::string unknown = given.empty() ? "" : unknown_option(app->get_name(), *given[0]);
  if (!unknown.empty()) return app->get_name() + ": " + unknown + "\n";
  return app->get_name() + ": " + printable(error.what()) + "; see " + app->get_name() + " " +
         (given.empty() ? "" : given[0]->get_name() + " ") + "--help\n";
}

/// The parser would only say that one is missing.
void require_command(const CLI::App& app, int argc, char** argv) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) {
    if (argc > 1 && (argv[1][0] == '-' || command->get_name() == argv[1])) return;
    names.push_back(command->get_name());
  }
  const std::string all = "there are " + joined(names);
  if (argc <= 1) throw StartupError("a subcommand is required", all);
  throw StartupError(shown(argv[1]) + ": no such subcommand", did_you_mean(argv[1], names, all));
}

int parse_and_run(CLI::App& app, int argc, char** argv, const AddCommands& add_commands) {
  int exit_code = 0;
  app.set_version_flag("--version", app.get_name() + " " + JAYWALK_VERSION + ", backends: " + built_backends());
  app.require_subcommand(1);
  app.failure_message(parse_message);
  add_commands(app, exit_code);
  refuse_empty_words(argc, argv);
  require_command(app, argc, argv);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : kBadInput;
  }
  return exit_code;
}

constexpr std::array<Footer, 7> kFooters{{
    {"run", "run deploy/config/wheelchair.toml", "ended without a fault", "a fault stopped it"},
    {"check", "check deploy/config/wheelchair.toml", "all is well", "something is not"},
    {"goto", "goto 4.0,1.5 1.57", "the run goes", "it refuses"},
    {"here", "here 4.0,1.5 1.57", "the run takes it", "it refuses"},
    {"stop", "stop --now", "the run stops", "it refuses"},
    {"reset", "reset", "the run may move again", "it refuses"},
    {"status", "status --json", "the run answered", "it refuses"},
}};

RunOptions run_options;
std::filesystem::path socket_path;
std::vector<std::string> goal;
bool stop_now = false, as_json = false, forced = false;

/// `say_it`: what the command does once its options are read. Returns its exit code.
void add_order(CLI::App& command, int& exit_code, std::function<int()> say_it) {
  command.add_option("--socket", socket_path, "The run's control socket (default: $JAYWALK_SOCKET, or the usual one)");
  command.callback([&exit_code, say_it = std::move(say_it)] { exit_code = say_it(); });
}

/// Prints the answer's lines "key: value" as one object.
void print_as_json(const std::string& answer) {
  nlohmann::ordered_json json;
  std::istringstream lines(answer);
  for (std::string said; std::getline(lines, said);) {
    const std::size_t colon = said.find(": ");
    if (colon != std::string::npos) json[said.substr(0, colon)] = said.substr(colon + 2);
  }
  std::printf("%s\n", json.dump(1).c_str());
}

/// Prints what the run answers; 1 where it refuses.
int say(const std::string& line) {
  const std::string answer = ask(socket_path.empty() ? default_control_socket() : socket_path, line);
  const bool refused = answer.starts_with("refused");
  if (as_json && !refused)
    print_as_json(answer);
  else
    std::fputs(answer.c_str(), refused ? stderr : stdout);
  return refused ? 1 : 0;
}

/// `order`: what to do with it.
int say_place(const std::string& order) {
  const std::string force = forced ? " --force" : "";
  std::string words;
  for (const std::string& word : goal) words += " " + word;
  if (!goal.empty() && std::all_of(goal.begin(), goal.end(), is_place_name)) return say(order + words + force);
  return say(order + " " + words_of(read_goal_order(words)) + force);
}

void add_run(CLI::App& app, int& exit_code, const MakeObserver& make_observer) {
  CLI::App* run = app.add_subcommand("run", "Run the controller on a robot until it is interrupted");
  run->add_option("robot", run_options.robot, "Robot file (TOML; docs/tutorial/first-real-robot.md)")->required();
  add_backend(*run, run_options.backend, run_options.device);
  run->add_option("--out", run_options.out, "Folder for what the run leaves")->capture_default_str();
  run->add_flag("--save-map", run_options.save_map, "Save what the robot saw: map.yaml and map.pgm (map_server)");
  run->add_option("--runs", run_options.runs, "Folder in which each run gets one of its own, instead of --out");
  run->add_option("--keep-runs", run_options.kept.runs, "How many runs are kept below --runs, this one included")
      ->check(CLI::Range(1, 100'000))
      ->capture_default_str();
  run->add_option("--keep-bytes", run_options.kept.bytes, "How much past runs below --runs may take, in bytes")
      ->capture_default_str();
  add_parts(*run, run_options.parts);
  run->add_option("--socket", run_options.control_socket, "Control socket (default: the file's)");
  run->add_flag("--uncommissioned", run_options.uncommissioned,
                "Start although this robot was never commissioned, or differently wired");
  run->add_flag("--allow-no-realtime", run_options.allow_no_realtime,
                "Start although the kernel refuses real-time priority or locked memory");
  run->callback([&exit_code, &make_observer] { exit_code = run_robot(run_options, make_observer); });
}

void add_check(CLI::App& app, int& exit_code) {
  CLI::App* check = app.add_subcommand("check", "Look at everything that a run needs; nothing moves");
  check->add_option("robot", run_options.robot, "Robot file (TOML; docs/tutorial/first-real-robot.md)")->required();
  check->add_option("--socket", run_options.control_socket, "Control socket (default: the file's)");
  add_backend(*check, run_options.backend, run_options.device);
  check->add_flag("--json", run_options.json, "As JSON: a list of part, ok, state (ok, warn, fail), said");
  check->callback([&exit_code] { exit_code = check_robot(run_options); });
}

std::string text_of(const Footer& footer, const std::string& program) {
  const std::string one = footer.one == std::string("-") ? "" : std::string(", 1: ") + footer.one;
  return "Example:\n  " + program + " " + footer.example + "\nExit code: 0: " + footer.zero + one +
         ", 2: bad input or set-up, 130: ended by Ctrl-C";
}

/// Whatever is opened first takes the number of a standard stream that was closed, a recording or a bus, and is written
/// to by what writes to that: gives such numbers to /dev/null. To be called before anything is opened.
void open_standard_streams() {
  int file = 0;
  do file = ::open("/dev/null", O_RDWR);
  while (file >= 0 && file <= STDERR_FILENO);
  if (file > STDERR_FILENO) ::close(file);
}

/// Throws StartupError when standard output did not take all that was said there, as on a full disk.
void require_heard() {
  if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return;
  throw StartupError("standard output: not all of it was taken", "free some space where it goes");
}

}  // namespace

int run_program(CLI::App& app, int argc, char** argv, const AddCommands& add_commands) {
  open_standard_streams();
  std::signal(SIGXFSZ, SIG_IGN);  // a file that may not grow (ulimit -f) is a full disk, and told as one
  int code = kBadInput;
  try {
    const int said = parse_and_run(app, argc, argv, add_commands);
    require_heard();
    code = said;
  } catch (const StartupError& error) {
    std::fprintf(stderr, "%s: %s\n", app.get_name().c_str(), printable(error.what()).c_str());
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s: %s; please report this with the command that led to it\n", app.get_name().c_str(),
                 printable(error.what()).c_str());
  }
  if (has_device_left_behind()) std::fflush(nullptr), std::_Exit(code);
  return code;
}

void add_robot_commands(CLI::App& app, int& exit_code, const MakeObserver& make_observer) {
  add_run(app, exit_code, make_observer);
  add_check(app, exit_code);
  CLI::App* go = app.add_subcommand("goto", "Tell a run where to go");
  go->add_option(
        "goal", goal,
        "X,Y [HEADING] in the map (m, rad; any heading where none is given), or names of places, one after the other")
      ->delimiter(',')
      ->expected(1, static_cast<int>(Route::capacity()))
      ->required();
  add_order(*go, exit_code, [] { return say_place("goto"); });
  CLI::App* here = app.add_subcommand("here", "Tell a run that stands where it is");
  here->add_option("place", goal, "X,Y HEADING in the map (m, rad), or the name of a place that has one")
      ->delimiter(',')
      ->expected(1, 3)
      ->required();
  here->add_flag("--force", forced, "Take it although the scan does not fit the map there; the run says so");
  add_order(*here, exit_code, [] { return say_place("here"); });
  CLI::App* stop = app.add_subcommand("stop", "Tell a run to stop where it is");
  stop->add_flag("--now", stop_now, "As an emergency: brake hard, and latch until a reset");
  add_order(*stop, exit_code, [] { return say(stop_now ? "stop now" : "stop"); });
  add_order(*app.add_subcommand("reset", "After a fault that stopped a run: let it move again"), exit_code,
            [] { return say("reset"); });
  CLI::App* status = app.add_subcommand("status", "Ask a run how it goes");
  add_order(*status, exit_code, [] { return say("status"); });
  status->add_flag("--json", as_json, "As JSON: an object with a text for each line");
  add_footers(app, kFooters);
}

void add_footers(CLI::App& app, std::span<const Footer> footers) {
  const std::string program = app.get_name();
  for (const Footer& footer : footers) app.get_subcommand(footer.command)->footer(text_of(footer, program));
  app.footer("Example:\n  " + program + " " + footers.front().example +
             "\nExit code: 0: as asked, 1: not so, 2: bad input or set-up; each command's --help says more");
}

}  // namespace jaywalk
