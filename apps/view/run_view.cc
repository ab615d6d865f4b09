#include "apps/view/run_view.h"

#include <boost/asio/post.hpp>

#include "firmware/robot/control_socket.h"
#include "hal/types/errors.h"

namespace jaywalk {
namespace {
view::ViewAddress with_token(view::ViewAddress where) {
  where.wants_token = true;
  return where;
}

/// Nothing waits for one more than these.
constexpr unsigned kMostWaiting = 32;

/// Latches: beside the page others may give goals.
constexpr const char* kStop = "stop now";

}  // namespace

RunView::RunView(const view::ViewAddress& where, const std::filesystem::path& control_socket, const std::string& title,
                 const ControlSetup& setup, const EvidenceMap& map)
    : control_socket_(control_socket),
      tap_(map),
      live_(with_token(where), setup, false,
            [this](const view::ViewOrder& order, const view::Reply& reply) { obey(order, reply); }),
      address_file_(control_socket, live_.url()) {
  boost::asio::post(stops_, view::be_in_background);
  boost::asio::post(goals_, view::be_in_background);
  live_.begin({.title = title, .known = setup.known_map.get(), .takes_pauses = false});
}

void RunView::follow() {
  tap_.want(live_.viewers() > 0);
  for (auto& ring = tap_.snapshots(); ring.front() != nullptr; ring.pop()) live_.show(last_ = *ring.front(), "");
  const auto* const offered = tap_.offered();
  if (offered == nullptr) return;
  live_.show(offered->field);
  live_.show_map(offered->map, offered->stamp);
  tap_.taken();
}

std::filesystem::path RunView::finish(const RunEnd& end, const ControlLoop& loop, const Planner& planner) {
  follow();
  if (live_.viewers() > 0) live_.show(last_, end.outcome);
  return RunObserver::finish(end, loop, planner);
}

void RunView::obey(const view::ViewOrder& order, const view::Reply& reply) {
  if (order.stop) return stop(reply);
  if (order.reset) return go("reset", reply);
  if (order.goal) go("goto " + words_of(*order.goal), reply);
  if (order.here) go("here " + words_of(*order.here), reply);
}

std::string RunView::said_to(const std::string& line) const {
  try {
    return ask(control_socket_, line);
  } catch (const StartupError& error) {
    return error.what();
  }
}

/// Where many wait, those that have not gone yet are this one's as well.
void RunView::stop(const view::Reply& reply) {
  if (stops_asked_ - stops_done_ >= kMostWaiting) return reply("stopping\n");
  ++stops_asked_;
  boost::asio::post(stops_, [this, reply] {
    reply(said_to(kStop));
    ++stops_done_;
  });
}

/// After the stops before it. A stop that comes before it goes takes it back; one that comes while it is on its way may
/// have overtaken it, and is said once more.
void RunView::go(const std::string& line, const view::Reply& reply) {
  if (goals_waiting_ >= kMostWaiting) return reply("refused: too many goals at once\n");
  ++goals_waiting_;
  const auto say = [this, line, reply, stops = stops_asked_.load()] {
    const bool goes = stops == stops_asked_;
    reply(goes ? said_to(line) : "taken back by a stop\n");
    if (goes && stops != stops_asked_) static_cast<void>(said_to(kStop));
    --goals_waiting_;
  };
  boost::asio::post(stops_, [this, say] { boost::asio::post(goals_, say); });
}

}  // namespace jaywalk
