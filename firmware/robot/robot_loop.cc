#include "firmware/robot/robot_loop.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "drivers/wire/thread_without_signals.h"
#include "hal/types/wheels.h"

namespace jaywalk {
namespace {

/// What a wheel said before that tells no speed any more.
constexpr Duration kSpeedKnown = std::chrono::milliseconds(500);
constexpr Duration kLongestRamp = std::chrono::seconds(5), kLongestDisarming = std::chrono::milliseconds(500);

}  // namespace

StallGuard::~StallGuard() {
  ending_ = true;
  if (thread_.joinable()) thread_.join();
}

void StallGuard::start(int priority) {
  thread_ = thread_without_signals("guard", [this, priority] { watch(priority); });
}

void StallGuard::watch(int priority) noexcept {
  static_cast<void>(enter_realtime({.priority = priority}));  // the loop's thread tells what is not permitted
  bool stalled = false;
  while (!ending_) {
    clock_.sleep_until(clock_.now() + limit_ / 4);
    const std::int64_t beat = beat_.load(std::memory_order_acquire);
    const bool late = beat != kResting && clock_.now() - Time{Duration{beat}} > limit_;
    if (late) brake_();
    if (late && !stalled) stalls_.fetch_add(1, std::memory_order_relaxed);
    stalled = late;
  }
}

RobotLoop::RobotLoop(LoopRunner& runner, const LoopDevices& devices, OperatorDesk& desk, Clock& clock,
                     StallGuard& guard, TickObserver& observer)
    : runner_(runner),
      devices_(devices),
      desk_(desk),
      clock_(clock),
      guard_(guard),
      observer_(observer),
      period_(runner.setup().tick()),
      place_check_(runner.setup().model) {}

RobotLoop::~RobotLoop() {
  end();
  Stage prepared = Stage::kPrepared;
  stage_.compare_exchange_strong(prepared, Stage::kGivenUp);
  stage_.notify_all();
  if (thread_.joinable()) thread_.join();
}

std::vector<std::string> RobotLoop::prepare(const RealtimeWishes& wishes) {
  thread_ = thread_without_signals("loop", [this, wishes] { run(wishes); });
  stage_.wait(Stage::kPreparing);
  return not_permitted_;
}

void RobotLoop::start() noexcept {
  stage_ = Stage::kStarted;
  stage_.notify_all();
}

void RobotLoop::end() noexcept {
  desk_.close();
  ending_ = true;
}

void RobotLoop::run(const RealtimeWishes& wishes) {
  not_permitted_ = enter_realtime(wishes);
  stage_ = Stage::kPrepared;
  stage_.notify_all();
  stage_.wait(Stage::kPrepared);
  if (stage_ == Stage::kStarted) live();
  ended_ = true;
}

void RobotLoop::live() noexcept {
  Time due = clock_.now() + period_;
  std::optional<Time> asked_to_end;
  for (bool at_rest = false; !(asked_to_end && (at_rest || due - *asked_to_end > kLongestRamp)); due += period_) {
    due = next_due(due);
    tick(due);
    if (ending_ && !asked_to_end) asked_to_end = due;
    at_rest = status_.at_rest;
  }
  guard_.rest();
  disarm(due);
}

/// Sleeps until the next tick; where that is a period late or more, the ticks that were missed are left out.
Time RobotLoop::next_due(Time due) noexcept {
  clock_.sleep_until(due);
  const Duration late = clock_.now() - due;
  times_.wake_late_us.add(to_seconds(late) * 1e6);
  const auto missed = std::max<std::int64_t>(late / period_, 0);
  status_.missed_ticks += static_cast<std::uint64_t>(missed);
  return due + missed * period_;
}

void RobotLoop::tick(Time due) noexcept {
  const Time began = clock_.now();
  guard_.beat(began);
  const TickRecord& t = runner_.tick_at(due);
  status_.speed_mps = speed_mps(t.wheels, t.now);
  devices_.resets.note_turning(status_.speed_mps > kAtRest_mps);
  if (place_check_.step(desk_.place_to_check(), t, runner_.loop().tracker().still()))
    desk_.answer_place(status_.place = place_check_.answer());
  tell(t);
  trace(t);
  observer_.after_tick(t, runner_.loop());
  note_times(began);
}

/// Faults of the first tick are its own: memory that was never touched.
void RobotLoop::note_times(Time began) noexcept {
  times_.tick_us.add(to_seconds(clock_.now() - began) * 1e6);
  if (!faults_before_) faults_before_ = page_faults();
  status_.page_faults = page_faults().since(*faults_before_);
  status_.wake_late_max_us = times_.wake_late_us.max();
  times_.minor_faults = status_.page_faults.minor;
  times_.major_faults = status_.page_faults.major;
}

double RobotLoop::speed_mps(const WheelState& wheels, Time now) const noexcept {
  if (wheels.sequence > 0 && age(wheels.stamp, now) > kSpeedKnown) return std::numeric_limits<double>::quiet_NaN();
  return std::max(std::fabs(wheels.left_radps), std::fabs(wheels.right_radps)) *
         runner_.setup().model.drive.wheel_radius_m;
}

void RobotLoop::tell(const TickRecord& t) noexcept {
  status_.running = true;
  status_.map_from_robot = t.pose.map_from_robot;
  status_.at_rest = !(status_.speed_mps > kAtRest_mps) && t.command.left_radps == 0.0 && t.command.right_radps == 0.0;
  status_.enabled = devices_.drive.is_enabled();
  status_.proved = devices_.drive.is_proved();
  status_.foreign_frame = devices_.drive.foreign_frame();
  if (has(t.verdict.reasons, Reason::kLatched)) status_.goal_reached = false;
  if (t.input.has_goal) {
    const bool stands = status_.speed_mps < kAtRest_mps;
    status_.goal_reached = t.input.is_reached_at(t.pose.map_from_robot) && (stands || !t.input.wants_heading());
    status_.heading_error_rad = t.input.heading_error_rad(t.pose.map_from_robot);
  }
  status_.steered = t.input.steers && !t.input.stick.is_centred();
  if (status_.steered) status_.goal_reached = false;
  status_.has_goal = t.input.has_goal && !status_.goal_reached;
  status_.goal_in_map = t.input.goal_in_map;
  status_.goal_heading_rad = t.input.goal_heading_rad;
  status_.turns_at_goal = runner_.loop().motion().status().turns_at_goal;
  status_.reasons = t.verdict.reasons;
  status_.faulty_scanners = t.verdict.faulty_scanners;
  status_.plan = t.plan_status;
  status_.backend = runner_.planner().backend();
  status_.latched = has(t.verdict.reasons, Reason::kLatched);
  status_.drive = t.wheels.trouble;
  status_.drive_fault = t.wheels.fault;
  status_.drive_is_silent = devices_.drive.is_silent();
  status_.laser = devices_.lasers.front()->health();
  status_.other_lasers.clear();
  for (const auto& laser : devices_.lasers.subspan(1)) (void)status_.other_lasers.push_back(laser->health());
  status_.bus = devices_.bus.health();
  status_.ticks = ticks() + 1;
  status_.stalls = guard_.stalls();
  desk_.tell(status_);
  ticks_.store(status_.ticks, std::memory_order_release);  // after the desk was told: a run is ready then
}

/// Where the report cannot follow, its tables lack a tick; the recording has it.
void RobotLoop::trace(const TickRecord& t) noexcept {
  TickTrace* const slot = traces_.draft();
  if (slot == nullptr) return;
  slot->record = t;
  slot->tracks.clear();
  for (const Track& track : runner_.loop().tracker().tracks())
    if (!slot->tracks.push_back(track)) break;
  slot->took = runner_.last_took();
  slot->plan_took.reset();
  const Plan& plan = runner_.loop().plan();
  if (plan.sequence != plan_traced_) slot->plan_took = plan.took;
  plan_traced_ = plan.sequence;
  slot->status = status_;
  traces_.publish();
}

void RobotLoop::disarm(Time due) noexcept {
  const Time limit = due + kLongestDisarming;
  do {
    clock_.sleep_until(due);
    static_cast<void>(devices_.drive.latest());
    devices_.drive.disarm();
    due += period_;
  } while (devices_.drive.is_enabled() && due < limit);
}

}  // namespace jaywalk
