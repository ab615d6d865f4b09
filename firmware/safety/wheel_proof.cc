#include "firmware/safety/wheel_proof.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace jaywalk {
namespace {
constexpr Duration kMostBeyond = std::chrono::milliseconds(200);

Rolled between(const Rolled& a, const Rolled& b, double share) noexcept {
  return {a.left_m + share * (b.left_m - a.left_m), a.right_m + share * (b.right_m - a.right_m)};
}

constexpr double kStands_m = 0.0005;    // of the felt way from scan to scan: the newer one is kept
constexpr double kLongestPair_m = 0.3;  // of a felt way, before a newer scan is kept: people move
constexpr double kNoFaster_m = 0.015;   // of a felt way that tells that they go no more than kNoFaster times as far
constexpr double kNoFaster = 2.5;
constexpr double kSure = 4.0, kMatch_m = 0.003;  // standard deviations; of a match, its points apart
constexpr double kTellsShare = 0.08;             // of the way: a match as sure as that proves it
constexpr double kProofEvidence = 10.0;          // for the seen way against the felt one (MotionModel)
constexpr int kProofTimes = 2;                   // scans in a row

}  // namespace

void WheelTravel::note(const WheelState& wheels) noexcept {
  if (wheels.sequence == seen_ || wheels.sequence == 0) return;
  seen_ = wheels.sequence;
  if (!std::isfinite(wheels.left_rad) || !std::isfinite(wheels.right_rad)) return;
  if (readings_[newest_].stamp >= wheels.stamp) return;
  newest_ = (newest_ + 1) % kMostReadings;
  readings_[newest_] = {wheels.stamp,
                        {drive_.wheel_radius_m * wheels.left_rad, drive_.wheel_radius_m * wheels.right_rad}};
}

std::optional<Rolled> WheelTravel::at(Time stamp) const noexcept {
  const Reading* after = &readings_[newest_];
  if (after->stamp < stamp) return std::nullopt;
  for (std::size_t back = 1; back < kMostReadings; ++back) {
    const Reading& before = readings_[(newest_ + kMostReadings - back) % kMostReadings];
    if (before.stamp == kNever || before.stamp > after->stamp) return std::nullopt;
    if (before.stamp <= stamp)
      return between(before.rolled, after->rolled,
                     to_seconds(stamp - before.stamp) / to_seconds(after->stamp - before.stamp));
    after = &before;
  }
  return std::nullopt;
}

std::optional<Rolled> WheelTravel::expected_at(Time stamp) const noexcept {
  const Reading& last = readings_[newest_];
  const Reading& before = readings_[(newest_ + kMostReadings - 1) % kMostReadings];
  if (last.stamp == kNever) return std::nullopt;
  if (stamp < last.stamp) return at(stamp);
  const bool extrapolates = before.stamp != kNever && stamp - last.stamp <= kMostBeyond;
  const double share = extrapolates ? to_seconds(stamp - before.stamp) / to_seconds(last.stamp - before.stamp) : 1.0;
  return between(before.rolled, last.rolled, share);
}

Twist2 WheelTravel::twist_since(Time stamp, const Rolled& rolled) const noexcept {
  constexpr double kLeast_s = 0.005;
  const Reading& now = readings_[newest_];
  const double seconds = to_seconds(now.stamp - stamp);
  if (seconds < kLeast_s) return {};
  const double left = (now.rolled.left_m - rolled.left_m) / seconds,
               right = (now.rolled.right_m - rolled.right_m) / seconds;
  return {0.5 * (left + right), (right - left) / drive_.track_width_m};
}

Pose2 arc_of(const Rolled& rolled, double track_width_m) noexcept {
  const double turn = (rolled.right_m - rolled.left_m) / track_width_m;
  const Vec2 way = direction(0.5 * turn) * (0.5 * (rolled.left_m + rolled.right_m));
  return {way.x, way.y, turn};
}

Moved moved_to(const Pose2& end_in_start, double track_width_m) noexcept {
  const Vec2 ahead = direction(0.5 * end_in_start.heading), way = end_in_start.position();
  const double apart = 0.5 * end_in_start.heading * track_width_m, middle = dot(ahead, way);
  return {middle - apart, middle + apart, cross(ahead, way)};
}

WheelProof::WheelProof(const RobotModel& model, std::size_t scanner)
    : drive_(model.drive), pair_(model.lasers()[scanner].robot_from_laser) {}

void WheelProof::begin() noexcept {
  began_ = over_ = is_no_faster_ = false;
  times_against_ = times_for_ = 0;
  rolled_m_ = 0.0;
}

double WheelProof::most_mps() const noexcept {
  if (over_) return std::numeric_limits<double>::infinity();
  return is_no_faster_ || rolled_m_ >= kFirst_m ? kSlow_mps : kFirst_mps;
}

