#include "firmware/safety/seen_motion.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace jaywalk {
namespace {

/// What a wheel's rolling would have to be multiplied with, and whether left is right.
struct Explanation {
  double left = 1.0, right = 1.0;
  bool swapped = false;

  template <class Rolled>
  [[nodiscard]] Rolled of(const Rolled& felt) const noexcept {
    const Rolled moved{left * felt.left_m, right * felt.right_m};
    return swapped ? Rolled{moved.right_m, moved.left_m} : moved;
  }
};

/// Slip within bounds: this share of what either wheel rolls, sought in halving steps, or of both.
constexpr double kMostSlip = 0.5;
constexpr int kSlipSteps = 5;
/// Of the left wheel, or, below zero, of the right one.
constexpr Explanation slip(double share) { return {1.0 - std::max(share, 0.0), 1.0 + std::min(share, 0.0)}; }
/// No grip, on both sides or one; reversed, both or one; swapped, or a scanner upside down; that and reversed, or a
/// scanner that looks backwards.
constexpr std::array<Explanation, 8> kWrong{
    {{0.0, 0.0}, {0.0, 1.0}, {1.0, 0.0}, {-1.0, -1.0}, {-1.0, 1.0}, {1.0, -1.0}, {1.0, 1.0, true}, {-1.0, -1.0, true}}};
/// What does not differ from the motion felt by one of these could be slip.
constexpr double kOther_m = 0.04, kOther_rad = 0.05;
/// Two scans are compared once a wheel rolled that far, or the robot turned that far, and no more after the larger.
constexpr double kLeast_m = 0.05, kLeast_rad = 0.05, kMost_m = 0.15, kMost_rad = 0.2;
constexpr Duration kOldest = std::chrono::milliseconds(500);  ///< of a kept scan: people move
constexpr double kMostError_m = 0.15;                         ///< whatever is farther off is something else
constexpr std::size_t kLeastCompared = 30;
/// A point votes where its two errors differ by this: the noise of a range.
constexpr float kVote_m = 0.01F;
/// Of all points, those that another motion explains better less those that it explains worse: three people who walk
/// beside the robot are less, the walls before it more (seen_motion_test).
constexpr double kShare = 0.2;
/// And what it leaves of the mean error at most.
constexpr double kLeft = 0.6;

}  // namespace

SeenMotion::SeenMotion(const RobotModel& model)
    : drive_(model.drive), robot_from_laser_(model.laser.robot_from_laser) {}

void SeenMotion::note(const WheelState& wheels) noexcept {
  if (wheels.sequence == wheels_seen_ || wheels.sequence == 0) return;
  wheels_seen_ = wheels.sequence;
  if (!std::isfinite(wheels.left_rad) || !std::isfinite(wheels.right_rad)) return;
  if (readings_[newest_].stamp >= wheels.stamp) return;
  newest_ = (newest_ + 1) % kMostReadings;
  readings_[newest_] = {wheels.stamp,
                        {drive_.wheel_radius_m * wheels.left_rad, drive_.wheel_radius_m * wheels.right_rad}};
}

/// Between the readings before and after; false where there are none.
bool SeenMotion::rolled_at(Time stamp, Rolled& rolled) const noexcept {
  const Reading* after = &readings_[newest_];
  if (after->stamp < stamp) return false;
  for (std::size_t back = 1; back < kMostReadings; ++back) {
    const Reading& before = readings_[(newest_ + kMostReadings - back) % kMostReadings];
    if (before.stamp == kNever || before.stamp > after->stamp) return false;
    if (before.stamp <= stamp) {
      const double share = to_seconds(stamp - before.stamp) / to_seconds(after->stamp - before.stamp);
      rolled = {before.rolled.left_m + share * (after->rolled.left_m - before.rolled.left_m),
                before.rolled.right_m + share * (after->rolled.right_m - before.rolled.right_m)};
      return true;
    }
    after = &before;
  }
  return false;
}

/// Whether its beams have directions; those are worked out anew where the scanner is another.
bool SeenMotion::usable(const LaserScan& scan) noexcept {
  if (scan.beam_count < 2 || scan.beam_count > kMaxBeams) return false;
  if (!std::isfinite(scan.first_angle_rad) || !(std::fabs(scan.angle_step_rad) > 1e-6F)) return false;
  if (scan.beam_count == beams_ && scan.first_angle_rad == first_angle_rad_ && scan.angle_step_rad == angle_step_rad_)
    return true;
  beams_ = scan.beam_count;
  first_angle_rad_ = scan.first_angle_rad;
  angle_step_rad_ = scan.angle_step_rad;
  for (std::size_t beam = 0; beam < beams_; ++beam) direction_[beam] = direction(scan.angle_rad(beam));
  kept_stamp_ = suspected_ = kNever;
  return true;
}

