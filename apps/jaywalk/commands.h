#pragma once
// The commands of `jaywalk`, each with its options in a file of its own.
#include <CLI/CLI.hpp>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "apps/view/view_server.h"

namespace jaywalk {

// Each is added to the command line; the one that is chosen runs within the parsing and leaves the process's exit code:
// 0, or 1 where what was asked about is not so. Throws StartupError for bad input.

/// Measures solver and planner, and what a user would pick instead, on the same maps in one run.
void add_bench(CLI::App& app, int& exit_code);
/// Estimates wheel radii, track width and mount from a guided drive or a recording; prints the keys to set.
void add_calibrate(CLI::App& app, int& exit_code);
/// Runs what of a campaign's share is not finished; 1 when it was stopped, or runs of it crashed or were refused.
void add_campaign(CLI::App& app, int& exit_code);
/// Turns each wheel a little and checks motors, encoders, sides, counts and the scanner against what the scans show;
/// leaves ROBOT.commissioned.json. Where it has to be broken off, what was found before is withdrawn.
void add_commission(CLI::App& app, int& exit_code);
/// Lists the keys of the settings files, from the tables that their parsers use.
void add_config(CLI::App& app, int& exit_code);
/// A run's recording as MCAP. The controller lives through it again, since tracks, plans and map are not in it.
void add_export(CLI::App& app, int& exit_code);
/// The fault matrix on the simulated robot: faults.csv (docs/reference/outputs.md); 1 where a row is not ok.
void add_faults(CLI::App& app, int& exit_code);
/// The potential of a map alone, as field.npy and field.json; 1 when it is not certified.
void add_field(CLI::App& app, int& exit_code);
/// Recorded laser and odometry through the whole pipeline except the wheels. Of a recording of our own every command is
/// compared, bit for bit.
void add_replay(CLI::App& app, int& exit_code);
/// Tells a single run in words, or writes the report of a campaign; 1 where runs of it are missing.
void add_report(CLI::App& app, int& exit_code);
/// Writes a ROBOT.toml from what is found and what a person knows, then looks at it as `check` does.
void add_setup(CLI::App& app, int& exit_code);
/// The whole controller on the simulated robot; 0 when it reached the goal, touched nothing and made no mover turn (the
/// strict rule).
void add_sim(CLI::App& app, int& exit_code);
/// One moment of a recording: a few sentences on standard output, and why.png.
void add_why(CLI::App& app, int& exit_code);

/// --view [PORT], --view-address, --view-certificate and --view-origin. Parsing throws StartupError for what is no
/// port.
void add_view(CLI::App& command, std::optional<view::ViewAddress>& chosen);
/// An option of `count` numbers with commas between them, places (m) and angles (rad), which `take` gets. Parsing
/// throws StartupError for NaN and what is farther than 1000 km.
void add_place(CLI::App& command, const std::string& name, int count,
               const std::function<void(const std::vector<double>&)>& take, const std::string& description);

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
