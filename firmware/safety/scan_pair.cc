#include "firmware/safety/scan_pair.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <limits>
#include <numeric>

namespace jaywalk {
namespace {
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kMostError_m = 0.15;               ///< whatever is farther off is something else
constexpr double kChord_m = 0.10;                   ///< to either side: with less a range's noise turns the surface
constexpr double kFlat_m = 0.18, kUneven_m = 0.02;  ///< to either side, and the mean off it: a pedestrian is round
constexpr double kEdge_m = 0.1;
constexpr float kRoundWeight = 0.06F;
constexpr double kLeastNoise_m = 0.008, kMostNoise_m = 0.06;  ///< beams are discrete, surfaces rough
constexpr double kCoarse_m = 0.1;                             ///< an error that weighs a quarter, to begin with
constexpr double kFeigned = 2.0;   ///< times what noise turns normals by, which is no information: it varies by a fifth
constexpr double kRough_m = 0.05;  ///< standard deviation of errors before a fit
constexpr int kSteps = 7;
constexpr double kOutlier = 4.5;              ///< negative log-likelihood at three standard deviations
const Eigen::Vector3d kPrior{1.0, 1.0, 1.0};  ///< of a step, as information: no point at all has a thousand

/// Positive: along what nothing tells, a standard deviation of 1 m.
Eigen::Matrix3d told_apart(const Eigen::Matrix3d& information) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(information);
  return axes.eigenvectors() * axes.eigenvalues().cwiseMax(1.0).asDiagonal() * axes.eigenvectors().transpose();
}

using Hits = FixedVector<Vec2, 16>;  ///< along and across a chord, m

/// Surface through hits: their line of least squares, bent by a parabola for what this explains beyond twice the hits'
/// scatter (a parameter's worth: Akaike 1974). Posts stand off straight lines by 2 cm, which let the match slide by 6
/// cm (34 of 100 drives among posts ended so); the whole parabola where walls are flat has a fifth more noise.
struct Surface {
  explicit Surface(Hits& hits) {
    const auto count = static_cast<double>(hits.size());
    for (const Vec2 hit : hits) mean = mean + hit * (1.0 / count);
    double cubes = 0.0, across = 0.0, squares = 0.0, size = 1e-12, bent = 0.0;
    for (Vec2& hit : hits) {
      hit = hit - mean;
      spread_m2 += hit.x * hit.x, cubes += hit.x * hit.x * hit.x, across += hit.x * hit.y, squares += hit.y * hit.y;
      half_m = std::max(half_m, std::fabs(hit.x));
    }
    slope = across / std::max(spread_m2, 1e-9);
    skew_m = cubes / std::max(spread_m2, 1e-9), middle_m2 = spread_m2 / count;
    if (hits.size() < 5) return;
    for (const Vec2 hit : hits) size += parabola(hit.x) * parabola(hit.x), bent += parabola(hit.x) * hit.y;
    const double explained = bent * bent / size, feigned = 2.0 * (squares - slope * across - explained) / (count - 3.0);
    bend = explained > feigned ? (1.0 - feigned / explained) * bent / size : 0.0;
  }
  /// Across the chord, `along` it.
  [[nodiscard]] double at(double along) const {
    const double on = along - mean.x;
    return mean.y + slope * on + bend * parabola(std::clamp(on, -half_m, half_m));
  }
  /// Square to constants and lines over the hits.
  [[nodiscard]] double parabola(double on) const { return on * on - skew_m * on - middle_m2; }

  Vec2 mean{};
  double slope = 0.0, bend = 0.0, spread_m2 = 0.0, skew_m = 0.0, middle_m2 = 0.0, half_m = 0.0;
};

/// Of the beams, so that no more than kMostPoints are looked at.
std::uint32_t every(const LaserScan& scan) {
  constexpr std::uint32_t kMost = ScanPair::kMostPoints;
  return (scan.beam_count + kMost - 1) / kMost;
}

}  // namespace

double ScanPair::total(const Costs& costs) noexcept { return std::accumulate(costs.begin(), costs.end(), 0.0); }

double ScanPair::without_greatest(Costs costs) noexcept {
  std::nth_element(costs.begin(), costs.end() - kPeople, costs.end());
  return std::accumulate(costs.begin(), costs.end() - kPeople, 0.0);
}

