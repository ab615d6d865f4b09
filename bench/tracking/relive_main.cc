// jaywalk_relive: what this build's localizer and tracker make of a recording. bench/tracking/recordings.py uses it.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <vector>

#include "bench/command_line.h"
#include "bench/tracking/relive.h"
#include "hal/types/errors.h"

int main(int argc, char** argv) {
  jaywalk::bench::ReliveOptions options;
  std::vector<double> mount{0.0, 0.0, 0.0};
  CLI::App app("Lives through a recording with localizer and tracker alone", "jaywalk_relive");
  app.add_option("RECORDING", options.recording, "recording.jwr of a simulation, or SCAN.txt")
      ->required()
      ->check(CLI::ExistingFile);
  app.add_option("ODOMETRY", options.odometry, "beside SCAN.txt")->check(CLI::ExistingFile);
  app.add_option("--out", options.out, "folder for robot.csv and tracks.csv")->required();
  app.add_option("--laser-mount", mount, "X,Y,YAW: m and rad, in the robot's frame")->delimiter(',')->expected(3);
  if (const auto ended = jaywalk::bench::ended_by_command_line(app, argc, argv)) return *ended;
  options.robot_from_laser = {mount[0], mount[1], mount[2]};
  try {
    jaywalk::bench::relive(options);
  } catch (const jaywalk::StartupError& error) {
    std::fprintf(stderr, "jaywalk_relive: %s\n", error.what());
    return 2;
  }
  return 0;
}
