#include "firmware/safety/motion_model.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace jaywalk {
namespace {
/// Of what a wheel rolls: less where it slips (to 0.4 on ice, docs), more by worn or pumped-up tyres alone.
constexpr double kLeastGain = 0.35, kMostGain = 1.12;
/// Tangent of the most that the mount may be turned: 8 degrees.
constexpr double kMostYaw = 0.12;
/// Beyond the bounds: clocks, and of the track's width.
constexpr double kSlack_m = 0.006, kTrackShare = 0.05;
/// Two scans are compared once a wheel rolled that far, or the robot turned that far, and no more after the larger.
constexpr double kLeast_m = 0.04, kLeast_rad = 0.05, kMost_m = 0.15, kMost_rad = 0.2;
constexpr Duration kOldestKept = std::chrono::milliseconds(1000);  ///< of a kept scan: people move
/// Least share of the points compared as the wheels have it that a fit compares.
constexpr double kCompared = 0.8;
/// The evidence of an arc counts at most so many times that of its sectors without the kPeople strongest: a pedestrian
/// that walks along with the robot stands in no more. It costs 2 of 100 frozen sectors that were told in 0.5 s
/// (safety_tests "[trials]"), 4 would cost 11. With 16, one of the four robots beside such pedestrians still stops.
constexpr double kOthers = 8.0;
/// Natural logarithms of likelihood ratios; what a pair less decays between pairs.
constexpr double kEvidence = 10.0, kBlind = 27.0, kDrift = 3.0, kMoves = 4.0;
/// A blind sector pulls the match towards itself: what it gains over it counts threefold. More than twice what it
/// could gain on average, by its walls' directions, is chance.
constexpr double kPulled = 3.0, kChance = 2.0;
constexpr double kBlind_rad = 0.7;  ///< no pedestrian is as wide at a metre
constexpr int kTimes = 2, kBoundSteps = 3, kSweeps = 50;
/// Gain over metres: advantage a point from which on a match tells another than the wheels, slip's share of a pair as a
/// standard deviation, what the file may be off by, and the least.
constexpr double kTells = 0.5, kSlip = 0.2, kFile = 0.05, kLastingGain = 0.8, kForget = 0.93;
/// Share of beams to the last bit, of so many scans, while a wheel rolled so far.
constexpr double kRepeated = 0.875, kRepeatedFor_m = 0.1;
constexpr int kRepeats = 2;

}  // namespace

MotionModel::MotionModel(const RobotModel& model, std::size_t scanner)
    : drive_(model.drive),
      late_m_(model.drive.times.late_s *
              (model.limits.max_speed_mps + 0.5 * model.drive.track_width_m * model.limits.max_turn_radps)),
      felt_motion_(model.drive, model.limits),
      pair_(model.lasers()[scanner].robot_from_laser),
      travel_(model.drive),
      gain_var_(kFile * kFile) {}

Reason MotionModel::judge(const LaserScan& scan, const WheelState& wheels, const WheelCommand& sent,
                          Time now) noexcept {
  travel_.note(wheels);
  if (scan.sequence != scan_seen_ && scan.sequence != 0 && travel_.newest() >= scan.stamp) {
    scan_seen_ = scan.sequence;
    if (pair_.usable(scan) && look(scan) && times_ >= kTimes) contradicted_ = now;
  }
  Reason reasons = felt_motion_.disobeys(sent, wheels, now) ? Reason::kWheelsDisobey : Reason::kNone;
  if (frozen_) reasons |= Reason::kScanFrozen;
  if (contradicted_ != kNever && now - contradicted_ < kHolds) reasons |= Reason::kMotionMismatch;
  return reasons;
}

bool MotionModel::look(const LaserScan& scan) noexcept {
  const std::optional<Rolled> read = travel_.at(scan.stamp);
  if (!read) return false;
  const Rolled& rolled = *read;
  note_repeats(scan, rolled);
  if (repeats_ > 0) return false;  // it tells nothing new: kScanFrozen, a fault that ends with it, is its word
  pair_.sweep(scan, travel_.twist_since(scan.stamp, rolled));
  const Rolled felt = rolled - kept_rolled_;
  const double path_m = farther_m(felt);
  const double turn_rad = std::fabs(felt.right_m - felt.left_m) / drive_.track_width_m;
  const bool too_old = !pair_.is_kept() || scan.stamp - kept_stamp_ > kOldestKept || scan.stamp < kept_stamp_;
  const bool compares = !too_old && (path_m >= kLeast_m || turn_rad >= kLeast_rad);
  if (compares) compare(scan, felt);
  const bool unexplained = !too_old && path_m >= kLeast_m && !fitted_;
  if (too_old || unexplained || path_m >= kMost_m || turn_rad >= kMost_rad) {
    if (fitted_ && !too_old) update_gain(felt);
    keep(scan, rolled);
  }
  return compares;
}