bool ScanPair::usable(const LaserScan& scan) noexcept {
  if (scan.beam_count < 2 || scan.beam_count > kMaxBeams) return false;
  if (!std::isfinite(scan.first_angle_rad) || !(std::fabs(scan.angle_step_rad) > 1e-6F)) return false;
  if (scan.beam_count == beams_ && scan.first_angle_rad == first_angle_rad_ && scan.angle_step_rad == angle_step_rad_)
    return true;
  beams_ = scan.beam_count;
  first_angle_rad_ = scan.first_angle_rad;
  angle_step_rad_ = scan.angle_step_rad;
  for (std::size_t beam = 0; beam < beams_; ++beam) direction_[beam] = direction(scan.angle_rad(beam));
  points_.clear();
  return true;
}

bool ScanPair::is_flat(const LaserScan& scan, std::uint32_t beam) const noexcept {
  const auto place = [&](std::uint32_t k) { return direction_[k] * static_cast<double>(scan.range_m[k]); };
  const Vec2 here = place(beam);
  const auto end = [&](std::uint32_t step) {  // wraps round below the first beam
    std::uint32_t k = beam;
    while (k + step < scan.beam_count && scan.is_hit(k + step) && distance(place(k), here) < kFlat_m) {
      const double apart_m = scan.range_m[k] * std::fabs(scan.angle_step_rad);
      if (std::fabs(scan.range_m[k + step] - scan.range_m[k]) > kEdge_m + 4.0 * apart_m) break;
      k += step;
    }
    return k;
  };
  const std::uint32_t low = end(std::numeric_limits<std::uint32_t>::max()), high = end(1U);
  if (distance(place(low), here) < kFlat_m || distance(place(high), here) < kFlat_m) return false;
  const Vec2 along = place(high) - place(low);
  double off = 0.0;
  for (std::uint32_t k = low + 1; k < high; ++k) off += cross(along, place(k) - place(low));
  return std::fabs(off) < kUneven_m * norm(along) * static_cast<double>(high - low - 1);
}

void ScanPair::sweep(const LaserScan& scan, const Twist2& felt) noexcept {
  const double beam_s = to_seconds(scan.sweep) / static_cast<double>(scan.beam_count - 1);
  per_beam_ = {felt.v_mps * beam_s, felt.w_radps * beam_s};
}

Pose2 ScanPair::moved_until(double beam) const noexcept {
  const double turn = per_beam_.w_radps * beam;
  const Vec2 way = direction(0.5 * turn) * (per_beam_.v_mps * beam);
  return {way.x, way.y, turn};
}

void ScanPair::keep(const LaserScan& scan) noexcept {
  points_.clear();
  const Transform2 to_robot(robot_from_laser_);
  for (std::uint32_t beam = every(scan) / 2; beam < scan.beam_count; beam += every(scan)) {
    if (!scan.is_hit(beam)) continue;
    const Vec2 hit = moved_until(beam) * (to_robot * (direction_[beam] * static_cast<double>(scan.range_m[beam])));
    if (!points_.push_back({beam, scan.range_m[beam], is_flat(scan, beam) ? 1.0F : kRoundWeight, hit})) break;
  }
  few_walls_ = std::count_if(points_.begin(), points_.end(), [](const Point& p) { return p.weight == 1.0F; }) < 30;
}

double ScanPair::repeated(const LaserScan& scan) noexcept {
  int hits = 0, same = 0;
  for (std::uint32_t beam = 0, k = 0; beam < scan.beam_count && k < kMostPoints; beam += every(scan), ++k) {
    hits += scan.is_hit(beam) ? 1 : 0;
    same += scan.is_hit(beam) && scan.range_m[beam] == before_[k] ? 1 : 0;
    before_[k] = scan.range_m[beam];
  }
  return hits == 0 ? 0.0 : static_cast<double>(same) / hits;
}

ScanPair::Errors ScanPair::errors(const LaserScan& scan, const Pose2& kept_from_now, bool hidden_too) const noexcept {
  const Transform2 to_laser(inverse(kept_from_now * robot_from_laser_));
  Errors errors{};
  for (std::size_t k = 0; k < points_.size(); ++k)
    errors[k] = static_cast<float>(residual(scan, to_laser * points_[k].in_robot, hidden_too).error_m);
  return errors;
}

