#pragma once
#include <Eigen/Core>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>

#include "hal/types/fixed_vector.h"
#include "hal/types/geometry.h"
#include "hal/types/laser_scan.h"

namespace jaywalk {
/// Matches a newer raw scan against hits kept of an older one, point to line (Censi 2008), with neither map nor
/// planner: what each motion of the robot between them leaves as an error, and the motion that leaves the least.
///
/// A point's error is its distance to the surface that the newer scan shows in its direction, across the surface. Hits
/// on surfaces shorter than a wall count for less: people and their bags move. Thread: the loop's; memory is fixed.
class ScanPair {
 public:
  static constexpr std::size_t kMostPoints = 160, kSectors = 24;
  static constexpr int kPeople = 2;  ///< sectors that pedestrians and their shadows may fill
  /// Logarithm of a likelihood ratio, for each sector.
  using Costs = std::array<double, kSectors>;
  [[nodiscard]] static double total(const Costs& costs) noexcept;
  /// Sum without the kPeople greatest: one or two pedestrians prove nothing.
  [[nodiscard]] static double without_greatest(Costs costs) noexcept;
  /// Of each kept point (m); NaN where it could not be compared.
  using Errors = std::array<float, kMostPoints>;
  struct Fit {
    Pose2 kept_from_now{};                                  ///< of the robot
    Eigen::Matrix3d information = Eigen::Matrix3d::Zero();  ///< of (x, y, heading) in the robot's frame now
    double noise_m = 0.0;                                   ///< standard deviation of the errors, outliers apart
    double compared = 0.0;                                  ///< sum of the weights of the points that could be
    double explained = 0.0;                                 ///< share of them that are no outliers
    /// True where enough points agree for the fit to tell a motion: else they are outliers.
    [[nodiscard]] bool tells() const noexcept { return explained >= 0.5 && compared >= 12.0; }
  };

  explicit ScanPair(const Pose2& robot_from_laser)
      : robot_from_laser_(robot_from_laser), laser_from_robot_(inverse(robot_from_laser)) {}

  /// Whether the scan's beams have directions; where they are others than before, nothing is kept any more.
  [[nodiscard]] bool usable(const LaserScan& scan) noexcept;
  /// Takes the robot's twist during the scan's sweep: each beam is put where the robot was when it was measured.
  void sweep(const LaserScan& scan, const Twist2& felt) noexcept;
  void keep(const LaserScan& scan) noexcept;
  [[nodiscard]] bool is_kept() const noexcept { return !points_.empty(); }
  [[nodiscard]] double sector_rad() const noexcept {
    return std::fabs(static_cast<double>(angle_step_rad_)) * beams_ / static_cast<double>(kSectors);
  }
  /// Share of the hits that the scan repeats, to the last bit, of the one that this was asked about before.
  [[nodiscard]] double repeated(const LaserScan& scan) noexcept;

  /// Points that something nearer hides are left out, but for `hidden_too`: what moves along takes its shadow with it.
  [[nodiscard]] Errors errors(const LaserScan& scan, const Pose2& kept_from_now,
                              bool hidden_too = false) const noexcept;
  /// The same of a scanner that shows each point once more where it did, whatever the robot does.
  [[nodiscard]] Errors shown_again(const LaserScan& scan) const noexcept;
  /// The one of some motions that the errors speak for most, as they are before a fit.
  [[nodiscard]] Pose2 likeliest(const LaserScan& scan, std::span<const Pose2> motions) const noexcept;
  /// Gauss-Newton with outliers weighed down (Geman and McClure 1987).
  [[nodiscard]] Fit fit(const LaserScan& scan, const Pose2& start) const noexcept;
  /// One step of it: how good the fit is where it is, and there it is moved on.
  void improve(const LaserScan& scan, Fit& fit) const noexcept;
  /// Log-likelihood of errors with that noise, outliers at three of it, less that of others; `walls`: by walls alone.
  [[nodiscard]] Costs advantage(const Errors& better, const Errors& worse, double noise_m, bool walls) const noexcept;

  /// The mean of that for standing surfaces over moved ones if they stand, by their predictions across each surface.
  [[nodiscard]] Costs gain_of_standing(const LaserScan& scan, const Pose2& kept_from_now,
                                       double noise_m) const noexcept;

 private:
  struct Point {
    std::uint32_t beam = 0;
    float range_m = 0.0F;
    float weight = 0.0F;  ///< 1 on a wall
    Vec2 in_robot;
  };
  struct Residual {
    double error_m;
    Vec2 normal;             ///< of the surface, in the laser's frame
    double spread_m2 = 1.0;  ///< of the hits along it, squares summed: its direction's variance is noise^2 / spread
  };
  /// `in_laser`: where the scan would show it, at the time of its first beam.
  [[nodiscard]] Residual residual(const LaserScan& scan, Vec2 in_laser, bool hidden_too) const noexcept;
  [[nodiscard]] Residual shown(const LaserScan& scan, Vec2 in_laser, bool hidden_too) const noexcept;
  [[nodiscard]] std::int64_t beam_towards(const LaserScan& scan, Vec2 in_laser) const noexcept;
  /// Of the robot, from the first beam to that one.
  [[nodiscard]] Pose2 moved_until(double beam) const noexcept;
  [[nodiscard]] bool is_flat(const LaserScan& scan, std::uint32_t beam) const noexcept;

  Pose2 robot_from_laser_;
  Transform2 laser_from_robot_;
  Twist2 per_beam_{};                        ///< of the robot, m and rad from a beam to the next
  std::array<Vec2, kMaxBeams> direction_{};  ///< of the beams, in the laser's frame
  std::uint32_t beams_ = 0;                  ///< those directions are of
  float first_angle_rad_ = 0.0F, angle_step_rad_ = 0.0F;
  FixedVector<Point, kMostPoints> points_;
  Errors before_{};         ///< ranges, for repeated()
  bool few_walls_ = false;  ///< too few to tell the noise by
};

}  // namespace jaywalk
