#pragma once
#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "firmware/control_setup.h"
#include "firmware/recording/run_folders.h"
#include "firmware/robot/robot_file.h"
#include "firmware/run_sample.h"
#include "hal/shown_text.h"
#include "hal/types/errors.h"

namespace jaywalk {

struct RunOptions {
  std::filesystem::path robot;  ///< ROBOT.toml
  Backend backend = Backend::kAuto;
  int device = 0;  ///< CUDA's number
  std::filesystem::path out = "out/run";
  bool save_map = false;       ///< what the robot saw, as map_server files
  std::filesystem::path runs;  ///< where each run gets a folder of its own, in place of `out`; empty: `out` it is
  RunsKept kept;               ///< below `runs`
  PartsKept parts;             ///< of this run
  std::filesystem::path control_socket;  ///< empty: the file's, else the default
  bool json = false;                     ///< of a check: for programs
  bool uncommissioned = false;           ///< start although no commissioning of this wiring passed
  bool allow_no_realtime = false;        ///< start although the kernel refuses priority or locked memory
};

/// Makes the observer of a run, before its first tick.
using MakeObserver = std::function<std::unique_ptr<TickObserver>(const RunOptions& options, const RobotFile& file,
                                                                 const std::filesystem::path& control_socket)>;

/// The controller on the robot, until SIGINT or SIGTERM: then it ramps to rest, disarms and writes its summary.
/// Returns the process's exit code: 0 when it ended without a fault that waits for a reset, else 1.
/// Throws StartupError for what keeps it from starting, an arming proof that failed among it.
[[nodiscard]] int run_robot(RunOptions options, const MakeObserver& make_observer);

/// Prints a line for each part that a run needs; nothing moves. Returns the exit code: 0 where all is well, else 1.
[[nodiscard]] int check_robot(const RunOptions& options);

/// Adds its commands to the command line. The chosen one runs within parse() and leaves its exit code.
using AddCommands = std::function<void(CLI::App& app, int& exit_code)>;

/// The whole of main() for a program of commands: parses, runs the chosen one, and says in one line what keeps it from
/// running. Returns the process's exit code, 2 for bad input or set-up.
[[nodiscard]] int run_program(CLI::App& app, int argc, char** argv, const AddCommands& add_commands);

/// Adds run, check, goto, here, stop, reset and status to the command line. `exit_code` outlives the parsing.
void add_robot_commands(CLI::App& app, int& exit_code, const MakeObserver& make_observer);

/// Adds an option that takes one of the words in `choices`. `chosen` holds the default. Help and errors list the words
/// alone; CLI11's own check would list the values, too. Parsing throws StartupError for any other word.
template <class T>
void add_choice(CLI::App& command, const std::string& option, T& chosen,
                const std::vector<std::pair<std::string, T>>& choices, const std::string& about) {
  std::string words, usual;
  for (const auto& [word, value] : choices) {
    words += (words.empty() ? "" : "|") + word;
    if (value == chosen) usual = word;
  }
  const auto choose = [&chosen, option, choices, words](const std::string& word) {
    const auto found = std::find_if(choices.begin(), choices.end(), [&](const auto& c) { return c.first == word; });
    if (found == choices.end()) throw StartupError(option + ": no such choice: " + shown(word), "give " + words);
    chosen = found->second;
  };
  command.add_option_function<std::string>(option, choose, about)->type_name(words)->default_str(usual);
}

inline void add_backend(CLI::App& command, Backend& chosen, int& device) {
  add_choice<Backend>(command, "--backend", chosen,
                      {{"auto", Backend::kAuto}, {"cpu", Backend::kCpu}, {"cuda", Backend::kCuda}}, "Who plans");
  command.add_option("--device", device, "Number of the GPU that plans, as CUDA counts them from 0")
      ->check(CLI::Range(0, 255))
      ->capture_default_str();
}

inline void add_parts(CLI::App& command, PartsKept& kept) {
  command
      .add_option("--part-bytes", kept.bytes,
                  "Recording and tables in parts of at most so many bytes, 200000 or more; 0: whole")
      ->type_name("UINT")
      ->capture_default_str();
  command.add_option("--keep-parts", kept.parts, "How many parts are kept, the one that is written among them")
      ->check(CLI::Range(2, 1'000'000))
      ->capture_default_str();
}

/// Throws StartupError for a word of the command line that is empty, or an option that ends in "=": the parser would
/// read a number as 0, from a shell's unset variable, say.
inline void refuse_empty_words(int argc, const char* const* argv) {
  for (int k = 1; k < argc; ++k) {
    const std::string word = argv[k];
    const bool option_of_nothing = word.rfind("--", 0) == 0 && word.back() == '=';
    if (!word.empty() && !option_of_nothing) continue;
    const std::string place = option_of_nothing ? " behind " + shown(word)
                              : k > 1           ? " behind " + shown(argv[k - 1])
                                                : "";
    throw StartupError("a word of the command line is empty" + place, "give a value, or leave it out");
  }
}

/// What stands under a command's help.
struct Footer {
  const char* command;
  const char* example;  ///< without the program's name
  const char* zero;     ///< meaning of exit code 0
  const char* one;      ///< of exit code 1; "-": there is none
};

/// Under each command's help: an example, and what its exit code says. The program's own help shows the first.
void add_footers(CLI::App& app, std::span<const Footer> footers);

}  // namespace jaywalk
