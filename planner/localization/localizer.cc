#include "planner/localization/localizer.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "planner/localization/correlative_search.h"
#include "planner/localization/odometry.h"
#include "planner/localization/odometry_noise.h"
#include "planner/localization/pose_belief.h"
#include "planner/localization/scan_matcher.h"
#include "planner/scan/scan_points.h"

namespace jaywalk {
namespace {
// Added after each match: the map's own errors are the same from scan to scan, so that many do not make a sure one.
constexpr double kMatchPositionVar = 0.0009 * 0.0009;
constexpr double kMatchHeadingVar = 0.00035 * 0.00035;

// Share of the points: where so much lies on walkers the map holds walkers that have only come, or turn on the spot,
// and wheels know better. By trial; half does not do (decision localization).
constexpr double kAmongWalkers = 0.2;

// Mean fit of scans to the map over some metres: below the lower the map no longer explains them, above the upper it
// does again. A robot that comes back to where its map was drawn long ago finds it off by the drift since. By trial on
// Edmonton, where fits fall to 0.3; elsewhere they stay above 0.7 but for moments
// (docs/explanation/results.md#tracking-and-poses).
constexpr double kLostMapFit = 0.7, kFoundMapFit = 0.8, kMapFitWayM = 6.0;
// Keyframes know no free space, and their points' errors are their own.
constexpr double kSubmapKernelM = 0.2, kSubmapIndependentShare = 0.5;

/// The covariance after a step by (dx, dy) in the map: a heading error turns the whole step. P <- F P F^T.
Eigen::Matrix3d propagated(const Eigen::Matrix3d& p, double dx, double dy) {
  Eigen::Matrix3d f = Eigen::Matrix3d::Identity();
  f(0, 2) = -dy, f(1, 2) = dx;
  return f * p * f.transpose();
}

Eigen::Matrix3d of_wheels(const OdometryNoise& noise, double metres, double turns) {
  return diagonal(metres * noise.position_var, metres * noise.position_var, turns * noise.heading_var);
}

/// Of two wheels that were counted over a silence it is not known which went first: the place is off by the arc's
/// height.
Eigen::Matrix3d unknown_way(const ArcStep& step) {
  const double height_m = 0.5 * step.distance_m * step.turn_rad;
  return diagonal(height_m * height_m, height_m * height_m, 0.0);
}

/// What is kept for one scanner.
struct ScannerState {
  Pose2 robot_from_laser;
  ScanProjection projection{};
  SlipDetector matcher{};
  std::uint32_t seen = 0;
  Pose2 odom_from_robot{};  ///< at its newest scan
};

}  // namespace

struct Localizer::State {
  explicit State(const LocalizationConfig& c)
      : config(c),
        odometry(c.drive),
        map_from_odom(c.map_from_robot_at_start),
        covariance(diagonal(kLeastPositionVar, kLeastPositionVar, kLeastHeadingVar)),
        since_last_match(covariance),
        if_wheels_slipped(covariance),
        at_last_wheels(covariance) {
    for (const Pose2& mount : OfEach<Pose2>(c.robot_from_laser, c.robot_from_others)) scanners.push_back({mount});
    publish();
  }

  void move_by_wheels(const WheelState& wheels) noexcept {
    const bool bridges = odometry.bridges(wheels);
    if (bridges) covariance = since_last_match = if_wheels_slipped = at_last_wheels;
    const Pose2 before = map_from_odom * odometry.odom_from_robot();
    const ArcStep step = odometry.take(wheels);
    const Pose2 after = map_from_odom * odometry.odom_from_robot();
    if (bridges) end_silence(step, after, wheels.stamp);
    twist = odometry.twist();
    const double dx = after.x - before.x, dy = after.y - before.y;
    const OdometryNoise noise = noise_of_unknown_wheels(step);
    covariance = propagated(covariance, dx, dy) + of_wheels(noise, odometry_noise.metres(), odometry_noise.turns());
    since_last_match =
        propagated(since_last_match, dx, dy) + of_wheels(noise, odometry_noise.metres(), odometry_noise.turns());
    if_wheels_slipped = propagated(if_wheels_slipped, dx, dy) + of_wheels(noise, 1.0, 1.0);
    odometry_noise.drove(step);
    radius_bias.drove(step);
    at_last_wheels = covariance;
  }

