#include "firmware/setup/wheel_nudges.h"

#include <algorithm>
#include <cmath>

#include "firmware/safety/felt_motion.h"
#include "firmware/safety/stop_zone.h"
#include "firmware/safety/trust.h"
#include "hal/types/errors.h"

namespace jaywalk {
namespace {

constexpr Duration kRest = std::chrono::milliseconds(800), kLongestNudge = std::chrono::seconds(5);
constexpr Duration kOldestWheels = std::chrono::milliseconds(100), kFirstWords = std::chrono::milliseconds(300);
constexpr double kReaction_s = 0.2;  ///< a scan's age, a tick, the drive
constexpr double kLeastRoom_m = 0.15;

class Nudging {
 public:
  Nudging(const NudgeSetup& setup, WiredDrive& drive, LaserScanner& laser, Clock& clock,
          const std::function<bool()>& stopped)
      : setup_(setup),
        drive_(drive),
        laser_(laser),
        clock_(clock),
        stopped_(stopped),
        zone_({.footprint = setup.model.footprint,
               .robot_from_laser = setup.model.laser.robot_from_laser,
               .brake_mps2 = setup.model.limits.brake_mps2}),
        felt_(setup.model.drive, setup.model.limits.brake_mps2),
        began_(clock.now()),
        due_(began_) {}

  Nudge nudge(std::size_t side, double sign) {
    Nudge nudge{.side = side, .sign = sign};
    rest();
    nudge.before = wheels_;
    nudge.scan_before = scan_;
    const Time limit = due_ + kLongestNudge;
    while (!nudge.disobeyed && rolled_m(nudge) < setup_.way_m && due_ < limit) {
      require_room();
      const double radps = sign * setup_.speed_mps / setup_.model.drive.wheel_radius_m;
      nudge.disobeyed = !tick(side == 0 ? radps : 0.0, side == 1 ? radps : 0.0);
    }
    rest();
    nudge.after = wheels_;
    nudge.scan_after = scan_;
    return nudge;
  }

 private:
  /// False where the feedback is not what was commanded.
  bool tick(double left_radps, double right_radps) {
    due_ = std::max(due_, clock_.now() - setup_.tick) + setup_.tick;  // ticks that were missed are left out
    clock_.sleep_until(due_);
    const Time now = clock_.now();
    wheels_ = drive_.latest();
    const LaserScan& scan = laser_.latest();
    if (scan.sequence != scan_.sequence) scan_ = scan, blank(setup_.model.laser.blanked, scan_);
    const bool obeys = !felt_.disobeys(sent_, wheels_, now);
    require_well(now);
    command(left_radps, right_radps);
    return obeys;
  }
  void command(double left_radps, double right_radps) {
    sent_ = {clock_.now(), left_radps, right_radps};
    drive_.command(sent_);
  }
  /// Until wheels and scans have come to rest.
  void rest() {
    for (const Time until = due_ + kRest; due_ < until;) static_cast<void>(tick(0.0, 0.0));
  }
  [[nodiscard]] double rolled_m(const Nudge& nudge) const {
    const double turned =
        nudge.side == 0 ? wheels_.left_rad - nudge.before.left_rad : wheels_.right_rad - nudge.before.right_rad;
    return std::fabs(turned) * setup_.model.drive.wheel_radius_m;
  }
  [[noreturn]] void give_up(const std::string& cause, const std::string& remedy) {
    command(0.0, 0.0);
    throw StartupError(cause, remedy);
  }
  void require_well(Time now) {
    if (stopped_()) give_up("commissioning: broken off", "start it again when nothing speaks against it");
    if (wheels_.trouble != DriveTrouble::kNone)
      give_up("commissioning: " + std::string(name(wheels_.trouble)), "see to the drives, then start it again");
    if (now - began_ < kFirstWords) return;  // drives speak when they are spoken to
    if (is_older(wheels_.stamp, now, kOldestWheels)) give_up("commissioning: no wheel feedback", "see to the drives");
    const Duration oldest = duration_from_seconds(3.0 / setup_.model.laser.rate_hz + 0.2);
    if (is_older(scan_.stamp, now, oldest)) give_up("commissioning: no scans", "see to the scanner");
  }
  /// Wherever wrong wiring may make it go.
  void require_room() {
    const double v = 0.5 * setup_.speed_mps, w = setup_.speed_mps / setup_.model.drive.track_width_m;
    for (const Twist2& way : {Twist2{v, w}, Twist2{v, -w}, Twist2{-v, w}, Twist2{-v, -w}}) {
      const double gap_m = zone_.gap_m(scan_, way);
      if (gap_m < kLeastRoom_m ||
          zone_.speed_to_stop_within(gap_m, kReaction_s + to_seconds(scan_.sweep)) < zone_.rim_speed_mps(way))
        give_up("commissioning: something stands too near", "leave half a metre free all round the robot");
    }
  }

  const NudgeSetup& setup_;
  WiredDrive& drive_;
  LaserScanner& laser_;
  Clock& clock_;
  const std::function<bool()>& stopped_;
  StopZone zone_;
  FeltMotion felt_;
  Time began_, due_;
  WheelState wheels_;
  LaserScan scan_;
  WheelCommand sent_;
};

}  // namespace

std::vector<Nudge> nudge_wheels(const NudgeSetup& setup, WiredDrive& drive, LaserScanner& laser, Clock& clock,
                                const std::function<bool()>& stopped) {
  Nudging nudging(setup, drive, laser, clock, stopped);
  std::vector<Nudge> nudges;
  for (const std::size_t side : {0U, 1U}) {
    for (const double sign : {1.0, -1.0}) {
      nudges.push_back(nudging.nudge(side, sign));
      if (nudges.back().disobeyed) return nudges;
    }
  }
  return nudges;
}

}  // namespace jaywalk
