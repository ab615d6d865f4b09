#include "apps/setup/watched_drive.h"

#include <algorithm>
#include <cmath>

#include "apps/setup/calibration.h"
#include "hal/types/errors.h"

namespace jaywalk {
namespace {

constexpr Duration kRest = std::chrono::milliseconds(800);
constexpr double kOldestWheels_s = 0.1;
constexpr Duration kFirstWords = std::chrono::milliseconds(300);
constexpr double kReaction_s = 0.2;  ///< a scan's age, a tick, the drive
constexpr double kLeastRoom_m = 0.15;

constexpr Duration kLongestNudge = std::chrono::seconds(5);

class Nudging {
 public:
  Nudging(const NudgeSetup& setup, WiredDrive& drive, std::span<LaserScanner* const> lasers, Clock& clock,
          const std::function<bool()>& stopped)
      : setup_(setup), drive_({"commissioning", setup.model, setup.tick}, drive, lasers, clock, stopped) {}

  Nudge nudge(std::size_t side, double sign) {
    Nudge nudge{.side = side, .sign = sign};
    drive_.rest();
    nudge.before = drive_.wheels();
    nudge.scans_before = drive_.scans();
    const Time limit = drive_.due() + kLongestNudge;
    while (!nudge.disobeyed && rolled_m(nudge) < setup_.way_m && drive_.due() < limit) {
      require_room();
      const double radps = sign * setup_.speed_mps / setup_.model.drive.wheel_radius_m;
      nudge.disobeyed = !drive_.tick(side == 0 ? radps : 0.0, side == 1 ? radps : 0.0);
    }
    drive_.rest();
    nudge.after = drive_.wheels();
    nudge.scans_after = drive_.scans();
    nudge.response_s = drive_.response_s();
    return nudge;
  }

 private:
  [[nodiscard]] double rolled_m(const Nudge& nudge) const {
    const WheelState& now = drive_.wheels();
    const double turned =
        nudge.side == 0 ? now.left_rad - nudge.before.left_rad : now.right_rad - nudge.before.right_rad;
    return std::fabs(turned) * setup_.model.drive.wheel_radius_m;
  }
  /// Wherever wrong wiring may make it go.
  void require_room() {
    const double v = 0.5 * setup_.speed_mps, w = setup_.speed_mps / setup_.model.drive.track_width_m;
    for (const Twist2& way : {Twist2{v, w}, Twist2{v, -w}, Twist2{-v, w}, Twist2{-v, -w}})
      if (!drive_.has_room(way))
        drive_.give_up("something stands too near", "leave half a metre free all round the robot");
  }

  const NudgeSetup& setup_;
  WatchedDrive drive_;
};

constexpr Duration kLongestGap = std::chrono::milliseconds(250);  ///< between readings: what was between is not known

WheelTurns between_two(const WheelTurns& a, const WheelTurns& b, Time stamp) {
  const double span = to_seconds(b.stamp - a.stamp), share = span > 0.0 ? to_seconds(stamp - a.stamp) / span : 0.0;
  return {stamp, a.left_rad + share * (b.left_rad - a.left_rad), a.right_rad + share * (b.right_rad - a.right_rad)};
}

constexpr double kAccel_mps2 = 0.3, kTurnAccel_radps2 = 0.8;

/// One piece of the drive, at a constant twist but for its ends.
struct Leg {
  Twist2 twist;
  double way_m = 0.0;     ///< until the middle has gone so far, or
  double turn_rad = 0.0;  ///< the robot has turned so much
  bool may_be_shorter = false;
};

double towards(double from, double to, double most) { return from + std::clamp(to - from, -most, most); }

class GuidedDrive {
 public:
  GuidedDrive(const GuidedDriveSetup& setup, DriveBase& drive, std::span<LaserScanner* const> lasers, Clock& clock,
              const std::function<bool()>& stopped)
      : setup_(setup),
        drive_({"calibration", setup.model, setup.tick}, drive, lasers, clock, stopped),
        logs_(lasers.size(), CalibrationLog(setup.model.drive)) {}

  std::vector<CalibrationLog> conduct() {
    drive_.rest();
    const double v = setup_.speed_mps, w = setup_.turn_radps;
    for (const Leg& leg : {Leg{{v, 0.0}, setup_.straight_m, 0.0, true}, Leg{{0.0, w}, 0.0, kPi},
                           Leg{{v, 0.0}, setup_.straight_m, 0.0, true}, Leg{{0.0, -w}, 0.0, kPi},
                           Leg{{v, w}, 0.0, 2.0 * kPi}, Leg{{v, -w}, 0.0, 2.0 * kPi}})
      follow(leg);
    return std::move(logs_);
  }

