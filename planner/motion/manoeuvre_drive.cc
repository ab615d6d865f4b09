#include "planner/motion/manoeuvre_drive.h"

#include <algorithm>
#include <cmath>

#include "planner/motion/twist_ramp.h"

namespace jaywalk {
namespace {

constexpr double kForward_mps = 0.35, kCreep_mps = 0.15;  // slower, the less room there is:
constexpr double kPerRoom_per_s = 1.5;
constexpr double kBackward_mps = 0.25;  // where nothing watches; the supervisor permits 0.3
constexpr double kTurnGain_per_s = 2.0;
constexpr double kTurned_rad = 0.03;
constexpr double kArrived_m = 0.015;
constexpr std::size_t kTurnAhead = 6;  // steps of 7.5 degrees: the turn stays on its side
// Errors die away within 0.4 m of travel without swinging: y'' + kTowards y' + kAcross y = 0, kTowards^2 = 4 kAcross.
constexpr double kAcross_per_m2 = 6.0, kTowards_per_m = 4.9;
constexpr double kTightest_per_m = 4.0;

}  // namespace

void ManoeuvreDrive::begin(const Manoeuvre& manoeuvre, Steering steering, End end) noexcept {
  manoeuvre_ = manoeuvre;
  steering_ = steering;
  end_ = end;
  at_ = 1;
  places_.clear();
  looking_.clear();
  for (const ManoeuvreStep& step : manoeuvre_) {
    (void)places_.push_back(step.map_from_robot.position());
    (void)looking_.push_back(direction(step.map_from_robot.heading));
  }
}

std::size_t ManoeuvreDrive::end_of_gear() const noexcept {
  std::size_t last = at_;
  while (last + 1 < manoeuvre_.size() && manoeuvre_[last + 1].gear == manoeuvre_[at_].gear) ++last;
  return last;
}

Twist2 ManoeuvreDrive::command(const Pose2& here) noexcept {
  while (active()) {
    const std::size_t before = at_;
    const Twist2 twist = manoeuvre_[at_].gear == Gear::kTurn ? turn(here) : drive(here);
    if (at_ == before || (active() && manoeuvre_[at_].gear == manoeuvre_[before].gear)) return twist;
  }
  return {};
}

Twist2 ManoeuvreDrive::turn(const Pose2& here) noexcept {
  const std::size_t last = end_of_gear();
  const auto error = [&](std::size_t k) { return wrap_angle(manoeuvre_[k].map_from_robot.heading - here.heading); };
  while (at_ < last && std::fabs(error(at_)) < 2.0 * kTurned_rad) ++at_;
  if (at_ == last && std::fabs(error(last)) < kTurned_rad) at_ = last + 1;
  const double target = kTurnGain_per_s * error(std::min(at_ + kTurnAhead, last));
  return {0.0, std::clamp(target, -limits_.max_turn_radps, limits_.max_turn_radps)};
}

Twist2 ManoeuvreDrive::drive(const Pose2& here) noexcept {
  const std::size_t last = end_of_gear();
  const double sign = manoeuvre_[at_].gear == Gear::kForward ? 1.0 : -1.0;
  const auto in_step = [&](std::size_t k) { return inverse(manoeuvre_[k].map_from_robot) * here.position(); };
  const auto left_to = [&](std::size_t k) { return -sign * in_step(k).x; };
  while (at_ < last && left_to(at_) <= 0.0) ++at_;
  const ManoeuvreStep& step = manoeuvre_[at_];
  const double left = left_to(at_), bend = step.curvature_per_m;
  const bool leads_on = end_ == End::kOnward && sign > 0.0 && last + 1 == manoeuvre_.size();
  double to_end = left;
  for (std::size_t k = at_; k < last; ++k) {
    to_end += distance(manoeuvre_[k].map_from_robot.position(), manoeuvre_[k + 1].map_from_robot.position());
  }
  // The arc that ends in the step's pose, `left` before its end: heading and place across.
  const double across = in_step(at_).y - sign * bend * left * left / 2.0;
  const double towards = wrap_angle(here.heading - (step.map_from_robot.heading - bend * left));
  const double turn =
      std::clamp(bend - kAcross_per_m2 * sign * across - kTowards_per_m * towards, -kTightest_per_m, kTightest_per_m);
  const double most = sign > 0.0 ? kForward_mps : kBackward_mps;
  double speed = std::clamp(kPerRoom_per_s * step.clearance_m, kCreep_mps, most);
  speed = std::min(speed, limits_.max_turn_radps / std::max(std::fabs(turn), 1e-6));
  if (!leads_on) speed = std::min(speed, slowing_speed(0.0, std::max(to_end, 0.0), limits_.max_accel_mps2));
  if (to_end < kArrived_m) at_ = last + 1;
  return {sign * speed, steering_ == Steering::kHeld ? 0.0 : turn * speed};
}

double ManoeuvreDrive::off_by(const Pose2& here) const noexcept {
  if (!active()) return 0.0;
  const Vec2 p = here.position();
  const double to_next = distance(p, manoeuvre_[at_].map_from_robot.position());
  const double to_last = at_ == 0 ? to_next : distance(p, manoeuvre_[at_ - 1].map_from_robot.position());
  return std::min(to_next, to_last);
}

double ManoeuvreDrive::least_kept_m(double margin_m) const noexcept {
  constexpr double kDrift_m = 0.01;  // surfaces move by as much as scans come in
  return active() ? std::min(margin_m, manoeuvre_[0].clearance_m - kDrift_m) : margin_m;
}

double ManoeuvreDrive::clearance_left(const BodyMap& map) const noexcept {
  double least = BodyMap::kFar_m;
  for (std::size_t k = at_; k < manoeuvre_.size(); ++k) {
    least = std::min(least, map.clearance(manoeuvre_[k].map_from_robot));
  }
  return least;
}

}  // namespace jaywalk