  void place_scan(const LaserScan& scan, const EvidenceMap& still, std::span<const Track> moving) noexcept {
    const bool late = order.behind_s(scan) < 0.0;
    const Pose2 odom_from_robot_at_newest = odom_from_robot_at_scan;
    if (!late && odometry.wheels_silent(scan.stamp)) coast_to(scan.stamp);
    odom_from_robot_at_scan = odometry.at(scan.stamp);
    const bool matched = match(scan, still, moving);
    scanners[scan.scanner].odom_from_robot = odom_from_robot_at_scan;
    const Pose2 there = map_from_odom * odom_from_robot_at_scan;
    if (!doubt.is_doubtful()) submap.add(sample, there);
    if (matched) doubt.matched(), odometry.placed();
    if (late) {  // how it goes on is told by the newest
      odom_from_robot_at_scan = odom_from_robot_at_newest;
      return;
    }
    scanner = scan.scanner;
    if (matched) {
      coasting.placed(there, scan.stamp);
    } else {
      coasting.not_placed(there, scan.stamp);
    }
    scan_stamp = scan.stamp;
    if (!odometry.by_wheels()) twist = coasting.twist();
  }

  void blend(const OutsideFix& fix) noexcept {
    if (!is_usable(fix) || !odometry.remembers(fix.stamp)) return;
    const Pose2 odom_from_robot = odometry.at(fix.stamp);
    const PoseBelief predicted{map_from_odom * odom_from_robot, covariance};
    const FixGate::Verdict verdict = fix_gate.judge(predicted, doubt.is_doubtful(), fix, odom_from_robot);
    if (verdict == FixGate::Verdict::kPassOver) return;
    const bool lost = verdict == FixGate::Verdict::kTake;
    const PoseBelief now = lost ? PoseBelief{fix.map_from_robot, covariance_of(fix)} : blended(predicted, fix);
    covariance = now.covariance;
    if (lost) submap.begin_anew();
    begin_anew();
    correct_to(now.map_from_robot, odom_from_robot);
  }

  void publish() noexcept {
    map_from_robot_at_scan = map_from_odom * odom_from_robot_at_scan;
    estimate = {.stamp = odometry.stamp(),
                .map_from_robot = map_from_odom * odometry.odom_from_robot(),
                .position_std_m = std::sqrt(0.5 * (covariance(0, 0) + covariance(1, 1))),
                .heading_std_rad = std::sqrt(covariance(2, 2)),
                .doubtful = doubt.is_doubtful()};
  }

  /// Wheels counted on over a silence: what was guessed meanwhile is forgotten.
  void end_silence(const ArcStep& way, const Pose2& map_from_robot, Time stamp) noexcept {
    doubt.counted_on();
    covariance += unknown_way(way);
    coasting = {};
    coasting.placed(map_from_robot, stamp);
    odom_from_robot_at_scan = odometry.odom_from_robot();
    map_from_robot_at_scan = map_from_robot;
    scan_stamp = stamp;
  }

  void coast_to(Time stamp) noexcept {
    const Coasting::Step step = coasting.step(odometry.stamp(), stamp);
    odometry.coast(step.before_from_after, stamp);
    const double position_var = step.metres_std * step.metres_std;
    const Eigen::Matrix3d more = diagonal(position_var, position_var, step.radians_std * step.radians_std);
    covariance += more;
    since_last_match += more;
    if_wheels_slipped = covariance;
    if (config.doubts && odometry.has_wheels()) doubt.coasted(step);
  }

  [[nodiscard]] bool match(const LaserScan& scan, const EvidenceMap& still, std::span<const Track> moving) noexcept {
    if (!config.match_scans || doubt.is_doubtful()) return false;
    ScannerState& own = scanners[scan.scanner];
    own.projection.project(scan, own.robot_from_laser, twist, points);
    const Pose2 predicted = map_from_odom * odom_from_robot_at_scan;
    const auto seen = static_cast<double>(points.size());
    mask_moving_tracks(moving, predicted, scan.stamp, points);
    sample = sample_of(points);
    const bool among_walkers = static_cast<double>(points.size()) < (1.0 - kAmongWalkers) * seen;
    const bool learnt = odometry.by_wheels() && !odometry_noise.nothing_known();
    const MatchResult found =
        own.matcher.match(sample, still, {predicted, covariance, if_wheels_slipped, learnt, coasted(scan.stamp)});
    if (found.matched || found.contradicted) judge_map(found, predicted);
    if (among_walkers && odometry.by_wheels() && !found.known_for_long) return false;
    if (!map_explains && match_submap(predicted)) return true;
    if (!found.matched) return false;
    take(found.belief, predicted);
    covariance = if_wheels_slipped = since_last_match;
    return true;
  }

  /// How well the map explains scans, over the last metres.
  void judge_map(const MatchResult& found, const Pose2& predicted) noexcept {
    const double way_m = distance(map_from_robot_at_scan.position(), predicted.position());
    map_fit += std::min(1.0, way_m / kMapFitWayM) * ((found.matched ? found.fit : 0.0) - map_fit);
    map_explains = map_fit > (map_explains ? kLostMapFit : kFoundMapFit);
  }