 private:
  void follow(const Leg& leg) {
    const WheelState began = drive_.wheels();
    while (!is_done(leg, began)) {
      if (!drive_.has_room(leg.twist)) {
        if (leg.may_be_shorter && gone(began).first >= 0.5 * leg.way_m) break;
        drive_.give_up("something stands too near", "leave 2 m free ahead and a metre to each side and behind");
      }
      tick(leg.twist);
    }
    while (now_.v_mps != 0.0 || now_.w_radps != 0.0) tick({});
    drive_.rest();
  }
  /// How far the middle went since, and how much it turned.
  [[nodiscard]] std::pair<double, double> gone(const WheelState& since) const {
    const DriveModel& model = setup_.model.drive;
    const double left_m = (drive_.wheels().left_rad - since.left_rad) * model.wheel_radius_m,
                 right_m = (drive_.wheels().right_rad - since.right_rad) * model.wheel_radius_m;
    return {std::fabs(0.5 * (left_m + right_m)), std::fabs(right_m - left_m) / model.track_width_m};
  }
  [[nodiscard]] bool is_done(const Leg& leg, const WheelState& began) const {
    const auto [way_m, turn_rad] = gone(began);
    return leg.way_m > 0.0 ? way_m >= leg.way_m : turn_rad >= leg.turn_rad;
  }
  void tick(const Twist2& wanted) {
    const double step_s = to_seconds(setup_.tick);
    now_ = {towards(now_.v_mps, wanted.v_mps, kAccel_mps2 * step_s),
            towards(now_.w_radps, wanted.w_radps, kTurnAccel_radps2 * step_s)};
    const double aside_mps = 0.5 * now_.w_radps * setup_.model.drive.track_width_m,
                 radius_m = setup_.model.drive.wheel_radius_m;
    if (!drive_.tick((now_.v_mps - aside_mps) / radius_m, (now_.v_mps + aside_mps) / radius_m))
      drive_.give_up("a wheel does not turn as commanded", "jaywalk commission says which");
    for (std::size_t k = 0; k < logs_.size(); ++k) logs_[k].take(drive_.wheels(), drive_.scans()[k]);
  }

