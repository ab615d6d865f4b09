#include "apps/view/run_view.h"

#include "firmware/robot/control_socket.h"
#include "firmware/robot/goal_order.h"
#include "hal/types/errors.h"

namespace jaywalk {

RunView::RunView(const view::ViewAddress& where, std::filesystem::path control_socket, const std::string& title,
                 const ControlSetup& setup, const EvidenceMap& map)
    : control_socket_(std::move(control_socket)),
      planner_tap_(map),
      live_(where, false, [this](const view::ViewOrder& order) { return obey(order); }) {
  live_.begin({.title = title, .model = setup.model, .takes_pauses = false}, setup.tick());
}

void RunView::follow() {
  const bool wanted = live_.viewers() > 0;
  snapshots_.want(wanted);
  planner_tap_.want(wanted);
  for (auto& ring = snapshots_.snapshots(); ring.front() != nullptr; ring.pop()) live_.show(*ring.front(), "");
  if (!planner_tap_.has_new()) return;
  live_.show(planner_tap_.field());
  if (live_.is_map_due(planner_tap_.stamp())) live_.show_map(planner_tap_.map(), planner_tap_.stamp());
  planner_tap_.taken();
}

std::string RunView::obey(const view::ViewOrder& order) const {
  try {
    if (order.stop) return ask(control_socket_, "stop");
    if (!order.goal) return "";
    return ask(control_socket_, "goto " + words_of(GoalOrder{order.goal->goal_in_map, order.goal->heading_rad}));
  } catch (const StartupError& error) {
    return error.what();
  }
}

}  // namespace jaywalk
