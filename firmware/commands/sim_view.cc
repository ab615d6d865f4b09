#include "firmware/commands/sim_view.h"

#include <algorithm>
#include <cstdio>
#include <thread>

namespace jaywalk {
namespace {

constexpr Duration kShowEvery = std::chrono::milliseconds(40);    // smooth to the eye
constexpr Duration kFieldEvery = std::chrono::milliseconds(500);  // 22 kB, and it changes slowly
constexpr auto kLookEvery = std::chrono::milliseconds(5);         // at the page's orders while paused

}  // namespace

SimView::SimView(const view::ViewAddress& where, OperatorPanel& panel, bool takes_goals)
    : panel_(panel),
      server_(where,
              [this](std::string_view text) {
                if (const auto order = view::parse_order(text)) orders_.add(*order);
              }),
      takes_goals_(takes_goals) {
  std::printf("view: %s\n", server_.url().c_str());
  std::fflush(stdout);
}

void SimView::begin(const std::string& title, const RobotModel& model, std::span<const view::WallPiece> walls) {
  robot_from_laser_ = model.laser.robot_from_laser;
  server_.push(view::MessageKind::kHello,
               to_json(view::HelloScene{.title = title, .model = model, .walls = walls, .takes_goals = takes_goals_}));
}

void SimView::follow(const LoopRunner& runner, const std::string& ended) {
  show(runner, ended);
  keep_pace(runner.setup().tick());
  if (ended.empty()) obey_while_paused();
}

void SimView::show(const LoopRunner& runner, const std::string& ended) {
  const TickRecord& t = runner.last();
  const bool last = !ended.empty() || paused_;
  if (!last && shown_ != kNever && age(shown_, t.now) < kShowEvery) return;
  shown_ = t.now;
  const ControlLoop& loop = runner.loop();
  server_.push(view::MessageKind::kFrame, to_json(view::FrameScene{.record = t,
                                                                   .tracks = loop.tracker().tracks(),
                                                                   .standing = loop.tracker().standing(),
                                                                   .plan = loop.plan(),
                                                                   .ended = ended},
                                                  robot_from_laser_));
  if (field_shown_ != kNever && age(field_shown_, t.now) < kFieldEvery) return;
  if (loop.plan().status != PlanStatus::kOk) return;
  field_shown_ = t.now;
  server_.push(view::MessageKind::kField, view::to_json(runner.planner().view_field()));
}

/// A run that was held up does not hurry to make up for it.
void SimView::keep_pace(Duration tick) {
  const auto now = std::chrono::steady_clock::now();
  due_ = std::max(due_ + std::chrono::duration_cast<std::chrono::steady_clock::duration>(tick), now);
  std::this_thread::sleep_until(due_);
}

void SimView::obey_while_paused() {
  for (;; std::this_thread::sleep_for(kLookEvery)) {
    const view::ViewOrder order = orders_.take();
    if (order.pause) paused_ = *order.pause;
    if (takes_goals_) panel_.obey(order);
    if (!paused_ || order.step) return;
  }
}

}  // namespace jaywalk
