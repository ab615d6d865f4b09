#pragma once
// The commands of `jaywalk`, each with its options in a file of its own.
#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

#include "apps/view/view_server.h"
#include "hal/types/geometry.h"

namespace jaywalk {

// Each is added to the command line; the one that is chosen runs within the parsing and leaves the process's exit code:
// 0, or 1 where what was asked about is not so (main.cc says what that means for each). Throws StartupError for bad
// input.

void add_bench(CLI::App& app, int& exit_code);
void add_calibrate(CLI::App& app, int& exit_code);
void add_campaign(CLI::App& app, int& exit_code);
/// Leaves ROBOT.commissioned.json. Where it has to be broken off, what was found before is withdrawn.
void add_commission(CLI::App& app, int& exit_code);
/// The keys come from the tables that the files' parsers use.
void add_config(CLI::App& app, int& exit_code);
/// The controller lives through the recording again, since tracks, plans and map are not in it.
void add_export(CLI::App& app, int& exit_code);
void add_faults(CLI::App& app, int& exit_code);
void add_field(CLI::App& app, int& exit_code);
/// The whole pipeline except the wheels. Of a recording of our own every command is compared, bit for bit.
void add_replay(CLI::App& app, int& exit_code);
void add_report(CLI::App& app, int& exit_code);
/// Writes a ROBOT.toml, then looks at it as `check` does.
void add_setup(CLI::App& app, int& exit_code);
/// The strict rule: the goal was reached, nothing touched and no mover made to turn.
void add_sim(CLI::App& app, int& exit_code);
/// Prints a few sentences about one moment of a recording, and leaves why.png.
void add_why(CLI::App& app, int& exit_code);

/// --view [PORT], --view-address, --view-certificate and --view-origin. Parsing throws StartupError for what is no
/// port.
void add_view(CLI::App& command, std::optional<view::ViewAddress>& chosen);
/// An option X,Y (m) for a Vec2, or X,Y,YAW (m, m, rad) for a Pose2. Parsing throws StartupError for NaN and what is
/// farther than 1000 km.
template <class Place>
void add_place(CLI::App& command, const std::string& name, std::optional<Place>& chosen,
               const std::string& description);

/// --man, --markdown and --completion: printed from what --help prints from, so that they cannot differ.
void add_manual_options(CLI::App& app);

}  // namespace jaywalk
