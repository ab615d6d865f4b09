#pragma once
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "apps/view/view_server.h"
#include "firmware/control_setup.h"
#include "firmware/recording/run_parts.h"

namespace jaywalk {

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

/// The whole controller on the simulated robot; the scenario may be the name of one that comes with the program
/// (shipped_scenarios.h). Returns the process's exit code: 0 when the run succeeded by the strict
/// rule (goal reached, nobody touched, nobody made to turn), 1 when not. Throws StartupError for bad input.
[[nodiscard]] int run_sim(SimOptions options);

}  // namespace jaywalk
