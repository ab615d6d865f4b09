#include "apps/setup/watched_drive.h"

#include <algorithm>

#include "firmware/safety/trust.h"
#include "hal/types/errors.h"

namespace jaywalk {
namespace {

constexpr Duration kRest = std::chrono::milliseconds(800);
constexpr Duration kOldestWheels = std::chrono::milliseconds(100), kFirstWords = std::chrono::milliseconds(300);
constexpr double kReaction_s = 0.2;  ///< a scan's age, a tick, the drive
constexpr double kLeastRoom_m = 0.15;

}  // namespace

WatchedDrive::WatchedDrive(const WatchedDriveSetup& setup, DriveBase& drive, LaserScanner& laser, Clock& clock,
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

bool WatchedDrive::tick(double left_radps, double right_radps) {
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

void WatchedDrive::command(double left_radps, double right_radps) {
  sent_ = {clock_.now(), left_radps, right_radps};
  drive_.command(sent_);
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
  if (is_older(wheels_.stamp, now, kOldestWheels)) give_up("no wheel feedback", "see to the drives");
  const Duration oldest = duration_from_seconds(3.0 / setup_.model.laser.rate_hz + 0.2);
  if (is_older(scan_.stamp, now, oldest)) give_up("no scans", "see to the scanner");
}

bool WatchedDrive::has_room(const Twist2& way) const {
  const double gap_m = zone_.gap_m(scan_, way);
  return gap_m >= kLeastRoom_m &&
         zone_.speed_to_stop_within(gap_m, kReaction_s + to_seconds(scan_.sweep)) >= zone_.rim_speed_mps(way);
}

}  // namespace jaywalk
