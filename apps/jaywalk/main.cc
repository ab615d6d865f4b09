#include <CLI/CLI.hpp>
#include <array>

#include "apps/jaywalk/commands.h"
#include "apps/view/run_view.h"
#include "firmware/backends.h"
#include "firmware/program/program.h"

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

std::optional<view::ViewAddress> run_page;

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