  /// Where the map does not explain scans any more: by the last keyframes. False where they do not match either.
  [[nodiscard]] bool match_submap(const Pose2& predicted) noexcept {
    const ScanReference keyframes{submap.about(predicted.position()), kSubmapKernelM, kSubmapIndependentShare, 0};
    const MatchResult found = match_sample(sample, keyframes, {predicted, since_last_match});
    if (!found.matched || !finite(found.belief.map_from_robot)) return false;
    take(found.belief, predicted);
    return true;
  }

  void take(const PoseBelief& found, const Pose2& predicted) noexcept {
    correct_to(found.map_from_robot, odom_from_robot_at_scan);
    since_last_match = found.covariance + diagonal(kMatchPositionVar, kMatchPositionVar, kMatchHeadingVar);
    learn(predicted, found.map_from_robot);
  }

  /// What matches put right, to what learns of wheels.
  void learn(const Pose2& predicted, const Pose2& placed) noexcept {
    if (!odometry.by_wheels()) {
      radius_bias.begin_anew();
      return;
    }
    odometry_noise.corrected(predicted, placed);
    radius_bias.corrected(wrap_angle(placed.heading - predicted.heading));
    odometry.set_radius_bias(radius_bias.turn_per_m());
  }

  /// Where it would be had it gone on as it went.
  [[nodiscard]] PoseBelief coasted(Time stamp) const noexcept {
    const Coasting::Step step = coasting.step(scan_stamp, stamp);
    const double position_var = step.metres_std * step.metres_std;
    return {map_from_robot_at_scan * step.before_from_after,
            covariance + diagonal(position_var, position_var, step.radians_std * step.radians_std)};
  }

  /// Forgets what was learnt of the wheels since the last match: a fix tells the place.
  void begin_anew() noexcept {
    since_last_match = if_wheels_slipped = at_last_wheels = covariance;
    odometry.placed();
    doubt.settle();
    odometry_noise.begin_anew();
    radius_bias.begin_anew();
  }

  /// The map_from_odom that puts `odom_from_robot` at `map_from_robot`.
  void correct_to(const Pose2& map_from_robot, const Pose2& odom_from_robot) noexcept {
    map_from_odom = map_from_robot * inverse(odom_from_robot);
  }

  LocalizationConfig config;
  Odometry odometry;
  Pose2 map_from_odom;
  Eigen::Matrix3d covariance;         ///< of (x, y, heading) in the map
  Eigen::Matrix3d since_last_match;   ///< the same against the keyframes: what the wheels may have erred since
  Eigen::Matrix3d if_wheels_slipped;  ///< the same, had nothing been known of the wheels since the last match

  OdometryNoiseEstimator odometry_noise;
  WheelRadiusBias radius_bias;
  Submap submap;
  double map_fit = 1.0;  ///< running mean
  bool map_explains = true;
  ScanPoints points;  ///< of the last scan, and those of them that are matched
  MatchSample sample;
  std::uint32_t wheels_seen = 0, fix_seen = 0;
  std::vector<ScannerState> scanners;
  ScanOrder order;
  std::size_t scanner = 0;        ///< of the scan that was taken last
  Pose2 odom_from_robot_at_scan;  ///< at it
  Time scan_stamp = kNever;

  Coasting coasting;               ///< while wheels say nothing
  Eigen::Matrix3d at_last_wheels;  ///< covariance when they spoke last
  PoseDoubt doubt;
  FixGate fix_gate;
  Twist2 twist;

  PoseEstimate estimate;
  Pose2 map_from_robot_at_scan;
};

Localizer::Localizer(const LocalizationConfig& config) : state_(std::make_unique<State>(config)) {}
Localizer::~Localizer() = default;

const PoseEstimate& Localizer::update(const WheelState& wheels, const LaserScan& scan, const OutsideFix& fix,
                                      const EvidenceMap& still, std::span<const Track> moving) noexcept {
  State& s = *state_;
  if (std::exchange(s.wheels_seen, wheels.sequence) != wheels.sequence) s.move_by_wheels(wheels);
  std::uint32_t& seen = s.scanners[scan.scanner].seen;
  if (scan.sequence != 0 && std::exchange(seen, scan.sequence) != scan.sequence) s.place_scan(scan, still, moving);
  if (std::exchange(s.fix_seen, fix.sequence) != fix.sequence && fix.has_pose) s.blend(fix);
  s.publish();
  return s.estimate;
}

void Localizer::carried() noexcept {
  if (state_->config.doubts) state_->doubt.carried();
}

Pose2 Localizer::map_from_robot_at_scan(std::size_t scanner) const noexcept {
  const State& s = *state_;
  return scanner == s.scanner ? s.map_from_robot_at_scan : s.map_from_odom * s.scanners[scanner].odom_from_robot;
}
const Twist2& Localizer::twist() const noexcept { return state_->twist; }

}  // namespace jaywalk
