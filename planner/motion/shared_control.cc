#include "planner/motion/shared_control.h"

#include <algorithm>
#include <cmath>

#include "planner/motion/attempts.h"

namespace jaywalk::motion {
namespace {

constexpr float kLeastGain = 0.05F;  ///< s: what bends aside does so until another is better by this
constexpr int kRounds = 2, kPerturbed = 24;
constexpr float kNever_s = 1e9F;

bool rests(const Command& command) { return command.v == 0.0F && command.w == 0.0F; }

/// No faster than asked, and not the other way.
float at_most(float speed, float asked) { return std::clamp(speed, std::min(asked, 0.0F), std::max(asked, 0.0F)); }

}  // namespace

SharedControl::SharedControl(const MotionConfig& config, bool assisted)
    : limits_(config.limits),
      body_(robot_body(config.footprint, config.limits, config.laser, config.berth_m)),
      assisted_(assisted),
      tick_s_(static_cast<float>(config.tick_s)),
      ground_(config.keep_out),
      futures_(std::make_unique<Futures>()) {}

void SharedControl::decide(const Seen& seen, const Stick& stick, const Twist2& driven) noexcept {
  if (!finite(seen.map_from_robot)) return;
  memory_.update({seen.now, seen.stamp, seen.map_from_robot, seen.tracks, seen.standing, seen.still, seen.scan,
                  seen.map_from_laser, ground_.guide()});
  const Guide& guide = ground_.look(seen.still, seen.map_from_robot.position(), memory_.masked());
  seen_ = seen.stamp;
  const Command asked = body_.blind.slowed(wished(stick, body_.bounds));
  if (!assisted_ || rests(asked)) return void(decided_ = kNever);
  ++number_;
  futures_->draw(memory_.beliefs(), memory_.hidden(), memory_.turning(), guide, number_);
  RobotState now{static_cast<float>(seen.map_from_robot.x),
                 static_cast<float>(seen.map_from_robot.y),
                 static_cast<float>(seen.map_from_robot.heading),
                 static_cast<float>(driven.v_mps),
                 static_cast<float>(driven.w_radps),
                 0.0F};
  now = moved(now, {now.v, now.w}, body_.bounds, kLagS);
  now.accel = accel_;
  returns_.look(seen.scan, seen.map_from_laser, now, body_, memory_.masked());
  const WishedWay way = drive_wish(now, asked, body_.bounds);
  Situation situation{body_, guide, *futures_, returns_, now, {}, 0.0F, {}, 0.0F, &way};
  const bool may_go_on = decided_ != kNever && seen.now - decided_ < kHoldsFor;
  choose(situation, may_go_on, static_cast<float>(to_seconds(seen.now - decided_)));
  asked_ = asked;
  decided_ = seen.now;
}

void SharedControl::choose(const Situation& situation, bool may_go_on, float gone_s) noexcept {
  best_cost_ = kNever_s;
  best_shape_ = {};
  for (int n = 0; n < shape_count(); ++n) try_shape(situation, shape_at(n, body_.bounds));
  for (int round = 0; round < kRounds; ++round) {
    const WishShape base = best_shape_;
    for (int n = 0; n < kPerturbed; ++n) try_shape(situation, perturbed(base, number_, round, n, body_.bounds));
  }
  const bool is_wish = best_shape_.aside == 0.0F && best_shape_.share == 1.0F && best_shape_.turn_share == 1.0F;
  if (may_go_on && !is_wish) {
    trial_ = shifted(chosen_, gone_s);
    if (judge(situation, trial_, best_cost_ + kLeastGain).total() < best_cost_ + kLeastGain) best_ = trial_;
  }
  chosen_ = best_;
}

void SharedControl::try_shape(const Situation& situation, const WishShape& shape) noexcept {
  make(shape, situation.wish->command, situation.start, body_.bounds, trial_);
  const float cost = judge(situation, trial_, best_cost_).total();
  if (cost < best_cost_) best_ = trial_, best_shape_ = shape, best_cost_ = cost;
}

Command SharedControl::decided_at(Time now, const Command& asked) const noexcept {
  if (decided_ == kNever || now - decided_ > kHoldsFor) return {};
  const auto step = static_cast<int>(to_seconds(now - decided_) / static_cast<double>(kStepS));
  const Command command = chosen_.commands[static_cast<std::size_t>(std::clamp(step, 0, kSteps - 1))];
  return within(body_.bounds, {at_most(command.v, asked.v), command.w});
}

Twist2 SharedControl::asked(const Stick& stick) const noexcept {
  const Command command = wished(stick, body_.bounds);
  return {static_cast<double>(command.v), static_cast<double>(command.w)};
}

Twist2 SharedControl::twist(Time now, const Stick& stick, const Twist2& permitted) noexcept {
  const RobotState was{0.0F,
                       0.0F,
                       0.0F,
                       static_cast<float>(permitted.v_mps),
                       static_cast<float>(permitted.w_radps),
                       std::fabs(static_cast<float>(permitted.v_mps) - wished_.v) > 1e-4F ? 0.0F : accel_};
  const Command asked = wished(stick, body_.bounds);
  const Command to = assisted_ ? decided_at(now, asked) : asked;
  const bool stops = rests(asked) || rests(to);
  const RobotState next = stops ? slowed(was, body_.bounds, tick_s_) : moved(was, to, body_.bounds, tick_s_);
  accel_ = next.accel;
  wished_ = {next.v, next.w};
  if (stops && std::fabs(next.v) < 1e-6F && std::fabs(next.w) < 1e-6F) return wished_ = {}, Twist2{};
  return {static_cast<double>(next.v), static_cast<double>(next.w)};
}

}  // namespace jaywalk::motion
