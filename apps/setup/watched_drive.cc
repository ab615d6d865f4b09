#include "apps/setup/watched_drive.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "apps/setup/calibration.h"
#include "firmware/safety/felt_motion.h"
#include "firmware/safety/latency.h"
#include "firmware/safety/stop_zone.h"
#include "hal/types/errors.h"

namespace jaywalk {
namespace {

constexpr Duration kRest = std::chrono::milliseconds(800);
constexpr double kOldestWheels_s = 0.1;
constexpr Duration kFirstWords = std::chrono::milliseconds(300);
constexpr double kReaction_s = 0.2;  ///< a scan's age, a tick, the drive
constexpr double kLeastRoom_m = 0.15;

/// Drives that are armed, a tick at a time. Every complaint is a StartupError, and the wheels are commanded to rest
/// before it is thrown.
class WatchedDrive {
 public:
  /// `purpose`: how its complaints begin.
  WatchedDrive(std::string purpose, const ArmedRobot& robot)
      : purpose_(std::move(purpose)),
        robot_(robot),
        felt_(robot.model.drive, robot.model.limits),
        response_(robot.model.drive),
        began_(robot.clock.now()),
        due_(began_),
        scans_(robot.lasers.size()) {
    for (const LaserModel& laser : robot.model.lasers())
      zones_.emplace_back(StopZoneConfig{.footprint = robot.model.footprint,
                                         .robot_from_laser = laser.robot_from_laser,
                                         .brake_mps2 = robot.model.limits.brake_mps2});
  }

  /// Waits for the next tick, takes what came and commands (rad/s). False where the feedback is not what was commanded.
  /// Throws where drives are in trouble, where feedback or scans stop coming, or where it is to end.
  bool tick(double left_radps, double right_radps) {
    due_ = std::max(due_, robot_.clock.now() - robot_.tick) + robot_.tick;  // ticks that were missed are left out
    robot_.clock.sleep_until(due_);
    const Time now = robot_.clock.now();
    wheels_ = robot_.drive.latest();
    take_scans();
    const bool obeys = !felt_.disobeys(sent_, wheels_, now);
    require_well(now);
    command(left_radps, right_radps);
    return obeys;
  }
  /// Until wheels and scans have come to rest.
  void rest() {
    for (const Time until = due_ + kRest; due_ < until;) static_cast<void>(tick(0.0, 0.0));
  }
  /// Whether it could stop at this speed before anything that any scanner sees in the way.
  [[nodiscard]] bool has_room(const Twist2& way) const {
    for (std::size_t k = 0; k < scans_.size(); ++k) {
      const StopZone& zone = zones_[k];
      const double gap_m = zone.gap_m(scans_[k], way), reaction_s = kReaction_s + to_seconds(scans_[k].sweep);
      if (gap_m < kLeastRoom_m || zone.speed_to_stop_within(gap_m, reaction_s) < zone.rim_speed_mps(way)) return false;
    }
    return true;
  }
  [[noreturn]] void give_up(const std::string& cause, const std::string& remedy) {
    command(0.0, 0.0);
    throw StartupError(purpose_ + ": " + cause, remedy);
  }

  [[nodiscard]] Time due() const { return due_; }
  [[nodiscard]] const WheelState& wheels() const { return wheels_; }
  /// Measured delay from a command to its feedback, s; 0: not known yet.
  [[nodiscard]] double response_s() const { return response_.seconds(); }
  /// Of each scanner, blanked; the last that came.
  [[nodiscard]] const std::vector<LaserScan>& scans() const { return scans_; }

 private:
  void command(double left_radps, double right_radps) {
    sent_ = {robot_.clock.now(), left_radps, right_radps};
    robot_.drive.command(sent_);
    response_.add(wheels_, sent_);
  }
  void take_scans() {
    for (std::size_t k = 0; k < scans_.size(); ++k) {
      const LaserScan& scan = robot_.lasers[k]->latest();
      if (scan.sequence == scans_[k].sequence) continue;
      scans_[k] = scan;
      blank(robot_.model.lasers()[k].blanked, scans_[k]);
    }
  }
  void require_well(Time now) {
    if (robot_.stopped()) give_up("broken off", "start it again when nothing speaks against it");
    if (wheels_.trouble != DriveTrouble::kNone)
      give_up(std::string(name(wheels_.trouble)), "see to the drives, then start it again");
    if (now - began_ < kFirstWords) return;  // drives speak when they are spoken to
    const double oldest_s = std::max(kOldestWheels_s, robot_.model.drive.times.oldest_report_s());
    if (is_older(wheels_.stamp, now, duration_from_seconds(oldest_s)))
      give_up("no wheel feedback", "see to the drives");
    for (std::size_t k = 0; k < scans_.size(); ++k) {
      const Duration oldest = duration_from_seconds(3.0 / robot_.model.lasers()[k].rate_hz + 0.2);
      if (!is_older(scans_[k].stamp, now, oldest)) continue;
      const std::string name = scanner_name(robot_.model, k);
      give_up("no scans" + (name.empty() ? "" : " of the " + name + " scanner"), "see to the scanner");
    }
  }