/// At a scan's stamp: the speeds carry the reading there.
Rolled WheelProof::rolled(const WheelState& wheels, Time stamp) const noexcept {
  const double later_s = to_seconds(stamp - wheels.stamp), radius = drive_.wheel_radius_m;
  return {radius * (wheels.left_rad + later_s * wheels.left_radps),
          radius * (wheels.right_rad + later_s * wheels.right_radps)};
}

bool WheelProof::contradicts(const LaserScan& scan, const WheelState& wheels) noexcept {
  if (over_) return false;
  const bool is_new = scan.sequence != scan_seen_ && scan.sequence != 0 && wheels.sequence != 0;
  scan_seen_ = scan.sequence;
  if (!is_new || !std::isfinite(wheels.left_rad) || !std::isfinite(wheels.right_rad))
    return times_against_ >= kProofTimes;
  const Rolled now = rolled(wheels, scan.stamp);
  if (!began_) began_rolled_ = now;
  rolled_m_ = farther_m(now - began_rolled_);
  const bool stands = !began_ || farther_m(now - std::exchange(last_rolled_, now)) < kStands_m;
  const bool usable = pair_.usable(scan);
  const double radius = drive_.wheel_radius_m, left = radius * wheels.left_radps, right = radius * wheels.right_radps;
  if (usable) pair_.sweep(scan, {0.5 * (left + right), (right - left) / drive_.track_width_m});
  const Rolled felt = now - kept_rolled_;
  if (usable && (stands || !pair_.is_kept())) {
    keep(scan, now);
  } else if (usable) {
    match(scan, felt);
    judge(felt);
    if (farther_m(now - kept_rolled_) > kLongestPair_m && times_against_ == 0) keep(scan, now);
  }
  began_ = true;
  over_ = over_ || rolled_m_ > kUnseen_m;
  return !over_ && times_against_ >= kProofTimes;
}

void WheelProof::keep(const LaserScan& scan, const Rolled& rolled) noexcept {
  pair_.keep(scan);
  kept_rolled_ = rolled;
  fit_ = {};
  before_ = {};
  times_against_ = times_for_ = 0;
}

/// Matches from the felt way, and from the best of five other starts: none, three and ten times it, backwards, the last
/// motion again. The second match counts where it explains the scan better by kProofEvidence: along a bare wall all
/// explain it alike, and from match to match they would slide away from the felt way.
void WheelProof::match(const LaserScan& scan, const Rolled& felt) noexcept {
  const Pose2 on = fit_.kept_from_now * (inverse(before_) * fit_.kept_from_now);
  const auto times = [&](double left, double right) {
    return arc_of({left * felt.left_m, right * felt.right_m}, drive_.track_width_m);
  };
  const std::array others{Pose2{}, on, times(3.0, 3.0), times(10.0, 10.0), times(-1.0, -1.0)};
  before_ = fit_.kept_from_now;
  const Pose2 by_wheels = times(1.0, 1.0);
  fit_ = pair_.fit(scan, by_wheels);
  const ScanPair::Fit other = pair_.fit(scan, pair_.likeliest(scan, others));
  const auto over = [&](const ScanPair::Fit& fit, const Pose2& than, bool walls) {
    const ScanPair::Errors seen = pair_.errors(scan, fit.kept_from_now), worse = pair_.errors(scan, than);
    return ScanPair::without_greatest(pair_.advantage(seen, worse, fit.noise_m, walls));
  };
  if (other.tells() && over(other, fit_.kept_from_now, false) > kProofEvidence) fit_ = other;
  evidence_ = over(fit_, by_wheels, true);
}

/// Standard deviation of the less certain wheel's seen way, m.
double WheelProof::seen_std_m() const noexcept {
  const Eigen::Matrix3d covariance = fit_.information.inverse();
  const double half = 0.5 * drive_.track_width_m;
  double most = 0.0;
  for (const double side : {-half, half}) {
    const Eigen::Vector3d along(1.0, 0.0, side);
    most = std::max(most, along.dot(covariance * along));
  }
  return std::isfinite(most) ? std::sqrt(most) + kMatch_m : std::numeric_limits<double>::infinity();
}

void WheelProof::judge(const Rolled& felt) noexcept {
  if (!fit_.tells()) return;
  const Moved moved = moved_to(fit_.kept_from_now, drive_.track_width_m);
  const Rolled seen{moved.left_m, moved.right_m};
  const double off_m = farther_m(seen - felt), way_m = farther_m(felt), std_m = seen_std_m();
  const double sure_m = kSure * std_m;
  const bool against = evidence_ > kProofEvidence && off_m - sure_m > kOff_m + kOffShare * way_m;
  times_against_ = against ? times_against_ + 1 : 0;
  is_no_faster_ = is_no_faster_ || (way_m > kNoFaster_m && farther_m(seen) + sure_m < kNoFaster * way_m);
  const bool agree = way_m > kProof_m && std_m < kTellsShare * way_m && off_m < kAgreeShare * way_m;
  times_for_ = agree ? times_for_ + 1 : 0;
  over_ = times_for_ >= kProofTimes;
}

}  // namespace jaywalk