ScanPair::Errors ScanPair::shown_again(const LaserScan& scan) const noexcept {
  Errors errors{};
  for (std::size_t k = 0; k < points_.size(); ++k)
    errors[k] = static_cast<float>(shown(scan, direction_[points_[k].beam] * points_[k].range_m, true).error_m);
  return errors;
}

Pose2 ScanPair::likeliest(const LaserScan& scan, std::span<const Pose2> motions) const noexcept {
  Pose2 best = motions[0];
  Errors least = errors(scan, best);
  for (const Pose2& motion : motions.subspan(1)) {
    const Errors tried = errors(scan, motion);
    if (total(advantage(tried, least, kRough_m, false)) <= 0.0) continue;
    least = tried;
    best = motion;
  }
  return best;
}

ScanPair::Fit ScanPair::fit(const LaserScan& scan, const Pose2& start) const noexcept {
  Fit fit{.kept_from_now = start, .noise_m = kMostNoise_m};
  for (int step = 0; step < kSteps; ++step) improve(scan, fit);
  return fit;
}

/// Noise by the median of the errors (Rousseeuw and Croux 1993): half of them may be outliers.
void ScanPair::improve(const LaserScan& scan, Fit& fit) const noexcept {
  const double scale_m = std::clamp(3.0 * fit.noise_m, 3.0 * kLeastNoise_m, kCoarse_m);
  const Transform2 to_robot(robot_from_laser_), to_laser(inverse(fit.kept_from_now * robot_from_laser_));
  Eigen::Matrix3d normal_equations = kPrior.asDiagonal(), feigned = normal_equations;
  Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
  FixedVector<float, kMostPoints> errors;
  double all = 1e-9, near = 0.0;
  for (const Point& point : points_) {
    const Vec2 in_laser = to_laser * point.in_robot;
    const Residual found = residual(scan, in_laser, false);
    if (std::isnan(found.error_m)) continue;
    const Vec2 in_robot = to_robot * in_laser, normal = to_robot.rotate(found.normal);
    const double share = 1.0 / (1.0 + found.error_m * found.error_m / (scale_m * scale_m));
    const double weight = point.weight * share * share;
    const Eigen::Vector3d row(-normal.x, -normal.y, -cross(in_robot, normal));
    normal_equations += weight * row * row.transpose();
    const Eigen::Vector3d beside(normal.y, -normal.x, -dot(in_robot, normal));  // the row of a normal turned by noise
    feigned += kFeigned * weight * fit.noise_m * fit.noise_m / found.spread_m2 * beside * beside.transpose();
    gradient += weight * found.error_m * row;
    all += point.weight, near += std::fabs(found.error_m) < scale_m ? point.weight : 0.0F;
    if (point.weight < 1.0F && !few_walls_) continue;
    static_cast<void>(errors.push_back(static_cast<float>(std::fabs(found.error_m))));
  }
  fit.compared = all;
  fit.explained = near / all;
  if (errors.empty()) return;
  std::nth_element(errors.begin(), errors.begin() + errors.size() / 2, errors.end());
  fit.noise_m = std::clamp(1.48 * errors[errors.size() / 2], kLeastNoise_m, kMostNoise_m);
  fit.information = told_apart((normal_equations - feigned) / (fit.noise_m * fit.noise_m));
  const Eigen::Vector3d by = normal_equations.ldlt().solve(-gradient);
  fit.kept_from_now = fit.kept_from_now * Pose2{by.x(), by.y(), by.z()};
}

ScanPair::Costs ScanPair::advantage(const Errors& better, const Errors& worse, double noise_m,
                                    bool walls) const noexcept {
  const auto cost = [noise_m](float error_m) {
    const double off = error_m / noise_m;
    return std::min(0.5 * off * off, kOutlier);
  };
  std::array<double, kSectors> sum{};
  for (std::size_t k = 0; k < points_.size(); ++k) {
    if (std::isnan(better[k]) || std::isnan(worse[k]) || (walls && points_[k].weight < 1.0F)) continue;
    sum[points_[k].beam * kSectors / beams_] += points_[k].weight * (cost(worse[k]) - cost(better[k]));
  }
  return sum;
}

