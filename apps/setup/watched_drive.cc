#include "apps/setup/watched_drive.h"

#include <algorithm>
#include <cmath>

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

}  // namespace jaywalk
