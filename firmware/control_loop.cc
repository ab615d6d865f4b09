#include "firmware/control_loop.h"

#include <algorithm>

namespace jaywalk {
namespace {

constexpr Duration kPlanEvery = std::chrono::milliseconds(90);  // walls are no hurry: motion looks out for movers
constexpr Duration kGuideHoldsFor = std::chrono::seconds(1);    // as the supervisor's longest age of a plan

FollowerConfig follower_config(const ControlSetup& setup) {
  return {.limits = setup.model.limits,
          .robot = setup.guides_body() ? RobotShape{.footprint = setup.model.footprint}
                                       : RobotShape{.radius_m = setup.mover_radius_m()},
          .stands_at_worst = setup.guides_body(),
          .constant_speed = setup.keeps_speed(),
          .goal_tolerance_m = setup.goal_tolerance_m,
          .tick_s = to_seconds(setup.tick())};
}

std::unique_ptr<FootprintGuide> guide_for(const ControlSetup& setup) {
  if (!setup.guides_body()) return nullptr;
  return std::make_unique<FootprintGuide>(setup.model.footprint, setup.model.limits);
}

std::unique_ptr<GoalTurn> turn_for(const ControlSetup& setup) {
  if (setup.keeps_speed()) return nullptr;
  return std::make_unique<GoalTurn>(setup.model.footprint, setup.model.limits, !setup.guides_body());
}

KeepOut view_of(const std::shared_ptr<const KeepOutField>& field) { return field ? field->view() : KeepOut{}; }

motion::MotionConfig motion_config(const ControlSetup& setup) {
  return {.footprint = setup.model.footprint,
          .limits = setup.model.limits,
          .laser = setup.model.laser,
          .berth_m = setup.berth_m,
          .constant_speed = setup.constant_speed,
          .goal_tolerance_m = setup.goal_tolerance_m,
          .tick_s = to_seconds(setup.tick())};
}

std::unique_ptr<motion::MotionPlanner> motion_for(const ControlSetup& setup) {
  if (setup.guides_body() || setup.mode == PlanMode::kPaper) return nullptr;
  return std::make_unique<motion::MotionPlanner>(motion_config(setup));
}

std::unique_ptr<motion::SharedControl> shared_for(const ControlSetup& setup, const KeepOut& keep_out) {
  if (setup.steering == StickUse::kNone) return nullptr;
  motion::MotionConfig config = motion_config(setup);
  config.keep_out = keep_out;
  return std::make_unique<motion::SharedControl>(config, setup.steering == StickUse::kShared);
}

std::unique_ptr<baseline::BaselinePlanner> baseline_for(const ControlSetup& setup) {
  if (setup.baseline == baseline::Baseline::kOurs) return nullptr;
  return std::make_unique<baseline::BaselinePlanner>(setup.baseline, motion_config(setup));
}

SupervisorConfig supervisor_config(const ControlSetup& setup) {
  SupervisorConfig config{.model = setup.model,
                          .tick = setup.tick(),
                          .needs_wheels = setup.wheels,
                          .judges_motion = setup.judges_motion && setup.wheels && setup.applies_verdict(),
                          .latches_all = setup.wired};
  config.max_wheel_age = std::max(config.max_wheel_age, 5 * setup.tick() / 2);  // of feedback, too, one may be lost
  return config;
}

}  // namespace

ControlLoop::ControlLoop(const ControlSetup& setup, Hal hal, Planner& planner, Recorder& recorder)
    : setup_(setup),
      hal_(hal),
      planner_(planner),
      recorder_(recorder),
      keep_out_(setup.keep_out()),
      speed_zones_(setup.zones, setup.model),
      estimator_(setup),
      follower_(follower_config(setup)),
      motion_(motion_for(setup)),
      shared_(shared_for(setup, view_of(keep_out_))),
      baseline_(baseline_for(setup)),
      guide_(guide_for(setup)),
      turn_(turn_for(setup)),
      latency_(setup.model.drive),
      supervisor_(supervisor_config(setup)),
      diff_drive_(setup.model.drive),
      plan_(&planner.collect()) {}

const TickRecord& ControlLoop::tick(Time now) noexcept {
  TickRecord& t = recorder_.begin(now);  // preallocated; all that crosses the HAL this tick

  t.scan = hal_.laser.latest();  // Sense: the newest of each; nothing waits.
  blank(setup_.model.laser.blanked, t.scan);
  t.wheels = hal_.drive.latest();
  t.input = hal_.panel.latest();
  t.fix = hal_.pose_source.latest();

  const bool new_scan = estimator_.update(t);  // Estimate
  t.pose = estimator_.pose();

  plan_ = &planner_.collect();  // Plan: take what was asked for in an earlier tick.
  note_plan(t);
  estimator_.forget_where_stuck(t);

  zone_speed_ = speed_zones_.at(t.pose.map_from_robot.position());
  limit_wishes(zone_speed_.ahead_mps);
  if (turn_) turn_->aim(t.input, t.pose.map_from_robot, driven_);
  t.wished = is_steered(t) ? shared_->asked(t.input.stick) : Twist2{};
  t.wanted = is_steered(t)        ? shared_->twist(now, stick_for_motion(t), driven_)
             : drives_by_motion() ? motion_twist(t)
                                  : follower_.twist(follower_input(t));  // Act: one asks,
  t.latency = latency_.measured();
  t.verdict =  // the supervisor permits.
      supervisor_.judge(t.wanted, {t.scan, t.wheels, t.input, t.plan_stamp, now, t.latency, turns_at_goal(),
                                   zone_speed_.here_mps, sent_});
  if (turn_ && turn_->blocked()) t.verdict.reasons |= Reason::kTurnBlocked;
  if (recorder_.is_losing()) t.verdict.reasons |= Reason::kNotRecorded;
  driven_ = setup_.applies_verdict() ? t.verdict.permitted : t.wanted;
  t.command = diff_drive_.wheel_speeds(driven_, now);
  hal_.drive.command(t.command);
  t.took = hal_.clock.now() - now;
  latency_.add(now, t.took, t.wheels, t.command);
  sent_ = t.command;
  estimator_.end_tick(t);

  if (t.input.has_goal && std::exchange(plan_looked_at_, plan_->sequence) != plan_->sequence) look(t);
  if (new_scan && motion_) decide(t);
  if (new_scan && shared_) shared_->decide(seen(t), stick_for_motion(t), driven_);
  t.plan_asked = new_scan && t.input.has_goal && !planner_.is_busy() && (!motion_ || age(asked_, now) >= kPlanEvery);
  if (t.plan_asked) asked_ = now, planner_.submit(request(t));  // Ask for the next, now that the wheels have theirs.
  recorder_.commit();
  return t;
}

void ControlLoop::note_plan(TickRecord& t) noexcept {
  t.plan_sequence = plan_->sequence;
  t.plan_status = plan_->status;
  if (std::exchange(plan_noted_, plan_->sequence) != plan_->sequence) keep_path(*plan_, t.path);
  if (is_steered(t)) {
    good_plan_stamp_ = shared_->seen();
  } else if (drives_by_motion()) {
    good_plan_stamp_ = std::min(motion_->decision().seen, plan_->stamp);
  } else if (plan_->status == PlanStatus::kOk) {
    good_plan_stamp_ = plan_->stamp;
  }
  if (setup_.keeps_speed() && plan_->status != PlanStatus::kOk)
    good_plan_stamp_ = kNever;  // without a path it would go straight on; others ramp down by themselves
  t.plan_stamp = good_plan_stamp_;
}

bool ControlLoop::goal_for_motion(const TickRecord& t) const noexcept {
  return t.input.has_goal && (supervisor_.takes_wishes() || !setup_.applies_verdict());
}

Stick ControlLoop::stick_for_motion(const TickRecord& t) const noexcept {
  return supervisor_.takes_wishes() ? t.input.stick : Stick{};
}

FollowerInput ControlLoop::follower_input(const TickRecord& t) const noexcept {
  return {.path = plan_->path,
          .map_from_robot = t.pose.map_from_robot,
          .goal_in_map = t.input.goal_in_map,
          .has_goal = goal_for_motion(t),
          .tracks = tracker().tracks(),
          .standing = tracker().standing(),
          .most_speed_mps = zone_speed_.ahead_mps,
          .permitted_before = driven_,
          .guide = guide_.get(),
          .turn = turn_.get()};
}

void ControlLoop::look(const TickRecord& t) noexcept {
  const GuideInput input{.path = plan_->path,
                         .map_from_robot = t.pose.map_from_robot,
                         .wanted = t.wanted,
                         .driven = driven_,
                         .still = tracker().still(),
                         .standing = tracker().standing(),
                         .moving = tracker().moving(),
                         .goal_in_map = t.input.goal_in_map,
                         .keep_out = view_of(keep_out_),
                         .somebody_hidden = tracker().hides_somebody(t.pose.map_from_robot.position(), kNear_m),
                         .now = t.now};
  if (turns_at_goal()) {
    turn_->look(input);
    if (guide_) guide_->manoeuvre().stop();
  } else if (guide_) {
    guide_->look(input);
  }
}

void ControlLoop::limit_wishes(double most_mps) noexcept {
  if (motion_) motion_->limit_speed(most_mps, driven_.v_mps);
  if (shared_) shared_->limit_speed(most_mps);
}

Twist2 ControlLoop::motion_twist(const TickRecord& t) noexcept {
  const auto wish = [&](auto& who) {
    return who.twist(t.now, goal_for_motion(t), t.pose.map_from_robot, t.input.goal_in_map, driven_);
  };
  return baseline_ ? wish(*baseline_) : wish(*motion_);
}

void ControlLoop::decide(const TickRecord& t) noexcept {
  const motion::MotionInput input{.seen = seen(t),
                                  .goal_in_map = t.input.goal_in_map,
                                  .has_goal = goal_for_motion(t) && age(plan_->stamp, t.now) < kGuideHoldsFor};
  motion_->decide(input, driven_);  // also beside a baseline: walls are told from pedestrians there
  if (baseline_) baseline_->decide(input, driven_);
}

motion::Seen ControlLoop::seen(const TickRecord& t) const noexcept {
  return {.now = t.now,
          .stamp = t.scan.stamp,
          .map_from_robot = t.pose.map_from_robot,
          .tracks = tracker().tracks(),
          .standing = tracker().standing(),
          .still = tracker().still(),
          .scan = t.scan,
          .map_from_laser = estimator_.map_from_robot_at_scan() * setup_.model.laser.robot_from_laser,
          .guide = plan_->guide};
}

PlanRequest ControlLoop::request(const TickRecord& t) const noexcept {
  if (motion_) {
    return {.stamp = t.scan.stamp,
            .map_from_robot = t.pose.map_from_robot,
            .goal_in_map = t.input.goal_in_map,
            .speed_mps = setup_.model.limits.max_speed_mps,
            .still = &tracker().still(),
            .masked = motion_->memory().masked(),
            .wants_potential = false};
  }
  return {.stamp = t.scan.stamp,
          .map_from_robot = t.pose.map_from_robot,
          .goal_in_map = t.input.goal_in_map,
          .speed_mps = setup_.model.limits.max_speed_mps,
          .still = &tracker().still(),
          .moving = tracker().moving(),
          .standing = tracker().standing(),
          .body = setup_.guides_body() ? &setup_.model.footprint : nullptr};
}

}  // namespace jaywalk