void SeenMotion::keep(const LaserScan& scan, const Rolled& rolled) noexcept {
  kept_.clear();
  kept_stamp_ = scan.stamp;
  kept_rolled_ = rolled;
  const Transform2 to_robot(robot_from_laser_);
  constexpr std::uint32_t kMost = kMostPoints;
  const std::uint32_t every = (scan.beam_count + kMost - 1) / kMost;
  for (std::uint32_t beam = every / 2; beam < scan.beam_count; beam += every) {
    if (!scan.is_hit(beam)) continue;
    const double range_m = scan.range_m[beam];
    if (!kept_.push_back({beam, scan.range_m[beam], to_robot * (direction_[beam] * range_m)})) break;
  }
}

/// The same scan to the last bit says nothing of motion: a frozen scanner is another fault's.
bool SeenMotion::is_kept_again(const LaserScan& scan) const noexcept {
  return std::all_of(kept_.begin(), kept_.end(),
                     [&](const Point& point) { return scan.range_m[point.beam] == point.range_m; });
}

bool SeenMotion::contradicts(const LaserScan& scan, const WheelState& wheels, Time now) noexcept {
  note(wheels);
  if (scan.sequence != scan_seen_ && scan.sequence != 0 && readings_[newest_].stamp >= scan.stamp) {
    scan_seen_ = scan.sequence;
    if (usable(scan)) look(scan);
    if (suspected_ != kNever && scan.stamp - suspected_ >= kFor) contradicted_ = now;
  }
  return contradicted_ != kNever && now - contradicted_ < kHolds;
}

void SeenMotion::look(const LaserScan& scan) noexcept {
  Rolled rolled;
  if (!rolled_at(scan.stamp, rolled)) return;
  const Rolled felt{rolled.left_m - kept_rolled_.left_m, rolled.right_m - kept_rolled_.right_m};
  const double path_m = std::max(std::fabs(felt.left_m), std::fabs(felt.right_m));
  const double turn_rad = std::fabs(felt.right_m - felt.left_m) / drive_.track_width_m;
  const bool too_old = kept_stamp_ == kNever || scan.stamp - kept_stamp_ > kOldest || scan.stamp < kept_stamp_;
  const bool tells = !too_old && (path_m >= kLeast_m || turn_rad >= kLeast_rad) && !is_kept_again(scan);
  if (too_old) suspected_ = kNever;
  if (tells) {
    if (!is_better_explained(scan, felt)) {
      suspected_ = kNever;
    } else if (suspected_ == kNever) {
      suspected_ = scan.stamp;
    }
  }
  if (too_old || path_m >= kMost_m || turn_rad >= kMost_rad) keep(scan, rolled);
}

bool SeenMotion::is_better_explained(const LaserScan& scan, const Rolled& felt) const noexcept {
  Errors right = errors(scan, felt);
  if (right.compared < kLeastCompared || !leaves_to_explain(right)) return false;
  right = with_slip(scan, felt, right);
  return leaves_to_explain(right) && std::any_of(kWrong.begin(), kWrong.end(), [&](const Explanation& is) {
           const Rolled moved = is.of(felt);
           return differs(moved, felt) && explains_better(errors(scan, moved), right);
         });
}

/// The least errors with slip within bounds: a turn that is off by a degree shows more than all of the way.
SeenMotion::Errors SeenMotion::with_slip(const LaserScan& scan, const Rolled& felt, const Errors& none) const noexcept {
  Errors best = errors(scan, Explanation{1.0 - kMostSlip, 1.0 - kMostSlip}.of(felt));
  if (best.compared < kLeastCompared || none.mean_m < best.mean_m) best = none;
  double share = 0.0, step = 0.5 * kMostSlip, least_m = none.mean_m;
  for (int k = 0; k < kSlipSteps; ++k, step *= 0.5) {
    const double about = share;
    for (const double tried : {about - step, about + step}) {
      const Errors slipped = errors(scan, slip(tried).of(felt));
      if (slipped.compared < kLeastCompared || slipped.mean_m >= least_m) continue;
      least_m = slipped.mean_m;
      share = tried;
      if (least_m < best.mean_m) best = slipped;
    }
  }
  return best;
}