ScanPair::Costs ScanPair::gain_of_standing(const LaserScan& scan, const Pose2& kept_from_now,
                                           double noise_m) const noexcept {
  const Transform2 moved(inverse(kept_from_now * robot_from_laser_));
  std::array<double, kSectors> sum{};
  for (const Point& point : points_) {
    if (point.weight < 1.0F) continue;
    const Vec2 in_laser = laser_from_robot_ * point.in_robot;
    const double off = dot(residual(scan, in_laser, true).normal, moved * point.in_robot - in_laser) / noise_m;
    sum[point.beam * kSectors / beams_] += std::min(0.5 * off * off, kOutlier);
  }
  return sum;
}

std::int64_t ScanPair::beam_towards(const LaserScan& scan, Vec2 in_laser) const noexcept {
  const double step = scan.angle_step_rad;
  const double from_first = wrap_angle(atan2(in_laser.y, in_laser.x) - scan.first_angle_rad) / step;
  return static_cast<std::int64_t>(
      std::floor((from_first < -0.5 ? from_first + 2.0 * kPi / std::fabs(step) : from_first) + 0.5));
}

ScanPair::Residual ScanPair::residual(const LaserScan& scan, Vec2 in_laser, bool hidden_too) const noexcept {
  if (per_beam_ == Twist2{}) return shown(scan, in_laser, hidden_too);
  const Pose2 moved = moved_until(static_cast<double>(beam_towards(scan, in_laser)));
  return shown(scan, laser_from_robot_ * (inverse(moved) * (robot_from_laser_ * in_laser)), hidden_too);
}

/// At most kMostError_m; NaN where the scan shows no surface: no hit, or an edge. The surface goes through nine hits or
/// so: two on a chord of 0.1 m turn it by 0.15 rad with 1 cm of noise, and a wall that many such normals claim to see
/// along lets the match slide.
ScanPair::Residual ScanPair::shown(const LaserScan& scan, Vec2 in_laser, bool hidden_too) const noexcept {
  constexpr Residual kNone{kNan, {}, 1.0};
  const double full = std::fabs(scan.angle_step_rad);
  const std::int64_t beam = beam_towards(scan, in_laser);
  if (beam < 0 || beam >= static_cast<std::int64_t>(scan.beam_count)) return kNone;
  const double range_m = scan.range_m[static_cast<std::size_t>(beam)];
  if (!scan.is_hit(static_cast<std::size_t>(beam))) return kNone;
  if (!hidden_too && norm(in_laser) > range_m + kMostError_m) return kNone;
  const auto beside =
      static_cast<std::int64_t>(std::clamp(kChord_m / (range_m * full), 1.0, std::max(0.3 / full, 1.0)));
  if (beam < beside || beam + beside >= static_cast<std::int64_t>(scan.beam_count)) return kNone;
  const auto low = static_cast<std::size_t>(beam - beside), high = static_cast<std::size_t>(beam + beside);
  if (!scan.is_hit(low) || !scan.is_hit(high)) return kNone;
  const double apart_m = range_m * full * static_cast<double>(2 * beside);
  if (std::fabs(scan.range_m[high] - scan.range_m[low]) > 0.05 + 4.0 * apart_m) return kNone;
  const auto place = [&](std::size_t k) { return direction_[k] * static_cast<double>(scan.range_m[k]); };
  const Vec2 left = place(low), chord = place(high) - left, along = chord * (1.0 / std::max(norm(chord), 1e-6));
  const std::size_t stride = std::max<std::size_t>(static_cast<std::size_t>(beside) / 4, 1);
  Hits hits;
  for (std::size_t k = low; k <= high; k += stride) {
    if (!scan.is_hit(k)) continue;
    const Vec2 hit = place(k) - left;
    (void)hits.push_back({dot(along, hit), cross(along, hit)});
  }
  const Surface surface(hits);
  const Vec2 off = in_laser - left;
  const double tilt = 1.0 / std::sqrt(1.0 + surface.slope * surface.slope);
  const double error_m = tilt * (cross(along, off) - surface.at(dot(along, off)));
  return {std::clamp(error_m, -kMostError_m, kMostError_m), (Vec2{-along.y, along.x} - along * surface.slope) * tilt,
          std::max(surface.spread_m2, 1e-6)};
}

}  // namespace jaywalk