void MotionModel::note_repeats(const LaserScan& scan, const Rolled& rolled) noexcept {
  const bool repeats = pair_.repeated(scan) >= kRepeated;
  if (!repeats) at_first_ = rolled;
  repeats_ = repeats ? std::min(repeats_ + 1, kRepeats) : 0;
  frozen_ = repeats_ >= kRepeats && farther_m(rolled - at_first_) > kRepeatedFor_m;
}

void MotionModel::keep(const LaserScan& scan, const Rolled& rolled) noexcept {
  evidence_ = std::max(evidence_ + evidence_now_ - kDrift, 0.0);
  for (std::size_t first = 0; first + arc() <= blind_.size(); ++first)
    blind_[first] = std::clamp(blind_[first] + stands_from(first) - kDrift, 0.0, 2.0 * kBlind);
  evidence_now_ = 0.0;
  blind_now_ = {};
  fitted_ = false;
  pair_.keep(scan);
  kept_stamp_ = scan.stamp;
  kept_rolled_ = rolled;
  felt_before_ = {};
}

void MotionModel::compare(const LaserScan& scan, const Rolled& felt) noexcept {
  const Pose2 by_wheels = pose_of({felt.left_m, felt.right_m, 0.0});
  fit_ = best_fit(scan, felt);
  felt_before_ = felt;
  ScanPair::Fit as_felt{.kept_from_now = by_wheels, .noise_m = fit_.noise_m};
  pair_.improve(scan, as_felt);
  fitted_ = fit_.tells() && fit_.compared >= kCompared * as_felt.compared;
  evidence_now_ = 0.0;
  blind_now_ = {};
  if (fitted_) {
    const double noise = fit_.noise_m;
    const ScanPair::Errors free = pair_.errors(scan, fit_.kept_from_now);
    const ScanPair::Errors wheels = pair_.errors(scan, by_wheels);
    Pose2 bound = by_wheels;
    evidence_now_ = ScanPair::without_greatest(pair_.advantage(free, wheels, noise, false));
    against_wheels_ = ScanPair::total(pair_.advantage(free, wheels, noise, true));
    ScanPair::Fit inside = fit_;
    for (int step = 0; step < kBoundSteps; ++step) {  // Gauss-Newton in the box, from a projection to the next
      inside.kept_from_now = within_bounds(inside, felt);
      const ScanPair::Errors tried = pair_.errors(scan, inside.kept_from_now);
      const double evidence = ScanPair::without_greatest(pair_.advantage(free, tried, noise, false));
      if (evidence < evidence_now_) evidence_now_ = evidence, bound = inside.kept_from_now;
      pair_.improve(scan, inside);
    }
    evidence_now_ = std::max(evidence_now_, 0.0);
    const ScanPair::Errors standing = pair_.shown_again(scan);
    blind_now_ = pair_.advantage(standing, pair_.errors(scan, by_wheels, true), noise, true);
    const Costs over_bound = pair_.advantage(standing, pair_.errors(scan, bound, true), noise, true);
    const Costs most = pair_.gain_of_standing(scan, by_wheels, noise);
    for (std::size_t k = 0; k < blind_now_.size(); ++k)
      blind_now_[k] = std::min({blind_now_[k], kPulled * over_bound[k], kChance * most[k]});
  }
  const bool blind = is_blind();
  const bool moves_else = evidence_now_ > kDrift && evidence_ + evidence_now_ > kEvidence;
  const bool contradicts = moves_else || blind || gain_ < kLastingGain;
  if (evidence_ + evidence_now_ > 2.5 * kEvidence) times_ = kTimes;
  times_ = contradicts ? std::min(times_ + 1, kTimes) : 0;
}

std::size_t MotionModel::arc() const noexcept {
  return static_cast<std::size_t>(std::ceil(kBlind_rad / pair_.sector_rad()));
}

/// Evidence of this pair that the arc from sector `first` on stands still; `first` + arc() is at most kSectors.
double MotionModel::stands_from(std::size_t first) const noexcept {
  Costs says{};
  std::copy_n(blind_now_.begin() + first, arc(), says.begin());
  const auto end = says.begin() + arc(), most = end - ScanPair::kPeople;
  std::nth_element(says.begin(), most, end);
  const double others = std::accumulate(says.begin(), most, 0.0), all = std::accumulate(most, end, others);
  return std::min(all, kOthers * std::max(others, 0.0));
}

