#pragma once
// The commands of `jaywalk`.
#include <CLI/CLI.hpp>
#include <cmath>
#include <filesystem>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "apps/view/view_server.h"
#include "firmware/control_loop.h"
#include "hal/shown_text.h"
#include "hal/types/geometry.h"

namespace jaywalk {

// Each adds its command, which runs within the parsing and leaves the process's exit code: 0, or 1 as main.cc says.
// Throws StartupError for bad input.

void add_bench(CLI::App& app, int& exit_code);
void add_calibrate(CLI::App& app, int& exit_code);
void add_campaign(CLI::App& app, int& exit_code);
/// Leaves ROBOT.commissioned.json. Where it has to be broken off, what was found before is withdrawn.
void add_commission(CLI::App& app, int& exit_code);
void add_config(CLI::App& app, int& exit_code);
/// The controller lives through the recording again, since tracks, plans and map are not in it.
void add_export(CLI::App& app, int& exit_code);
void add_faults(CLI::App& app, int& exit_code);
void add_field(CLI::App& app, int& exit_code);
/// The whole pipeline except the wheels. Of a recording of our own every command is compared, bit for bit.
void add_replay(CLI::App& app, int& exit_code);
void add_report(CLI::App& app, int& exit_code);
void add_setup(CLI::App& app, int& exit_code);
void add_sim(CLI::App& app, int& exit_code);
void add_why(CLI::App& app, int& exit_code);

/// Options of the live page. Parsing throws StartupError for what is no port.
void add_view(CLI::App& command, std::optional<view::ViewAddress>& chosen);

/// Options of a command that runs the loop itself: what it leaves, and the page on which it is seen.
struct LoopOptions {
  std::filesystem::path out;
  bool save_map = false;                  ///< what the robot saw, as map_server files
  bool mcap = false;                      ///< leave run.mcap as well
  bool json = false;                      ///< print the summary, in place of a line
  std::optional<view::ViewAddress> view;  ///< serve the live page there
};
/// `options.out` holds its default.
void add_loop_options(CLI::App& command, LoopOptions& options);
/// Finishes the run; prints its summary, or `told` and the file to look at first. Throws StartupError for a full disk.
void conclude(const LoopOptions& options, LoopRunner& runner, RunEnd end, const std::string& told);

/// An option X,Y (m) for a Vec2, or X,Y,YAW (m, m, rad) for a Pose2. Parsing throws StartupError for NaN and what is
/// farther than 1000 km.
template <class Place>
void add_place(CLI::App& command, const std::string& name, std::optional<Place>& chosen,
               const std::string& description) {
  constexpr bool kIsPose = std::is_same_v<Place, Pose2>;
  const auto take = [&chosen, name](const std::vector<double>& v) {
    for (const double value : v)
      if (!(std::fabs(value) <= 1e6))
        throw StartupError(name + formatted(": %g is no place", value), "give metres and radians");
    chosen = {v[0], v[1]};
    if constexpr (kIsPose) chosen->heading = wrap_angle(v[2]);
  };
  command.add_option_function<std::vector<double>>(name, take, description)->delimiter(',')->expected(kIsPose ? 3 : 2);
}

/// --man, --markdown and --completion: printed from what --help prints from, so that they cannot differ.
void add_manual_options(CLI::App& app);

}  // namespace jaywalk
