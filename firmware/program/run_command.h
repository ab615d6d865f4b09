#pragma once
#include <filesystem>
#include <functional>
#include <memory>

#include "firmware/control_setup.h"
#include "firmware/recording/run_folders.h"
#include "firmware/robot/robot_file.h"
#include "firmware/run_sample.h"

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

/// Prints a line for each part that a run would need, with a remedy where it is not well. Nothing moves.
/// Returns the process's exit code: 0 where all is well, else 1.
[[nodiscard]] int check_robot(const RunOptions& options);

}  // namespace jaywalk