  const GuidedDriveSetup& setup_;
  WatchedDrive drive_;
  std::vector<CalibrationLog> logs_;  ///< one a scanner
  Twist2 now_;
};

}  // namespace

WatchedDrive::WatchedDrive(const WatchedDriveSetup& setup, DriveBase& drive, std::span<LaserScanner* const> lasers,
                           Clock& clock, const std::function<bool()>& stopped)
    : setup_(setup),
      drive_(drive),
      lasers_(lasers.begin(), lasers.end()),
      clock_(clock),
      stopped_(stopped),
      felt_(setup.model.drive, setup.model.limits),
      response_(setup.model.drive),
      began_(clock.now()),
      due_(began_),
      scans_(lasers.size()) {
  for (const LaserModel& laser : setup.model.lasers())
    zones_.emplace_back(StopZoneConfig{.footprint = setup.model.footprint,
                                       .robot_from_laser = laser.robot_from_laser,
                                       .brake_mps2 = setup.model.limits.brake_mps2});
}

bool WatchedDrive::tick(double left_radps, double right_radps) {
  due_ = std::max(due_, clock_.now() - setup_.tick) + setup_.tick;  // ticks that were missed are left out
  clock_.sleep_until(due_);
  const Time now = clock_.now();
  wheels_ = drive_.latest();
  take_scans();
  const bool obeys = !felt_.disobeys(sent_, wheels_, now);
  require_well(now);
  command(left_radps, right_radps);
  return obeys;
}

void WatchedDrive::take_scans() {
  for (std::size_t k = 0; k < lasers_.size(); ++k) {
    const LaserScan& scan = lasers_[k]->latest();
    if (scan.sequence == scans_[k].sequence) continue;
    scans_[k] = scan;
    blank(setup_.model.lasers()[k].blanked, scans_[k]);
  }
}

void WatchedDrive::command(double left_radps, double right_radps) {
  sent_ = {clock_.now(), left_radps, right_radps};
  drive_.command(sent_);
  response_.add(wheels_, sent_);
}

void WatchedDrive::rest() {
  for (const Time until = due_ + kRest; due_ < until;) static_cast<void>(tick(0.0, 0.0));
}

void WatchedDrive::give_up(const std::string& cause, const std::string& remedy) {
  command(0.0, 0.0);
  throw StartupError(setup_.purpose + ": " + cause, remedy);
}

void WatchedDrive::require_well(Time now) {
  if (stopped_()) give_up("broken off", "start it again when nothing speaks against it");
  if (wheels_.trouble != DriveTrouble::kNone)
    give_up(std::string(name(wheels_.trouble)), "see to the drives, then start it again");
  if (now - began_ < kFirstWords) return;  // drives speak when they are spoken to
  const double oldest_s = std::max(kOldestWheels_s, setup_.model.drive.times.oldest_report_s());
  if (is_older(wheels_.stamp, now, duration_from_seconds(oldest_s))) give_up("no wheel feedback", "see to the drives");
  for (std::size_t k = 0; k < scans_.size(); ++k) {
    const Duration oldest = duration_from_seconds(3.0 / setup_.model.lasers()[k].rate_hz + 0.2);
    if (!is_older(scans_[k].stamp, now, oldest)) continue;
    const std::string name = scanner_name(setup_.model, k);
    give_up("no scans" + (name.empty() ? "" : " of the " + name + " scanner"), "see to the scanner");
  }
}

bool WatchedDrive::has_room(const Twist2& way) const {
  for (std::size_t k = 0; k < scans_.size(); ++k) {
    const StopZone& zone = zones_[k];
    const double gap_m = zone.gap_m(scans_[k], way), reaction_s = kReaction_s + to_seconds(scans_[k].sweep);
    if (gap_m < kLeastRoom_m || zone.speed_to_stop_within(gap_m, reaction_s) < zone.rim_speed_mps(way)) return false;
  }
  return true;
}

std::vector<Nudge> nudge_wheels(const NudgeSetup& setup, WiredDrive& drive, std::span<LaserScanner* const> lasers,
                                Clock& clock, const std::function<bool()>& stopped) {
  Nudging nudging(setup, drive, lasers, clock, stopped);
  std::vector<Nudge> nudges;
  for (const std::size_t side : {0U, 1U}) {
    for (const double sign : {1.0, -1.0}) {
      nudges.push_back(nudging.nudge(side, sign));
      if (nudges.back().disobeyed) return nudges;
    }
  }
  return nudges;
}

bool CalibrationLog::is_far_from_last() const {
  if (scans_.empty()) return true;
  const double left_m = (wheels_.back().left_rad - at_last_scan_.left_rad) * drive_.wheel_radius_m,
               right_m = (wheels_.back().right_rad - at_last_scan_.right_rad) * drive_.wheel_radius_m;
  return std::fabs(left_m + right_m) > 2.0 * kApart_m ||
         std::fabs(right_m - left_m) > kApart_rad * drive_.track_width_m;
}

void CalibrationLog::take(const WheelState& wheels, const LaserScan& scan) {
  if (wheels.sequence != wheel_sequence_) {
    wheel_sequence_ = wheels.sequence;
    wheels_.push_back({wheels.stamp, wheels.left_rad, wheels.right_rad});
  }
  if (scan.sequence == scan_sequence_ || wheels_.empty()) return;
  scan_sequence_ = scan.sequence;
  if (scan.stamp < wheels_.front().stamp || scans_.size() >= kMostScans || !is_far_from_last()) return;
  at_last_scan_ = wheels_.back();
  scans_.push_back(scan);
}

WheelTurns CalibrationLog::at(Time stamp) const {
  if (wheels_.size() < 2) return wheels_.empty() ? WheelTurns{} : wheels_.front();
  const auto later = [](Time t, const WheelTurns& reading) { return t < reading.stamp; };
  auto after = std::upper_bound(wheels_.begin() + 1, wheels_.end() - 1, stamp, later);
  return between_two(*(after - 1), *after, stamp);
}

std::vector<WheelTurns> CalibrationLog::between(Time from, Time to) const {
  std::vector<WheelTurns> way{at(from)};
  const auto later = [](Time t, const WheelTurns& reading) { return t < reading.stamp; };
  for (auto next = std::upper_bound(wheels_.begin(), wheels_.end(), from, later);
       next != wheels_.end() && next->stamp < to; ++next)
    way.push_back(*next);
  way.push_back(at(to));
  for (std::size_t k = 1; k < way.size(); ++k) {
    const double most_rad = 2.0 * drive_.max_wheel_speed_radps * to_seconds(way[k].stamp - way[k - 1].stamp) + 1e-3;
    const double turned =
        std::max(std::fabs(way[k].left_rad - way[k - 1].left_rad), std::fabs(way[k].right_rad - way[k - 1].right_rad));
    if (way[k].stamp - way[k - 1].stamp > kLongestGap || turned > most_rad) return {};
  }
  return way;
}

std::vector<CalibrationLog> drive_guided(const GuidedDriveSetup& setup, DriveBase& drive,
                                         std::span<LaserScanner* const> lasers, Clock& clock,
                                         const std::function<bool()>& stopped) {
  return GuidedDrive(setup, drive, lasers, clock, stopped).conduct();
}

}  // namespace jaywalk
