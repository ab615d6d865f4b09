#include "firmware/safety/supervisor.h"

#include <cmath>

namespace jaywalk {
namespace {

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

double times_to_limits(const Twist2& twist, const MotionLimits& limits) {
  constexpr double kLeast = 1e-9;  // of what hardly moves
  return std::min(limits.max_speed_mps / std::max(std::fabs(twist.v_mps), kLeast),
                  limits.max_turn_radps / std::max(std::fabs(twist.w_radps), kLeast));
}

constexpr Duration kOldestPlan = std::chrono::milliseconds(1000);  // older: standstill
constexpr Duration kSlowingPlan = std::chrono::milliseconds(300);  // older: the slower the older
constexpr double kUnwatched_mps = 0.3;                             // SAFETY: where nothing watches the way

/// Share of the limits that a plan of that age is good for.
double plan_share(Time plan_stamp, Time now) {
  if (!is_older(plan_stamp, now, kSlowingPlan)) return 1.0;
  if (is_older(plan_stamp, now, kOldestPlan)) return 0.0;
  return to_seconds(kOldestPlan - age(plan_stamp, now)) / to_seconds(kOldestPlan - kSlowingPlan);
}

constexpr double kPlannersReach_m = 3.0;  // beyond the stop zone's: motion keeps off unseen walls early

}  // namespace

Supervisor::Supervisor(const SupervisorConfig& config)
    : config_(config),
      stop_zone_(stop_zone_for(config.model, config.tick)),
      watch_(config.model.footprint, StopZoneConfig{}.margin_m),
      unseen_walls_(config.model.footprint, stop_zone_.reach_m() + kPlannersReach_m),
      mode_(config.latches_all ? Mode::kStandby : Mode::kArmed) {
  for (const LaserModel& laser : config.model.lasers()) {
    scanners_.push_back({laser,
                         ScanTiming(laser.rate_hz),
                         {},
                         MotionModel(config.model, scanners_.size()),
                         WheelProof(config.model, scanners_.size())});
    gaps_.emplace_back(laser);
  }
}

Verdict Supervisor::judge(const Twist2& wanted, const SafetyInput& input) noexcept {
  Verdict verdict;
  verdict.gap_m = std::numeric_limits<double>::infinity();
  verdict.reasons = faults(wanted, input);
  verdict.faulty_scanners = faulty_;
  update_mode(verdict.reasons, wanted, input);
  if (mode_ == Mode::kLatched) verdict.reasons |= Reason::kLatched;
  const bool stop = verdict.reasons != Reason::kNone || !takes_wishes();
  if (!input.input.wants_motion()) verdict.reasons |= Reason::kNoGoal;
  const Twist2 target = stop ? Twist2{} : limited(wanted, input, verdict);
  permitted_ = braked(target);
  verdict.permitted = permitted_;
  return verdict;
}

Reason Supervisor::faults(const Twist2& wanted, const SafetyInput& input) noexcept {
  Reason reasons = scan_faults(input) | wheel_faults(input);
  if (input.input.emergency_stop) reasons |= Reason::kEmergencyStop;
  if (input.pose_doubtful) reasons |= Reason::kPoseDoubtful;
  if (missed_in_a_row(input.now) >= 2) reasons |= Reason::kMissedTicks;
  if (!std::isfinite(wanted.v_mps) || !std::isfinite(wanted.w_radps)) reasons |= Reason::kNotFinite;
  return reasons;
}

Reason Supervisor::scan_faults(const SafetyInput& input) noexcept {
  constexpr Reason kOfScanner = Reason::kScanStale | Reason::kScanInvalid | Reason::kScanFrozen | Reason::kSightLost;
  Reason reasons = Reason::kNone;
  faulty_ = 0;
  for (std::size_t k = 0; k < scanners_.size(); ++k) {
    const Reason own = faults_of(k, input);
    if (scanners_.size() > 1 && has(own, kOfScanner)) faulty_ = static_cast<std::uint8_t>(faulty_ | (1U << k));
    reasons |= own;
  }
  unseen_walls_.update(input.scans, gaps(), input.known_walls, input.known_ground);
  return reasons;
}

Reason Supervisor::faults_of(std::size_t scanner, const SafetyInput& input) noexcept {
  constexpr Reason kNeedObedience = Reason::kWheelsDisobey | Reason::kMotionMismatch;
  Scanner& judged = scanners_[scanner];
  const LaserScan& scan = input.scans[scanner];
  Reason reasons = judged.motion.judge(scan, input.wheels, input.sent, input.now);
  if (mode_ == Mode::kStandby) judged.wheel_proof.begin();
  if (config_.proves_wheels && judged.wheel_proof.contradicts(scan, input.wheels)) reasons |= Reason::kMotionMismatch;
  if (!config_.judges_motion) reasons = without(reasons, kNeedObedience);
  if (judged.timing.is_stale(scan, input.now)) reasons |= Reason::kScanStale;
  if (scan.sequence > 0 && !is_trustworthy(scan, judged.laser)) reasons |= Reason::kScanInvalid;
  gaps_[scanner].update(scan);
  if (judged.sight_loss.is_lost(gaps_[scanner].counts(), input.now)) reasons |= Reason::kSightLost;
  return reasons;
}

Reason Supervisor::wheel_faults(const SafetyInput& input) const noexcept {
  const WheelState& wheels = input.wheels;
  Reason reasons = reason_for(wheels.trouble);
  // Drives that are being proved report nothing yet, and have no torque.
  if (config_.needs_wheels && wheels.ready &&
      is_older(wheels.stamp, input.now, oldest_wheels(config_.model.drive.times, config_.tick)))
    reasons |= Reason::kWheelsStale;
  if (!is_trustworthy(wheels)) reasons |= Reason::kWheelsInvalid;
  // Feedback, read once a tick, that follows the commands later than a sound drive's is old, whatever its stamp says.
  const double sound_s = config_.model.drive.times.obeyed_within_s() + to_seconds(config_.tick);
  if (config_.judges_motion && input.latency.drive_s > sound_s) reasons |= Reason::kWheelsDisobey;
  return reasons;
}

/// Slowly until one of the scanners showed that the wheels go as far as they say.
double Supervisor::unproved_share(const Twist2& twist) const noexcept {
  const auto is_over = [](const Scanner& scanner) { return scanner.wheel_proof.is_over(); };
  if (!config_.proves_wheels || std::any_of(scanners_.begin(), scanners_.end(), is_over)) return 1.0;
  double most_mps = 0.0;
  for (const Scanner& scanner : scanners_) most_mps = std::max(most_mps, scanner.wheel_proof.most_mps());
  const double wheel_mps = std::fabs(twist.v_mps) + 0.5 * config_.model.drive.track_width_m * std::fabs(twist.w_radps);
  return most_mps / std::max(wheel_mps, most_mps);
}

int Supervisor::missed_in_a_row(Time now) noexcept {
  const Duration late = judged_ == kNever ? Duration{0} : now - judged_ - config_.tick / 2;
  judged_ = now;
  const auto skipped = static_cast<int>(std::clamp<std::int64_t>(late / config_.tick, 0, 1000));
  missed_ = skipped == 0 ? 0 : std::min(missed_ + skipped, 1000);
  return missed_;
}

void Supervisor::update_mode(Reason faults, const Twist2& wanted, const SafetyInput& input) noexcept {
  const bool reset_edge = input.input.reset && !reset_before_;
  reset_before_ = input.input.reset;
  bool seen_all = input.wheels.sequence > 0;
  for (const LaserScan& scan : input.scans) seen_all = seen_all && scan.sequence > 0;
  mode_ = next_mode(
      mode_, {.fault = faults != Reason::kNone,
              .latches = has(faults, kAlwaysLatched) || (config_.latches_all && seen_all && faults != Reason::kNone),
              .stop_pressed = input.input.emergency_stop,
              .reset_edge = reset_edge,
              .wants_zero = wanted == Twist2{} && input.input.stick.is_centred(),
              .drives_ready = input.wheels.ready,
              .has_goal = input.input.wants_motion(),
              .at_goal = input.at_goal,
              .at_rest = permitted_ == Twist2{}});
}

Twist2 Supervisor::limited(Twist2 twist, const SafetyInput& input, Verdict& verdict) noexcept {
  const MotionLimits& limits = config_.model.limits;
  const auto at_most = [&](double share, Reason reason) {
    if (share >= 1.0) return;
    share = std::max(share, 0.0);
    twist = {twist.v_mps * share, twist.w_radps * share};
    verdict.reasons |= reason;
  };
  at_most(share_within(twist, limits, 1.0), Reason::kSpeedLimit);
  at_most(unproved_share(twist), Reason::kSpeedLimit);
  at_most(input.most_speed_mps / std::max(std::fabs(twist.v_mps), 1e-9), Reason::kSpeedZone);
  const double reaction = reaction_s(input.scans, config_.model, input.now, config_.tick, input.latency);
  at_most(watched_share(twist, reaction), Reason::kUnwatched);
  at_most(proven_share(twist, reaction), Reason::kUnwatched);
  const double fresh = plan_share(input.plan_stamp, input.now);  // of the limits: shares of what is wanted add up
  if (fresh < 1.0) verdict.reasons |= Reason::kPlanStale;
  at_most(share_within(twist, limits, fresh), Reason::kPlanStale);
  verdict.gap_m = stop_zone_.gap_m(input.scans, twist, unseen_walls_.points());
  const double rim_speed = stop_zone_.rim_speed_mps(twist);
  double stops_from_mps = stop_zone_.speed_to_stop_within(verdict.gap_m, reaction);
  const double creep_mps = std::min(rim_speed, StopZoneRules<double>::kCreep_mps);
  if (stops_from_mps < creep_mps && stop_zone_.may_creep(input.scans, twist, unseen_walls_.points(), reaction))
    stops_from_mps = creep_mps;
  if (rim_speed > 0.0) at_most(stops_from_mps / rim_speed, Reason::kStopZone);
  for (const LaserScan& scan : input.scans)
    if (verdict.gap_m == 0.0 && stop_zone_.beams_on_body(scan) > 0) verdict.reasons |= Reason::kTouched;
  return twist;
}

/// Slowly where no laser ever looks: each part of the body that goes there.
double Supervisor::watched_share(const Twist2& twist, double reaction_s) const noexcept {
  const double rim_mps = stop_zone_.rim_speed_mps(twist);
  if (rim_mps <= kUnwatched_mps) return 1.0;
  const bool has_blanked = std::ranges::any_of(gaps_, &BlindGaps::has_blanked);
  const SweptPath path(twist, rim_mps, has_blanked ? stop_zone_.stopping_distance_m(rim_mps, reaction_s) : 0.0);
  return kUnwatched_mps / std::max(watch_.unwatched_mps(gaps(), twist, path), kUnwatched_mps);
}

/// Slowly where the way that it takes to stop enters what lost beams could hide, and so that it stops before that. Once
/// it does so, the way from its fastest counts: it would speed up and brake again and again.
double Supervisor::proven_share(const Twist2& twist, double reaction_s) noexcept {
  const double rim_mps = stop_zone_.rim_speed_mps(twist);
  if (rim_mps < 1e-9) return 1.0;
  const double judged_mps = lost_ahead_ ? rim_mps * times_to_limits(twist, config_.model.limits) : rim_mps;
  const SweptPath path(twist, rim_mps, stop_zone_.stopping_distance_m(judged_mps, reaction_s));
  const double way_m = watch_.way_to_lost_m(gaps(), twist, path, stop_zone_.margin_at(rim_mps));
  lost_ahead_ = std::isfinite(way_m);
  if (!lost_ahead_) return 1.0;
  return std::min(kUnwatched_mps, stop_zone_.speed_to_stop_within(way_m, reaction_s)) / rim_mps;
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

Reason reason_named(std::string_view name) noexcept {
  Reason named = Reason::kNone;
  for (const ReasonRow& row : kReasons)
    if (row.name == name) named = row.reason;
  return named;
}

std::string to_string(Reason reasons) {
  std::string words;
  for (const ReasonRow& row : kReasons)
    if (has(reasons, row.reason)) words += (words.empty() ? "" : "|") + std::string(row.name);
  return words;
}

std::string to_string(Reason reasons, std::uint8_t faulty_scanners) {
  std::string words = to_string(reasons);
  for (int number = 1, left = faulty_scanners; left != 0; ++number, left >>= 1) {
    if ((left & 1) != 0) words += (words.empty() ? "scanner_" : "|scanner_") + std::to_string(number);
  }
  return words;
}

}  // namespace jaywalk
