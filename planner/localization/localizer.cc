#include "planner/localization/localizer.h"

#include <algorithm>
#include <cmath>

#include "planner/localization/odometry.h"
#include "planner/localization/scan_matcher.h"

namespace jaywalk {
namespace {

// Wheel odometry drifts as a random walk: 5 cm after a metre, 2 degrees a metre and 4 degrees a turn of one radian.
constexpr double kPositionVarPerM = 0.05 * 0.05;
constexpr double kPositionVarPerRad = 0.15 * 0.15;  // a laser that is not where it is said to be, slip in turns
constexpr double kHeadingVarPerM = 0.035 * 0.035;
constexpr double kHeadingVarPerRad = 0.07 * 0.07;

// Without wheels the robot keeps its speed from scan to scan within what a wheelchair can accelerate by.
constexpr double kAccelStd = 1.5;                         // m/s^2
constexpr double kTurnAccelStd = 3.0;                     // rad/s^2
constexpr double kLongestCoastS = 1.0;                    // after a longer gap it is taken to have stood
constexpr double kFastestMps = 2.5, kFastestRadps = 3.0;  // beyond, the match was wrong
constexpr double kForget = 0.8;                           // of the speed, a scan that did not match
constexpr double kTwistGain = 0.7;                        // of the running mean of speeds between matches

// No map of 10 cm cells places a robot better than this, however often it is asked.
constexpr double kLeastPositionVar = 0.005 * 0.005;
constexpr double kLeastHeadingVar = 0.002 * 0.002;

bool finite(const Pose2& p) { return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.heading); }

}  // namespace

struct Localizer::State {
  explicit State(const LocalizationConfig& c)
      : config(c),
        odometry(c.drive),
        map_from_odom(c.map_from_robot_at_start),
        covariance(diagonal(kLeastPositionVar, kLeastPositionVar, kLeastHeadingVar)) {
    publish();
  }

  void move_by_wheels(const WheelState& wheels) noexcept;
  void coast_to(Time stamp) noexcept;
  void place_scan(const LaserScan& scan, const EvidenceMap& still) noexcept;
  void learn_twist(const Pose2& placed, Time stamp) noexcept;
  void forget_twist(Time stamp) noexcept;
  void blend(const OutsideFix& fix) noexcept;
  /// The map_from_odom that puts `odom_from_robot` at `map_from_robot`.
  void correct_to(const Pose2& map_from_robot, const Pose2& odom_from_robot) noexcept {
    map_from_odom = map_from_robot * inverse(odom_from_robot);
  }
  void publish() noexcept;

  LocalizationConfig config;
  Odometry odometry;
  Pose2 map_from_odom;
  Symmetric3 covariance;  ///< of (x, y, heading) in the map

  ScanMatcher matcher;
  ScanPoints points;
  std::uint32_t wheels_seen = 0, scan_seen = 0, fix_seen = 0;
  Time scan_stamp = kNever;
  Pose2 odom_from_robot_at_scan;

  // Without wheels:
  Pose2 last_placed;
  Time last_placed_stamp = kNever;
  Vec2 velocity_in_robot;
  double turn_radps = 0.0;
  Twist2 twist;

  PoseEstimate estimate;
  Pose2 map_from_robot_at_scan;
};

void Localizer::State::move_by_wheels(const WheelState& wheels) noexcept {
  const Pose2 before = map_from_odom * odometry.odom_from_robot();
  const ArcStep step = odometry.take(wheels);
  const Pose2 after = map_from_odom * odometry.odom_from_robot();
  twist = odometry.twist();
  // A heading error turns the whole step: P <- F P F^T with F = I + (-dy, dx) in the heading's column.
  Symmetric3& p = covariance;
  const double dx = after.x - before.x, dy = after.y - before.y;
  p.xx += -2.0 * dy * p.xh + dy * dy * p.hh;
  p.yy += 2.0 * dx * p.yh + dx * dx * p.hh;
  p.xy += dx * p.xh - dy * p.yh - dx * dy * p.hh;
  p.xh -= dy * p.hh;
  p.yh += dx * p.hh;
  const double metres = std::fabs(step.distance_m), radians = std::fabs(step.turn_rad);
  const double position_var = kPositionVarPerM * metres + kPositionVarPerRad * radians;
  p = p + diagonal(position_var, position_var, kHeadingVarPerM * metres + kHeadingVarPerRad * radians);
}

void Localizer::State::coast_to(Time stamp) noexcept {
  const bool gap = last_placed_stamp == kNever || stamp <= last_placed_stamp ||
                   to_seconds(stamp - last_placed_stamp) > kLongestCoastS;
  const double dt = gap ? 0.0 : to_seconds(stamp - last_placed_stamp);
  odometry.coast({velocity_in_robot.x * dt, velocity_in_robot.y * dt, turn_radps * dt}, stamp);
  const double metres = kAccelStd * dt * std::max(dt, 0.1), radians = kTurnAccelStd * dt * std::max(dt, 0.1);
  covariance = covariance + diagonal(metres * metres, metres * metres, radians * radians);
}