/// Of an arc no sector moves, and together they stand.
bool MotionModel::is_blind() const noexcept {
  for (std::size_t first = 0; first + arc() <= blind_.size(); ++first) {
    const auto from = blind_now_.begin() + first;
    const bool moves = std::any_of(from, from + arc(), [](double k) { return k < -kMoves; });
    if (!moves && blind_[first] + stands_from(first) > kBlind) return true;
  }
  return false;
}

/// From where the errors are least to begin with: as felt, as before, standing, wheels reversed or swapped.
ScanPair::Fit MotionModel::best_fit(const LaserScan& scan, const Rolled& felt) const noexcept {
  const double l = felt.left_m, r = felt.right_m;
  const Pose2 on = inverse(pose_of({felt_before_.left_m, felt_before_.right_m, 0.0})) * pose_of({l, r, 0.0});
  const std::array<Pose2, 7> starts{pose_of({l, r, 0.0}),
                                    fitted_ ? fit_.kept_from_now * on : Pose2{},
                                    {},
                                    pose_of({-l, -r, 0.0}),
                                    pose_of({-l, r, 0.0}),
                                    pose_of({l, -r, 0.0}),
                                    pose_of({r, l, 0.0})};
  return pair_.fit(scan, pair_.likeliest(scan, starts));
}

/// The most likely motion within the bounds: a quadratic form's least in a box, one coordinate after the other. Of
/// (left, right, aside, ahead beyond the wheels).
Pose2 MotionModel::within_bounds(const ScanPair::Fit& fit, const Rolled& felt) const noexcept {
  using Vector4 = Eigen::Vector4d;
  const Moved found = moved_to(fit.kept_from_now, drive_.track_width_m);
  const double apart_m = kTrackShare * std::fabs(felt.right_m - felt.left_m) + late_m_;
  const auto range = [&](double rolled_m) {
    const double least = kLeastGain * rolled_m, most = kMostGain * rolled_m;
    return std::pair{std::min(least, most) - apart_m, std::max(least, most) + apart_m};
  };
  const double aside = kMostYaw * 0.5 * std::fabs(felt.left_m + felt.right_m) + kSlack_m;
  const auto [least_left, most_left] = range(felt.left_m);
  const auto [least_right, most_right] = range(felt.right_m);
  const Vector4 least(least_left, least_right, -aside, -kSlack_m), most(most_left, most_right, aside, kSlack_m);
  const double track = drive_.track_width_m, c = cos(0.5 * fit.kept_from_now.heading),
               s = sin(0.5 * fit.kept_from_now.heading);
  Eigen::Matrix<double, 3, 4> robot_of_moved;  // a step in the robot's frame now
  robot_of_moved << 0.5 * c, 0.5 * c, s, c, -0.5 * s, -0.5 * s, c, -s, -1.0 / track, 1.0 / track, 0.0, 0.0;
  const Eigen::Matrix4d form = robot_of_moved.transpose() * fit.information * robot_of_moved;
  const Vector4 best(found.left_m, found.right_m, found.aside_m, 0.0);
  Vector4 at = best.cwiseMax(least).cwiseMin(most);
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    for (int k = 0; k < 4; ++k) at[k] = std::clamp(at[k] - form.row(k).dot(at - best) / form(k, k), least[k], most[k]);
  }
  return pose_of({at[0] + at[3], at[1] + at[3], at[2]});
}

void MotionModel::update_gain(const Rolled& felt) noexcept {
  const double ahead_m = 0.5 * (felt.left_m + felt.right_m);
  if (std::fabs(ahead_m) < kLeast_m) return;
  const Moved moved = moved_to(fit_.kept_from_now, drive_.track_width_m);
  const bool tells = against_wheels_ > kTells * fit_.compared;  // else the wheels explain it
  const double seen = tells ? 0.5 * (moved.left_m + moved.right_m) / ahead_m : 1.0;
  const double var = (fit_.information.inverse()(0, 0) + late_m_ * late_m_) / (ahead_m * ahead_m) + kSlip * kSlip;
  gain_var_ = std::min(gain_var_ / kForget, kFile * kFile);
  const double weight = gain_var_ / (gain_var_ + var);
  gain_ += weight * (std::clamp(seen, 0.0, 2.0) - gain_);
  gain_var_ *= 1.0 - weight;
}

Pose2 MotionModel::pose_of(const Moved& moved) const noexcept {
  const double turn = (moved.right_m - moved.left_m) / drive_.track_width_m;
  const Vec2 ahead = direction(0.5 * turn);
  const Vec2 way = ahead * (0.5 * (moved.left_m + moved.right_m)) + Vec2{-ahead.y, ahead.x} * moved.aside_m;
  return {way.x, way.y, turn};
}

}  // namespace jaywalk
