#include "apps/setup/calibration.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "apps/setup/scan_surfels.h"
#include "hal/types/errors.h"
#include "planner/localization/odometry.h"
#include "planner/localization/pose_belief.h"
#include "planner/scan/scan_points.h"

namespace jaywalk {
namespace {

using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

constexpr std::size_t kLeastMotions = 10;
constexpr int kRounds = 2;  ///< of matching: mount and wheels put right what the laser measured while it moved
constexpr int kIterations = 10;
constexpr double kSigmas95 = 1.96;
/// A scan point's standard deviation about a wall, and what remains of a match's however many points there are.
constexpr double kPoint_m = 0.01, kMatch_m = 0.0015, kMatch_rad = 0.0004;
/// Of a wheel's way: a metre of it scatters by so much (m). Its square grows with the way.
constexpr double kSlip_m = 0.0035;
/// A match leaves more, or its walls look one way: it is none.
constexpr double kMostResidual_m = 0.06;
/// Chi-squared of three: its median, and beyond what share of it a motion is left out (4.5 sigma, 1 in 10,000).
constexpr double kMedian3 = 2.366, kMost3 = 21.0;
/// What is believed beforehand of each, standard deviations: radii and track as shares, m, m, rad. Weak: it keeps
/// what a drive does not tell from running away.
constexpr std::array<double, 6> kBelief{0.1, 0.1, 0.1, 0.3, 0.3, 0.5};

Vector6 vector_of(const RobotGeometry& g) {
  Vector6 p;
  p << g.left_radius_m, g.right_radius_m, g.track_width_m, g.robot_from_laser.x, g.robot_from_laser.y,
      g.robot_from_laser.heading;
  return p;
}

RobotGeometry geometry_of(const Vector6& p) { return {p[0], p[1], p[2], {p[3], p[4], wrap_angle(p[5])}}; }

Matrix6 prior_of(const Vector6& believed) {
  Vector6 sigma = Vector6::Map(kBelief.data());
  sigma.head<3>() = sigma.head<3>().cwiseProduct(believed.head<3>());
  return sigma.cwiseAbs2().cwiseInverse().asDiagonal();
}

ArcStep arc_of(const WheelTurns& from, const WheelTurns& to, const RobotGeometry& g) {
  const double left_m = (to.left_rad - from.left_rad) * g.left_radius_m,
               right_m = (to.right_rad - from.right_rad) * g.right_radius_m;
  return {0.5 * (left_m + right_m), (right_m - left_m) / g.track_width_m};
}

/// How the laser moved, by the wheels.
Pose2 laser_motion(const std::vector<WheelTurns>& way, const RobotGeometry& g) {
  Pose2 robot;
  for (std::size_t k = 1; k < way.size(); ++k) robot = after_arc(robot, arc_of(way[k - 1], way[k], g));
  return inverse(g.robot_from_laser) * robot * g.robot_from_laser;
}

/// One motion from a scan to the next.
struct Motion {
  std::vector<WheelTurns> way;
  Pose2 seen;                   ///< the laser's motion, by the scans
  Eigen::Matrix3d information;  ///< of it and of the wheels' slip together
  bool used = true;
};

/// Where the beams end, seen from where the laser was when the first was measured.
std::vector<Surfel> surfels_at_stamp(const LaserScan& scan, const CalibrationLog& log, const RobotGeometry& g) {
  BeamEnds ends = beam_ends(scan);
  if (scan.sweep > Duration{0} && ends.size() > 1) {
    const ArcStep during = arc_of(log.at(scan.stamp), log.at(scan.stamp + scan.sweep), g);
    const Pose2 laser_from_robot = inverse(g.robot_from_laser);
    for (std::size_t k = 0; k < ends.size(); ++k) {
      const double share = static_cast<double>(k) / static_cast<double>(ends.size() - 1);
      const Pose2 robot = after_arc({}, {share * during.distance_m, share * during.turn_rad});
      if (ends[k]) ends[k] = (laser_from_robot * robot * g.robot_from_laser) * *ends[k];
    }
  }
  return surfels_of(ends, std::fabs(static_cast<double>(scan.angle_step_rad)));
}

/// Variances of the match and of what the wheels may have slipped on the way, as of (x, y, turn).
Eigen::Matrix3d information_of(const SurfelFit& fit, const std::vector<WheelTurns>& way, const RobotGeometry& g) {
  double left_m = 0.0, right_m = 0.0;
  for (std::size_t k = 1; k < way.size(); ++k) {
    left_m += std::fabs(way[k].left_rad - way[k - 1].left_rad) * g.left_radius_m;
    right_m += std::fabs(way[k].right_rad - way[k - 1].right_rad) * g.right_radius_m;
  }
  const double slip_m2 = kSlip_m * kSlip_m * (left_m + right_m), turn = slip_m2 / (g.track_width_m * g.track_width_m);
  const double lever_m = 0.25 * (left_m + right_m) + norm(g.robot_from_laser.position());
  const double way_m2 = 0.25 * slip_m2 + turn * lever_m * lever_m;
  const Eigen::Matrix3d points = fit.points + diagonal(1e-3, 1e-3, 1e-3);
  const Eigen::Matrix3d covariance =
      kPoint_m * kPoint_m * Eigen::Matrix3d(points.inverse()) +
      diagonal(kMatch_m * kMatch_m + way_m2, kMatch_m * kMatch_m + way_m2, kMatch_rad * kMatch_rad + turn);
  return covariance.inverse();
}

std::vector<Motion> match_all(const CalibrationLog& log, const RobotGeometry& g) {
  std::vector<Motion> motions;
  std::vector<Surfel> before, after;
  for (std::size_t k = 0; k + 1 < log.scans().size(); ++k) {
    before = k == 0 ? surfels_at_stamp(log.scans()[0], log, g) : std::move(after);
    after = surfels_at_stamp(log.scans()[k + 1], log, g);
    Motion motion{.way = log.between(log.scans()[k].stamp, log.scans()[k + 1].stamp),
                  .seen = {},
                  .information = Eigen::Matrix3d::Identity()};
    if (motion.way.empty() || before.size() < kLeastSurfels || after.size() < kLeastSurfels) continue;
    const SurfelFit fit = fit_surfels(laser_motion(motion.way, g), before, after, 0.0);
    if (fit.used < 0.5 * static_cast<double>(after.size()) || fit.left_m > kMostResidual_m || fit.across < kLeastAcross)
      continue;
    motion.seen = fit.before_from_after;
    motion.information = information_of(fit, motion.way, g);
    motions.push_back(std::move(motion));
  }
  return motions;
}

Eigen::Vector3d residual(const Motion& motion, const Vector6& p) {
  return offset(motion.seen, laser_motion(motion.way, geometry_of(p)));
}

/// By central differences.
Eigen::Matrix<double, 3, 6> jacobian(const Motion& motion, const Vector6& p) {
  constexpr double kStep = 1e-6;
  Eigen::Matrix<double, 3, 6> columns;
  for (int k = 0; k < 6; ++k) {
    Vector6 high = p, low = p;
    high[k] += kStep;
    low[k] -= kStep;
    columns.col(k) = (residual(motion, high) - residual(motion, low)) / (2.0 * kStep);
  }
  return columns;
}

struct Solution {
  Vector6 p;
  Matrix6 information;
};

/// Gauss and Newton over the motions in use.
Solution solve(const std::vector<Motion>& motions, const Vector6& believed, Vector6 p) {
  const Matrix6 prior = prior_of(believed);
  Matrix6 information = prior;
  for (int k = 0; k < kIterations; ++k) {
    information = prior;
    Vector6 gradient = prior * (believed - p);
    for (const Motion& motion : motions) {
      if (!motion.used) continue;
      const Eigen::Matrix<double, 3, 6> j = jacobian(motion, p);
      const Eigen::Matrix<double, 6, 3> weighted = j.transpose() * motion.information;
      information += weighted * j;
      gradient -= weighted * residual(motion, p);
    }
    const Vector6 step = information.ldlt().solve(gradient);
    p += step;
    if (step.cwiseAbs().maxCoeff() < 1e-9) break;
  }
  return {p, information};
}

double chi_squared(const Motion& motion, const Vector6& p) {
  const Eigen::Vector3d e = residual(motion, p);
  return e.dot(motion.information * e);
}

/// By what the motions' chi-squared is greater than it should be: 1 where the variances are right.
double scale_of(const std::vector<Motion>& motions, const Vector6& p) {
  std::vector<double> all;
  for (const Motion& motion : motions) all.push_back(chi_squared(motion, p));
  const auto middle = all.begin() + static_cast<std::ptrdiff_t>(all.size() / 2);
  std::nth_element(all.begin(), middle, all.end());
  return *middle / kMedian3;
}

std::vector<Pose2> residuals(const std::vector<Motion>& motions, const Vector6& p) {
  std::vector<Pose2> all;
  for (const Motion& motion : motions) {
    const Eigen::Vector3d e = residual(motion, p);
    if (motion.used) all.push_back({e[0], e[1], e[2]});
  }
  return all;
}

constexpr std::size_t kMostKeptScans = 2000;
/// A scan is kept after so much way of the middle, or so much turn.
constexpr double kApart_m = 0.4, kApart_rad = 0.5;
constexpr Duration kLongestGap = std::chrono::milliseconds(250);  ///< between readings: what was between is not known

WheelTurns between_two(const WheelTurns& a, const WheelTurns& b, Time stamp) {
  const double span = to_seconds(b.stamp - a.stamp), share = span > 0.0 ? to_seconds(stamp - a.stamp) / span : 0.0;
  return {stamp, a.left_rad + share * (b.left_rad - a.left_rad), a.right_rad + share * (b.right_rad - a.right_rad)};
}

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
  if (scan.stamp < wheels_.front().stamp || scans_.size() >= kMostKeptScans || !is_far_from_last()) return;
  at_last_scan_ = wheels_.back();
  scans_.push_back(scan);
}

WheelTurns CalibrationLog::at(Time stamp) const {
  if (wheels_.size() < 2) return wheels_.empty() ? WheelTurns{} : wheels_.front();
  const auto after = std::ranges::upper_bound(wheels_.begin() + 1, wheels_.end() - 1, stamp, {}, &WheelTurns::stamp);
  return between_two(*(after - 1), *after, stamp);
}

std::vector<WheelTurns> CalibrationLog::between(Time from, Time to) const {
  std::vector<WheelTurns> way{at(from)};
  for (auto next = std::ranges::upper_bound(wheels_, from, {}, &WheelTurns::stamp);
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

RobotGeometry believed_of(const RobotModel& model, std::size_t scanner) {
  const DriveModel& drive = model.drive;
  return {drive.wheel_radius_m, drive.wheel_radius_m, drive.track_width_m, model.lasers()[scanner].robot_from_laser};
}

Calibration calibrate(const CalibrationLog& log, const RobotGeometry& believed, const std::string& scans) {
  const Vector6 first = vector_of(believed);
  Solution solution{first, prior_of(first)};
  std::vector<Motion> motions;
  double scale = 1.0;
  for (int round = 0; round < kRounds; ++round) {
    motions = match_all(log, geometry_of(solution.p));
    if (motions.size() < kLeastMotions)
      throw StartupError(
          "calibrate: only " + std::to_string(motions.size()) + " motions show in " + scans + " and wheels alike",
          "drive farther, straight on and round, in a room with walls on several sides");
    solution = solve(motions, first, solution.p);
    scale = scale_of(motions, solution.p);
    for (Motion& motion : motions) motion.used = chi_squared(motion, solution.p) < kMost3 * std::max(scale, 0.01);
    solution = solve(motions, first, solution.p);
  }
  const Matrix6 covariance = std::max(1.0, scale) * Matrix6(solution.information.ldlt().solve(Matrix6::Identity()));
  Calibration calibration;
  calibration.found = geometry_of(solution.p);
  const Vector6 within = kSigmas95 * covariance.diagonal().cwiseSqrt();
  calibration.within = {within[0], within[1], within[2], {within[3], within[4], within[5]}};
  calibration.before = residuals(motions, first);
  calibration.after = residuals(motions, solution.p);
  calibration.left_out = motions.size() - calibration.after.size();
  return calibration;
}

}  // namespace jaywalk