void Localizer::State::learn_twist(const Pose2& placed, Time stamp) noexcept {
  const double dt = last_placed_stamp == kNever ? 0.0 : to_seconds(stamp - last_placed_stamp);
  const Pose2 step = inverse(last_placed) * placed;
  const bool believable = dt > 0.0 && dt < kLongestCoastS && norm(step.position()) < kFastestMps * dt &&
                          std::fabs(step.heading) < kFastestRadps * dt;
  if (believable) {
    velocity_in_robot = velocity_in_robot + (step.position() * (1.0 / dt) - velocity_in_robot) * kTwistGain;
    turn_radps += (step.heading / dt - turn_radps) * kTwistGain;
  } else {
    velocity_in_robot = {};
    turn_radps = 0.0;
  }
  last_placed = placed;
  last_placed_stamp = stamp;
  twist = {velocity_in_robot.x, turn_radps};
}

void Localizer::State::forget_twist(Time stamp) noexcept {
  velocity_in_robot = velocity_in_robot * kForget;
  turn_radps *= kForget;
  last_placed = map_from_odom * odom_from_robot_at_scan;
  last_placed_stamp = stamp;
  twist = {velocity_in_robot.x, turn_radps};
}

void Localizer::State::place_scan(const LaserScan& scan, const EvidenceMap& still) noexcept {
  const bool wheels = odometry.has_wheels();
  if (!wheels) coast_to(scan.stamp);
  scan_stamp = scan.stamp;
  odom_from_robot_at_scan = odometry.at(scan.stamp);
  bool matched = false;
  if (config.match_scans) {
    project_scan(scan, config.robot_from_laser, twist, points);
    const MatchResult found = matcher.match(points, still, {map_from_odom * odom_from_robot_at_scan, covariance});
    matched = found.matched && finite(found.belief.map_from_robot);
    if (matched) {
      correct_to(found.belief.map_from_robot, odom_from_robot_at_scan);
      covariance = found.belief.covariance + diagonal(kLeastPositionVar, kLeastPositionVar, kLeastHeadingVar);
    }
  }
  if (wheels) return;
  if (matched) {
    learn_twist(map_from_odom * odom_from_robot_at_scan, scan.stamp);
  } else {
    forget_twist(scan.stamp);
  }
}

void Localizer::State::blend(const OutsideFix& fix) noexcept {
  if (!finite(fix.map_from_robot)) return;
  const Pose2 odom_from_robot = odometry.at(fix.stamp);
  const Pose2 predicted = map_from_odom * odom_from_robot;
  const double position_var = std::max(fix.position_std_m * fix.position_std_m, kLeastPositionVar);
  const double heading_var = std::max(fix.heading_std_rad * fix.heading_std_rad, kLeastHeadingVar);
  const Symmetric3 fix_information = diagonal(1.0 / position_var, 1.0 / position_var, 1.0 / heading_var);
  covariance = inverse(inverse(covariance) + fix_information);
  const Pose2& m = fix.map_from_robot;
  const Row3 step = covariance * (fix_information * Row3{m.x - predicted.x, m.y - predicted.y,
                                                         wrap_angle(m.heading - predicted.heading)});
  correct_to({predicted.x + step.x, predicted.y + step.y, wrap_angle(predicted.heading + step.heading)},
             odom_from_robot);
}

void Localizer::State::publish() noexcept {
  map_from_robot_at_scan = map_from_odom * odom_from_robot_at_scan;
  estimate = {.stamp = odometry.stamp(),
              .map_from_robot = map_from_odom * odometry.odom_from_robot(),
              .position_std_m = std::sqrt(0.5 * (covariance.xx + covariance.yy)),
              .heading_std_rad = std::sqrt(covariance.hh)};
}

Localizer::Localizer(const LocalizationConfig& config) : state_(std::make_unique<State>(config)) {}
Localizer::~Localizer() = default;

const PoseEstimate& Localizer::update(const WheelState& wheels, const LaserScan& scan, const OutsideFix& fix,
                                      const EvidenceMap& still) noexcept {
  State& s = *state_;
  if (wheels.sequence != s.wheels_seen) s.move_by_wheels(wheels);
  if (scan.sequence != s.scan_seen) s.place_scan(scan, still);
  if (fix.sequence != s.fix_seen && fix.has_pose) s.blend(fix);
  s.wheels_seen = wheels.sequence;
  s.scan_seen = scan.sequence;
  s.fix_seen = fix.sequence;
  s.publish();
  return s.estimate;
}

const Pose2& Localizer::map_from_robot_at_scan() const noexcept { return state_->map_from_robot_at_scan; }
const Twist2& Localizer::twist() const noexcept { return state_->twist; }

}  // namespace jaywalk
