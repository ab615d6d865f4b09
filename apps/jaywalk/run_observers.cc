#include "apps/jaywalk/run_observers.h"

#include "apps/view/run_view.h"
#include "firmware/robot/planner_thread.h"

namespace jaywalk {
namespace {

std::optional<view::ViewAddress> page;

}  // namespace

void add_run_view(CLI::App& app) { add_view(*app.get_subcommand("run"), page); }

std::unique_ptr<TickObserver> observe_run(const RunOptions& options, const RobotFile& file,
                                          const std::filesystem::path& control_socket) {
  if (!page) return std::make_unique<RunObserver>();
  return std::make_unique<RunView>(*page, control_socket, options.robot.filename().string(), file.setup,
                                   map_for(file.setup));
}

}  // namespace jaywalk
