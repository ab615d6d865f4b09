#include "planner/paper/paper.h"

#include "planner/paper/executor.h"
#include "planner/paper/map_field_on.h"
#include "planner/paper/paper_planner.h"
#include "planner/paper/path_motion.h"

namespace jaywalk::paper {

std::unique_ptr<Planner> make_cpu_paper_planner(const PaperConfig& config) {
  check(config);
  return std::make_unique<PaperPlanner<SerialExecutor>>(config, std::make_unique<SerialExecutor>());
}

std::unique_ptr<motion::Motion> make_motion(const motion::MotionSetup& setup) {
  return std::make_unique<PathMotion>(setup);
}

std::unique_ptr<MapField> make_cpu_map_field(CellMap map) {
  return std::make_unique<MapFieldOn<SerialExecutor>>(std::move(map), std::make_unique<SerialExecutor>());
}

}  // namespace jaywalk::paper