  std::string purpose_;
  const ArmedRobot& robot_;
  std::vector<StopZone> zones_;  ///< one a scanner
  FeltMotion felt_;
  DriveResponse response_;
  Time began_, due_;
  WheelState wheels_;
  std::vector<LaserScan> scans_;
  WheelCommand sent_;
};

constexpr double kNudge_mps = 0.1, kNudge_m = 0.12;  ///< of the rim, by the wheel's own feedback
constexpr Duration kLongestNudge = std::chrono::seconds(5);

/// Throws where it has no room, wherever wrong wiring may make it go.
void require_room(WatchedDrive& drive, const DriveModel& model) {
  constexpr double v = 0.5 * kNudge_mps;
  const double w = kNudge_mps / model.track_width_m;
  for (const Twist2& way : {Twist2{v, w}, Twist2{v, -w}, Twist2{-v, w}, Twist2{-v, -w}})
    if (!drive.has_room(way)) drive.give_up("something stands too near", "leave half a metre free all round the robot");
}

Nudge nudge_wheel(WatchedDrive& drive, const DriveModel& model, std::size_t side, double sign) {
  drive.rest();
  Nudge nudge{.side = side, .sign = sign, .before = drive.wheels(), .scans_before = drive.scans()};
  const auto rolled_m = [&] {
    const WheelState &now = drive.wheels(), &before = nudge.before;
    const double turned = side == 0 ? now.left_rad - before.left_rad : now.right_rad - before.right_rad;
    return std::fabs(turned) * model.wheel_radius_m;
  };
  const Time limit = drive.due() + kLongestNudge;
  while (!nudge.disobeyed && rolled_m() < kNudge_m && drive.due() < limit) {
    require_room(drive, model);
    const double radps = sign * kNudge_mps / model.wheel_radius_m;
    nudge.disobeyed = !drive.tick(side == 0 ? radps : 0.0, side == 1 ? radps : 0.0);
  }
  drive.rest();
  nudge.after = drive.wheels();
  nudge.scans_after = drive.scans();
  nudge.response_s = drive.response_s();
  return nudge;
}

constexpr double kGuided_mps = 0.25, kGuided_radps = 0.6, kStraight_m = 1.5;
constexpr double kAccel_mps2 = 0.3, kTurnAccel_radps2 = 0.8;

/// One piece of the drive, at a constant twist but for its ends.
struct Leg {
  Twist2 twist;
  double way_m = 0.0;     ///< until the middle has gone so far, or half of it where it has no more room; or
  double turn_rad = 0.0;  ///< the robot has turned so much
};

double towards(double from, double to, double most) { return from + std::clamp(to - from, -most, most); }

class GuidedDrive {
 public:
  explicit GuidedDrive(const ArmedRobot& robot)
      : model_(robot.model.drive),
        tick_s_(to_seconds(robot.tick)),
        drive_("calibration", robot),
        logs_(robot.lasers.size(), CalibrationLog(robot.model.drive)) {}

  std::vector<CalibrationLog> conduct() {
    drive_.rest();
    constexpr double v = kGuided_mps, w = kGuided_radps;
    for (const Leg& leg : {Leg{{v, 0.0}, kStraight_m}, Leg{{0.0, w}, 0.0, kPi}, Leg{{v, 0.0}, kStraight_m},
                           Leg{{0.0, -w}, 0.0, kPi}, Leg{{v, w}, 0.0, 2.0 * kPi}, Leg{{v, -w}, 0.0, 2.0 * kPi}})
      follow(leg);
    return std::move(logs_);
  }

 private:
  void follow(const Leg& leg) {
    const WheelState began = drive_.wheels();
    while (!is_done(leg, began)) {
      if (!drive_.has_room(leg.twist)) {
        if (leg.way_m > 0.0 && gone(began).first >= 0.5 * leg.way_m) break;
        drive_.give_up("something stands too near", "leave 2 m free ahead and a metre to each side and behind");
      }
      tick(leg.twist);
    }
    while (now_.v_mps != 0.0 || now_.w_radps != 0.0) tick({});
    drive_.rest();
  }
  /// How far the middle went since, and how much it turned.
  [[nodiscard]] std::pair<double, double> gone(const WheelState& since) const {
    const double left_m = (drive_.wheels().left_rad - since.left_rad) * model_.wheel_radius_m,
                 right_m = (drive_.wheels().right_rad - since.right_rad) * model_.wheel_radius_m;
    return {std::fabs(0.5 * (left_m + right_m)), std::fabs(right_m - left_m) / model_.track_width_m};
  }
  [[nodiscard]] bool is_done(const Leg& leg, const WheelState& began) const {
    const auto [way_m, turn_rad] = gone(began);
    return leg.way_m > 0.0 ? way_m >= leg.way_m : turn_rad >= leg.turn_rad;
  }
  void tick(const Twist2& wanted) {
    now_ = {towards(now_.v_mps, wanted.v_mps, kAccel_mps2 * tick_s_),
            towards(now_.w_radps, wanted.w_radps, kTurnAccel_radps2 * tick_s_)};
    const double aside_mps = 0.5 * now_.w_radps * model_.track_width_m, radius_m = model_.wheel_radius_m;
    if (!drive_.tick((now_.v_mps - aside_mps) / radius_m, (now_.v_mps + aside_mps) / radius_m))
      drive_.give_up("a wheel does not turn as commanded", "jaywalk commission says which");
    for (std::size_t k = 0; k < logs_.size(); ++k) logs_[k].take(drive_.wheels(), drive_.scans()[k]);
  }

  const DriveModel& model_;
  double tick_s_;
  WatchedDrive drive_;
  std::vector<CalibrationLog> logs_;  ///< one a scanner
  Twist2 now_;
};

}  // namespace

std::vector<Nudge> nudge_wheels(const ArmedRobot& robot) {
  WatchedDrive drive("commissioning", robot);
  std::vector<Nudge> nudges;
  for (const std::size_t side : {0U, 1U}) {
    for (const double sign : {1.0, -1.0}) {
      nudges.push_back(nudge_wheel(drive, robot.model.drive, side, sign));
      if (nudges.back().disobeyed) return nudges;
    }
  }
  return nudges;
}

std::vector<CalibrationLog> drive_guided(const ArmedRobot& robot) { return GuidedDrive(robot).conduct(); }

}  // namespace jaywalk
