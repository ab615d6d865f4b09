#include "firmware/safety/supervisor.h"

#include <algorithm>
#include <cmath>

#include "firmware/safety/trust.h"

namespace jaywalk {
namespace {

StopZoneConfig zone_config(const SupervisorConfig& config) {
  // The oldest scan that is still accepted is 1.5 periods old.
  const double scan_s = 1.5 / config.model.laser.rate_hz;
  return {.footprint = config.model.footprint,
          .robot_from_laser = config.model.laser.robot_from_laser,
          .brake_mps2 = config.model.limits.brake_mps2,
          .reaction_s = scan_s + config.control_and_drive_s};
}

Reason reason_for(DriveTrouble trouble) {
  if (trouble == DriveTrouble::kNone) return Reason::kNone;
  if (trouble == DriveTrouble::kForeignMaster) return Reason::kForeignMaster;
  if (trouble == DriveTrouble::kStopUnconfirmed) return Reason::kStopUnconfirmed;
  const bool is_bus = trouble == DriveTrouble::kBusRefused || trouble == DriveTrouble::kBusUnwell;
  return is_bus ? Reason::kBus : Reason::kDrive;
}

/// What share of a twist lies within `fresh` of the limits.
double share_within(const Twist2& twist, const MotionLimits& limits, double fresh) {
  const double v = fresh * limits.max_speed_mps, w = fresh * limits.max_turn_radps;
  double share = 1.0;
  if (std::fabs(twist.v_mps) > v + 1e-9) share = v / std::fabs(twist.v_mps);
  if (std::fabs(twist.w_radps) > w + 1e-9) share = std::min(share, w / std::fabs(twist.w_radps));
  return share;
}

Twist2 scaled(const Twist2& twist, double share) { return {twist.v_mps * share, twist.w_radps * share}; }

/// Whether the direction lies between the scan's first beam and its last, in the laser's frame.
bool sweeps_over(const LaserScan& scan, double way) {
  const double from_first = wrap_angle(way - scan.angle_rad(0)) * (scan.angle_step_rad < 0.0F ? -1.0 : 1.0);
  const double past_first = from_first < -1e-6 ? from_first + 2 * kPi : from_first;
  return past_first <= std::fabs(static_cast<double>(scan.angle_step_rad)) * scan.beam_count;
}

/// Whether a part of the robot's own that is wider than 3 degrees, half a shin at a metre, hides what comes from within
/// 45 degrees of that way.
bool hides_a_shin(const Blanking& blanked, double way) {
  constexpr double kNarrow_rad = 3.0 * kPi / 180.0, kBeside_rad = 0.25 * kPi;
  return std::any_of(blanked.begin(), blanked.end(), [way](const BlankedSector& sector) {
    return sector.width_rad() > kNarrow_rad && sector.off_rad(way) < kBeside_rad;
  });
}

}  // namespace

Supervisor::Supervisor(const SupervisorConfig& config)
    : config_(config),
      stop_zone_(zone_config(config)),
      frozen_scan_(config.model.drive),
      felt_motion_(config.model.drive, config.model.limits.brake_mps2),
      seen_motion_(config.model) {}

Verdict Supervisor::judge(const Twist2& wanted, const SafetyInput& input) noexcept {
  Verdict verdict;
  verdict.gap_m = std::numeric_limits<double>::infinity();
  verdict.reasons = faults(wanted, input);
  update_latch(verdict.reasons, wanted, input);
  if (latched_) verdict.reasons |= Reason::kLatched;
  const bool stop = verdict.reasons != Reason::kNone;
  if (!input.input.has_goal) verdict.reasons |= Reason::kNoGoal;
  const Twist2 target = stop ? Twist2{} : limited(wanted, input, verdict);
  permitted_ = braked(target);
  verdict.permitted = permitted_;
  return verdict;
}

Reason Supervisor::faults(const Twist2& wanted, const SafetyInput& input) noexcept {
  Reason reasons = scan_faults(input) | wheel_faults(input.wheels, input.now);
  if (config_.judges_motion) reasons |= motion_faults(input);
  if (input.input.emergency_stop) reasons |= Reason::kEmergencyStop;
  if (missed_in_a_row(input.now) >= 2) reasons |= Reason::kMissedTicks;
  if (!std::isfinite(wanted.v_mps) || !std::isfinite(wanted.w_radps)) reasons |= Reason::kNotFinite;
  return reasons;
}

Reason Supervisor::scan_faults(const SafetyInput& input) noexcept {
  Reason reasons = Reason::kNone;
  // A scan is as old as its last beam; the stop zone reckons with the first.
  const Duration limit = duration_from_seconds(1.5 / config_.model.laser.rate_hz) + sweep_of(input.scan);
  stale_scans_ = is_older(input.scan.stamp, input.now, limit) ? stale_scans_ + 1 : 0;
  if (stale_scans_ >= 2) reasons |= Reason::kScanStale;
  if (input.scan.sequence > 0 && !is_trustworthy(input.scan, config_.model.laser)) reasons |= Reason::kScanInvalid;
  if (frozen_scan_.is_frozen(input.scan, input.wheels)) reasons |= Reason::kScanFrozen;
  return reasons;
}

Reason Supervisor::wheel_faults(const WheelState& wheels, Time now) const noexcept {
  Reason reasons = reason_for(wheels.trouble);
  if (config_.needs_wheels && is_older(wheels.stamp, now, config_.max_wheel_age)) reasons |= Reason::kWheelsStale;
  if (!is_trustworthy(wheels)) reasons |= Reason::kWheelsInvalid;
  return reasons;
}

Reason Supervisor::motion_faults(const SafetyInput& input) noexcept {
  Reason reasons = Reason::kNone;
  if (felt_motion_.disobeys(input.sent, input.wheels, input.now)) reasons |= Reason::kWheelsDisobey;
  if (seen_motion_.contradicts(input.scan, input.wheels, input.now)) reasons |= Reason::kMotionMismatch;
  return reasons;
}

/// What a scan says it took, within reason: two turns.
Duration Supervisor::sweep_of(const LaserScan& scan) const noexcept {
  return std::clamp(scan.sweep, Duration{0}, duration_from_seconds(2.0 / config_.model.laser.rate_hz));
}

int Supervisor::missed_in_a_row(Time now) noexcept {
  const Duration late = judged_ == kNever ? Duration{0} : now - judged_ - config_.tick / 2;
  judged_ = now;
  const auto skipped = static_cast<int>(std::clamp<std::int64_t>(late / config_.tick, 0, 1000));
  missed_ = skipped == 0 ? 0 : std::min(missed_ + skipped, 1000);
  return missed_;
}

void Supervisor::update_latch(Reason faults, const Twist2& wanted, const SafetyInput& input) noexcept {
  constexpr Reason kAlways = Reason::kEmergencyStop | Reason::kBus | Reason::kDrive | Reason::kMissedTicks |
                             Reason::kStopUnconfirmed | Reason::kForeignMaster | Reason::kWheelsDisobey |
                             Reason::kMotionMismatch;
  const bool reset_edge = input.input.reset && !reset_before_;
  reset_before_ = input.input.reset;
  const bool seen_all = input.scan.sequence > 0 && input.wheels.sequence > 0;
  if (has(faults, kAlways) || (config_.latches_all && seen_all && faults != Reason::kNone)) latched_ = true;
  // A fault that is still there latches again in the next tick.
  if (latched_ && reset_edge && !input.input.emergency_stop && wanted == Twist2{}) latched_ = false;
}

Twist2 Supervisor::limited(Twist2 twist, const SafetyInput& input, Verdict& verdict) const noexcept {
  const MotionLimits& limits = config_.model.limits;
  const auto at_most = [&](double share, Reason reason) {
    if (share >= 1.0) return;
    twist = scaled(twist, std::max(share, 0.0));
    verdict.reasons |= reason;
  };
  at_most(share_within(twist, limits, 1.0), Reason::kSpeedLimit);
  at_most(watched_share(input.scan, twist), Reason::kUnwatched);
  const double fresh = plan_share(input.plan_stamp, input.now);  // of the limits: shares of what is wanted add up
  if (fresh < 1.0) verdict.reasons |= Reason::kPlanStale;
  at_most(share_within(twist, limits, fresh), Reason::kPlanStale);
  verdict.gap_m = stop_zone_.gap_m(input.scan, twist);
  const double rim_speed = stop_zone_.rim_speed_mps(twist);
  if (rim_speed > 0.0)
    at_most(stop_zone_.speed_to_stop_within(verdict.gap_m, sweep_of(input.scan)) / rim_speed, Reason::kStopZone);
  if (verdict.gap_m == 0.0 && stop_zone_.beams_on_body(input.scan) > 0) verdict.reasons |= Reason::kTouched;
  return twist;
}

double Supervisor::plan_share(Time plan_stamp, Time now) const noexcept {
  if (!is_older(plan_stamp, now, config_.slow_plan_age)) return 1.0;
  if (is_older(plan_stamp, now, config_.max_plan_age)) return 0.0;
  const Duration old = age(plan_stamp, now);
  return to_seconds(config_.max_plan_age - old) / to_seconds(config_.max_plan_age - config_.slow_plan_age);
}

/// Slowly where nothing looks: the way it goes, and beside it, where its corners swing round.
double Supervisor::watched_share(const LaserScan& scan, const Twist2& twist) const noexcept {
  constexpr double kBesideRad = 2.0 * kPi / 3.0 - 0.01;  // scanners of 240 degrees see it, those of 180 do not
  double blind_mps = 0.0;
  if (!watched(scan, twist.v_mps >= 0.0 ? 0.0 : kPi)) blind_mps = std::fabs(twist.v_mps);
  if (!watched(scan, kBesideRad) || !watched(scan, -kBesideRad))
    blind_mps = std::max(blind_mps, std::fabs(twist.w_radps) * config_.model.footprint.circumscribed_radius_m());
  return std::min(1.0, config_.unwatched_speed_mps / std::max(blind_mps, 1e-9));
}

/// Whether beams look that way, in the robot's frame: 0 is ahead.
bool Supervisor::watched(const LaserScan& scan, double way) const noexcept {
  const LaserModel& laser = config_.model.laser;
  const double in_laser = wrap_angle(way - laser.robot_from_laser.heading);
  return sweeps_over(scan, in_laser) && !hides_a_shin(laser.blanked, in_laser);
}

Twist2 Supervisor::braked(const Twist2& target) const noexcept {
  // Never slower to slow down than the drive can follow; a target below keeps the curve while braking.
  const double fastest_drop = config_.model.limits.brake_mps2 * to_seconds(config_.tick);
  const double v_before = permitted_.v_mps;
  const bool braking = std::fabs(target.v_mps) < std::fabs(v_before) - fastest_drop || target.v_mps * v_before < 0.0;
  if (!braking) return target;
  const double v = v_before > 0.0 ? std::max(v_before - fastest_drop, 0.0) : std::min(v_before + fastest_drop, 0.0);
  const double curvature = permitted_.w_radps / v_before;
  return {v, curvature * v};  // the arc that the stop zone looked along
}

}  // namespace jaywalk
