#include "apps/view/sim_view.h"

#include <algorithm>
#include <thread>

namespace jaywalk {
namespace {

constexpr auto kPausedLook = std::chrono::milliseconds(5);  // at the page's orders while paused
constexpr int kLooksUntilTold = 20;

}  // namespace

SimView::SimView(const view::ViewAddress& where, const ControlSetup& setup, OperatorPanel& panel)
    : panel_(panel),
      takes_goals_(!setup.keeps_speed()),
      tick_(setup.tick()),
      live_(where, setup.model, true,
            [this](const view::ViewOrder& order, const view::Reply& reply) { take(order, reply); }) {}

void SimView::take(const view::ViewOrder& order, const view::Reply& reply) {
  orders_.add(order);
  if (order.stop) reply(takes_goals_ ? "stopping\n" : "a run that keeps its speed does not stop\n");
  if (order.reset) reply(stands_ ? "reset\n" : "refused: the robot still moves; try again when it stands\n");
  if (order.here) reply("refused: a simulated robot stands where it is\n");
  if (order.goal && is_stopped_) reply("refused: stopped by this page; press Reset first\n");
}

void SimView::begin(const std::string& title, std::span<const view::WallPiece> walls) {
  live_.begin({.title = title, .walls = walls, .takes_goals = takes_goals_}, tick_);
}

void SimView::follow(const LoopRunner& runner, const std::string& ended, const Interruption& interruption) {
  live_.follow(runner, ended, paused_);
  stands_ = runner.last().verdict.permitted == Twist2{};
  keep_pace();
  if (ended.empty()) obey_while_paused(interruption);
}

/// A run that was held up does not hurry to make up for it.
void SimView::keep_pace() {
  const auto now = std::chrono::steady_clock::now();
  due_ = std::max(due_ + std::chrono::duration_cast<std::chrono::steady_clock::duration>(tick_), now);
  std::this_thread::sleep_until(due_);
}

void SimView::obey_while_paused(const Interruption& interruption) {
  for (int looks = 0; !interruption.came(); ++looks, std::this_thread::sleep_for(kPausedLook)) {
    const view::ViewOrder order = orders_.take();
    if (order.pause) paused_ = *order.pause;
    if (takes_goals_) panel_.obey(order, stands_);
    is_stopped_ = panel_.is_pressed();
    if (!paused_ || order.step) return;
    if (looks % kLooksUntilTold == 0) live_.tell_paused();
  }
}

}  // namespace jaywalk
