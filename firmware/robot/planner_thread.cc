#include "firmware/robot/planner_thread.h"

#include <cassert>

#include "drivers/wire/thread_without_signals.h"
#include "planner/tracking/tracker.h"

namespace jaywalk {

EvidenceMap map_for(const ControlSetup& setup) {
  return {PerceptionConfig{}.map_side_cells, setup.planner().cell_m, {}};
}

PlannerThread::PlannerThread(std::unique_ptr<Planner> planner, const EvidenceMap& map, TickObserver& observer)
    : planner_(std::move(planner)), observer_(observer), still_(map) {
  thread_ = thread_without_signals("plan", [this] { run(); });
}

PlannerThread::~PlannerThread() {
  ending_ = true;
  asked_.fetch_add(1);
  asked_.notify_one();
  thread_.join();
}

void PlannerThread::submit(const PlanRequest& request) noexcept {
  request_ = request;
  assert(request.still->side() == still_.side());
  still_.follow(*request.still);  // of the same size: no memory is taken
  moving_.clear();
  for (const Track& track : request.moving)
    if (!moving_.push_back(track)) break;
  standing_.clear();
  for (const StandingPedestrian& stander : request.standing)
    if (!standing_.push_back(stander)) break;
  masked_.clear();
  for (const MoverDisc& disc : request.masked)
    if (!masked_.push_back(disc)) break;
  unseen_walls_.clear();
  for (const Vec2 wall : request.poses.unseen_walls)
    if (!unseen_walls_.push_back(wall)) break;
  request_.poses.unseen_walls = {unseen_walls_.begin(), unseen_walls_.size()};
  request_.masked = {masked_.begin(), masked_.size()};
  request_.still = &still_;
  request_.moving = {moving_.begin(), moving_.size()};
  request_.standing = {standing_.begin(), standing_.size()};
  busy_.store(true, std::memory_order_release);
  asked_.fetch_add(1, std::memory_order_release);
  asked_.notify_one();
}

void PlannerThread::run() noexcept {
  for (std::uint32_t answered = 0;; ++answered) {
    asked_.wait(answered, std::memory_order_acquire);
    if (ending_) return;
    planner_->submit(request_);
    plans_.publish(planner_->collect());
    observer_.after_plan(*planner_, still_, request_.stamp);
    busy_.store(false, std::memory_order_release);
  }
}

FieldView PlannerThread::view_field() const {
  while (is_busy()) std::this_thread::yield();
  return planner_->view_field();
}

}  // namespace jaywalk
