#include "apps/view/run_view.h"

#include "firmware/robot/control_socket.h"
#include "firmware/robot/goal_order.h"
#include "hal/types/errors.h"

namespace jaywalk {

namespace {

view::ViewAddress with_token(view::ViewAddress where) {
  where.wants_token = true;
  return where;
}

std::string answer_of(const std::filesystem::path& control_socket, const std::string& line) {
  try {
    return ask(control_socket, line);
  } catch (const StartupError& error) {
    return error.what();
  }
}

}  // namespace

RunView::RunView(const view::ViewAddress& where, const std::filesystem::path& control_socket, const std::string& title,
                 const ControlSetup& setup, const EvidenceMap& map)
    : planner_tap_(map),
      courier_([control_socket](const std::string& line) { return answer_of(control_socket, line); }),
      live_(with_token(where), false,
            [this](const view::ViewOrder& order, const view::Reply& reply) { obey(order, reply); }),
      address_file_(control_socket, live_.url()) {
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

void RunView::obey(const view::ViewOrder& order, const view::Reply& reply) {
  if (order.stop) return courier_.stop(reply);
  if (order.goal) courier_.go("goto " + words_of(GoalOrder{order.goal->goal_in_map, order.goal->heading_rad}), reply);
}

}  // namespace jaywalk
