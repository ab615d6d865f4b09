#include "firmware/safety/wheel_proof.h"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace jaywalk {
namespace {

constexpr double kStands_m = 0.0005;    // of the felt way from scan to scan: the newer one is kept
constexpr double kLongestPair_m = 0.3;  // of a felt way, before a newer scan is kept: people move
constexpr double kNoFaster_m = 0.015;   // of a felt way that tells that they go no more than kNoFaster times as far
constexpr double kNoFaster = 2.5;
constexpr double kProofExplained = 0.5, kProofLeastCompared = 12.0;  // of a fit that tells (MotionModel)
constexpr double kSure = 4.0, kMatch_m = 0.003;   // standard deviations; of a match, its points apart
constexpr double kTellsShare = 0.08;              // of the way: a match as sure as that proves it
constexpr double kProofRough_m = 0.05;            // of errors before a fit
constexpr double kProofEvidence = 10.0;           // for the seen way against the felt one (MotionModel)
constexpr int kProofTimes = 2, kProofPeople = 2;  // scans in a row; sectors

template <class Ways>
double longer(const Ways& to, const Ways& from) {
  return std::max(std::fabs(to.left - from.left), std::fabs(to.right - from.right));
}

double total(const std::array<double, ScanPair::kSectors>& costs) {
  double sum = 0.0;
  for (const double cost : costs) sum += cost;
  return sum;
}

/// Without what one or two pedestrians and their shadows say.
double without_greatest(std::array<double, ScanPair::kSectors> costs) {
  std::nth_element(costs.begin(), costs.end() - kProofPeople, costs.end());
  std::fill(costs.end() - kProofPeople, costs.end(), 0.0);
  return total(costs);
}

}  // namespace

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
WheelProof::Ways WheelProof::rolled(const WheelState& wheels, Time stamp) const noexcept {
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
  const Ways now = rolled(wheels, scan.stamp);
  if (!began_) began_rolled_ = now;
  rolled_m_ = longer(now, began_rolled_);
  const bool stands = !began_ || longer(now, std::exchange(last_rolled_, now)) < kStands_m;
  const bool usable = pair_.usable(scan);
  const double radius = drive_.wheel_radius_m, left = radius * wheels.left_radps, right = radius * wheels.right_radps;
  if (usable) pair_.sweep(scan, {0.5 * (left + right), (right - left) / drive_.track_width_m});
  const Ways felt{now.left - kept_rolled_.left, now.right - kept_rolled_.right};
  if (usable && (stands || !pair_.is_kept())) {
    keep(scan, now);
  } else if (usable) {
    match(scan, felt);
    judge(felt);
    if (longer(now, kept_rolled_) > kLongestPair_m && times_against_ == 0) keep(scan, now);
  }
  began_ = true;
  over_ = over_ || rolled_m_ > kUnseen_m;
  return !over_ && times_against_ >= kProofTimes;
}

void WheelProof::keep(const LaserScan& scan, const Ways& rolled) noexcept {
  pair_.keep(scan);
  kept_rolled_ = rolled;
  fit_ = {};
  before_ = {};
  times_against_ = times_for_ = 0;
}

Pose2 WheelProof::pose_of(const Ways& ways) const noexcept {
  const double turn = (ways.right - ways.left) / drive_.track_width_m;
  const Vec2 way = direction(0.5 * turn) * (0.5 * (ways.left + ways.right));
  return {way.x, way.y, turn};
}

/// From where the errors are least to begin with: as felt, more, less and backwards, and as it went from scan to scan.
void WheelProof::match(const LaserScan& scan, const Ways& felt) noexcept {
  const Pose2 on = fit_.kept_from_now * (inverse(before_) * fit_.kept_from_now);
  const auto times = [&](double left, double right) { return pose_of({left * felt.left, right * felt.right}); };
  const std::array starts{times(1.0, 1.0), on, Pose2{}, times(3.0, 3.0), times(10.0, 10.0), times(-1.0, -1.0)};
  Pose2 start = starts[0];
  ScanPair::Errors least = pair_.errors(scan, start);
  for (std::size_t k = 1; k < starts.size(); ++k) {
    const ScanPair::Errors errors = pair_.errors(scan, starts[k]);
    if (total(pair_.advantage(errors, least, kProofRough_m, false)) <= 0.0) continue;
    least = errors;
    start = starts[k];
  }
  before_ = fit_.kept_from_now;
  fit_ = pair_.fit(scan, start);
  const ScanPair::Errors seen = pair_.errors(scan, fit_.kept_from_now);
  evidence_ = without_greatest(pair_.advantage(seen, pair_.errors(scan, starts[0]), fit_.noise_m, true));
}

WheelProof::Ways WheelProof::seen() const noexcept {
  const Pose2& moved = fit_.kept_from_now;
  const double middle = dot(direction(0.5 * moved.heading), moved.position());
  const double apart = 0.5 * moved.heading * drive_.track_width_m;
  return {middle - apart, middle + apart};
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

void WheelProof::judge(const Ways& felt) noexcept {
  if (fit_.explained < kProofExplained || fit_.compared < kProofLeastCompared) return;
  const Ways seen = this->seen();
  const double off_m = std::max(std::fabs(seen.left - felt.left), std::fabs(seen.right - felt.right));
  const double way_m = std::max(std::fabs(felt.left), std::fabs(felt.right)), std_m = seen_std_m();
  const double sure_m = kSure * std_m;
  const bool against = evidence_ > kProofEvidence && off_m - sure_m > kOff_m + kOffShare * way_m;
  times_against_ = against ? times_against_ + 1 : 0;
  const double seen_m = std::max(std::fabs(seen.left), std::fabs(seen.right));
  is_no_faster_ = is_no_faster_ || (way_m > kNoFaster_m && seen_m + sure_m < kNoFaster * way_m);
  const bool agree = way_m > kProof_m && std_m < kTellsShare * way_m && off_m < kAgreeShare * way_m;
  times_for_ = agree ? times_for_ + 1 : 0;
  over_ = times_for_ >= kProofTimes;
}

}  // namespace jaywalk
