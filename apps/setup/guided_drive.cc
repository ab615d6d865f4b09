#include "apps/setup/guided_drive.h"

#include <algorithm>
#include <cmath>

#include "apps/setup/watched_drive.h"

namespace jaywalk {
namespace {

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