/// Whether enough points have an error that another motion could take away.
bool SeenMotion::leaves_to_explain(const Errors& errors) noexcept {
  const auto off =
      std::count_if(errors.point_m.begin(), errors.point_m.end(), [](float error_m) { return error_m > kVote_m; });
  return static_cast<double>(off) >= kShare * static_cast<double>(errors.compared);
}

bool SeenMotion::differs(const Rolled& a, const Rolled& b) const noexcept {
  const double left_m = a.left_m - b.left_m, right_m = a.right_m - b.right_m;
  return std::fabs(0.5 * (left_m + right_m)) >= kOther_m ||
         std::fabs(right_m - left_m) >= kOther_rad * drive_.track_width_m;
}

bool SeenMotion::explains_better(const Errors& wrong, const Errors& right) noexcept {
  if (wrong.compared < kLeastCompared || wrong.mean_m > kLeft * right.mean_m) return false;
  int better = 0, compared = 0;
  for (std::size_t k = 0; k < wrong.point_m.size(); ++k) {
    if (std::isnan(wrong.point_m[k]) || std::isnan(right.point_m[k])) continue;
    ++compared;
    better += wrong.point_m[k] < right.point_m[k] - kVote_m ? 1 : 0;
    better -= wrong.point_m[k] > right.point_m[k] + kVote_m ? 1 : 0;
  }
  return better >= kShare * compared;
}

/// Of the kept hits in the new scan, had the wheels moved the robot so: the middle by (l + r)/2, half way through the
/// turn of (r - l)/track.
SeenMotion::Errors SeenMotion::errors(const LaserScan& scan, const Rolled& moved) const noexcept {
  const double turn = (moved.right_m - moved.left_m) / drive_.track_width_m;
  const Vec2 way = direction(0.5 * turn) * (0.5 * (moved.left_m + moved.right_m));
  const Transform2 to_laser(inverse(Pose2{way.x, way.y, turn} * robot_from_laser_));
  Errors errors;
  for (const Point& point : kept_) {
    const double error = error_m(scan, to_laser * point.in_robot);
    static_cast<void>(errors.point_m.push_back(static_cast<float>(error)));  // room for as many
    if (std::isnan(error)) continue;
    errors.mean_m += error;
    ++errors.compared;
  }
  errors.mean_m /= static_cast<double>(std::max<std::size_t>(errors.compared, 1));
  return errors;
}

/// How far a point lies from the surface that the scan shows in its direction, across the surface; at most
/// kMostError_m. NaN where it shows none: no hit, or an edge.
double SeenMotion::error_m(const LaserScan& scan, Vec2 in_laser) const noexcept {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  const double step = scan.angle_step_rad;
  const double from_first = wrap_angle(atan2(in_laser.y, in_laser.x) - scan.first_angle_rad) / step;
  const double turn_beams = 2.0 * kPi / std::fabs(step);
  const auto beam =
      static_cast<std::int64_t>(std::floor((from_first < -0.5 ? from_first + turn_beams : from_first) + 0.5));
  const auto beside = static_cast<std::int64_t>(std::clamp(0.012 / std::fabs(step), 1.0, 4.0));
  if (beam < beside || beam + beside >= static_cast<std::int64_t>(scan.beam_count)) return kNan;
  const auto middle = static_cast<std::size_t>(beam), low = static_cast<std::size_t>(beam - beside),
             high = static_cast<std::size_t>(beam + beside);
  if (!scan.is_hit(low) || !scan.is_hit(middle) || !scan.is_hit(high)) return kNan;
  const double range_m = scan.range_m[middle];
  const double apart_m = range_m * std::fabs(step) * static_cast<double>(2 * beside);
  if (std::fabs(scan.range_m[high] - scan.range_m[low]) > 0.05 + 4.0 * apart_m) return kNan;
  const Vec2 along = direction_[high] * scan.range_m[high] - direction_[low] * scan.range_m[low];
  const Vec2 off = in_laser - direction_[middle] * range_m;
  return std::min(std::fabs(cross(along, off)) / std::max(norm(along), 1e-6), kMostError_m);
}

}  // namespace jaywalk
