#pragma once
// Points and segments of a scan, order of several scanners, unreliable first scans.
#include <array>
#include <chrono>
#include <cstdint>
#include <utility>

#include "hal/types/fixed_vector.h"
#include "hal/types/geometry.h"
#include "hal/types/laser_scan.h"
#include "hal/types/time.h"

namespace jaywalk {
struct ScanPoint {
  Vec2 in_robot;         ///< m, in the robot's frame at the scan's stamp
  double range_m = 0.0;  ///< along the beam, from the laser
  std::uint32_t beam = 0;
  bool after_own = false, before_own = false;  ///< the beam before it, or after it, ends on the robot itself
};

/// Beams `first` to `last` of a scan, which may run on from its last beam to its first; none at first.
struct BeamRun {
  std::uint32_t first = 1, last = 0;
  [[nodiscard]] constexpr bool has(std::size_t beam) const {
    if (first > last + 1) return beam >= first || beam <= last;
    return beam >= first && beam <= last;
  }
};

/// How the beams of a scan lie.
struct Sweep {
  std::uint32_t beams = 0;
  double angle_step_rad = 0.0;  ///< from a beam to the next
  bool all_round = false;       ///< the last beam lies beside the first, or on it: there is no end
  double beam_s = 0.0;          ///< from a beam to the next, s; 0: taken all at once

  /// All round the beam beside is there, but from a sweep before or after: a pedestrian may not have been there yet.
  [[nodiscard]] bool has_ends() const { return !all_round || beam_s > 0.0; }
  [[nodiscard]] bool begins_at(std::uint32_t beam) const { return has_ends() && beam == 0; }
  [[nodiscard]] bool ends_at(std::uint32_t beam) const { return has_ends() && beam + 1 == beams; }
  [[nodiscard]] bool neighbours(std::uint32_t a, std::uint32_t b) const {
    const std::uint32_t apart = a < b ? b - a : a - b;
    return apart == 1 || (all_round && apart + 1 == beams);
  }
  /// The beam before, or after; `beams`: there is none.
  [[nodiscard]] std::uint32_t before(std::uint32_t beam) const {
    if (beam > 0) return beam - 1;
    return all_round ? beams - 1 : beams;
  }
  [[nodiscard]] std::uint32_t after(std::uint32_t beam) const {
    if (beam + 1 < beams) return beam + 1;
    return all_round ? 0 : beams;
  }
};

/// Nearer than this (m) a laser sees only its own robot: masts, cables, the rim of its own window.
inline constexpr double kNearestSeenM = 0.2;

/// Share of its reach within which a scanner sees all, not bright things alone (docs/explanation/decisions/beams.md).
inline constexpr double kSeesAll = 0.8;

/// Beams beyond kMaxBeams are left out.
[[nodiscard]] Sweep sweep_of(const LaserScan& scan) noexcept;

using ScanPoints = FixedVector<ScanPoint, kMaxBeams>;

/// From a beam of the scan to the next, s; 0 for a scan taken all at once, or by a robot that stands.
[[nodiscard]] inline double beam_interval_s(const LaserScan& scan, const Twist2& twist) noexcept {
  if (scan.beam_count < 2 || twist == Twist2{}) return 0.0;
  return to_seconds(scan.sweep) / static_cast<double>(scan.beam_count - 1);
}

/// Where a robot that keeps `twist` stands after `after_s` seconds, seen from where it stood. A sweep is short: the
/// chord's direction is taken at half the turn, which is exact for constant speeds up to (w t)^2 / 24.
[[nodiscard]] inline Pose2 moved_by(const Twist2& twist, double after_s) noexcept {
  const double turn = twist.w_radps * after_s;
  const Vec2 travel = direction(0.5 * turn) * (twist.v_mps * after_s);
  return {travel.x, travel.y, turn};
}

/// Turns beams into points. Directions of beams are worked out when they change: sines and cosines would take a tenth
/// of perception's time. Thread: the loop's.
class ScanProjection {
 public:
  /// Fills `out` with the scan's hits in the order of the beams; with none where the angles are no fan. A sweep that
  /// takes time is put right: each beam starts from where a robot moving with `twist` stood when it was measured.
  void project(const LaserScan& scan, const Pose2& robot_from_laser, const Twist2& twist, ScanPoints& out) noexcept;
  /// The same for beams without a return (LaserScan::found_nothing): the points `range_m` along them.
  void project_empty(const LaserScan& scan, const Pose2& robot_from_laser, const Twist2& twist, double range_m,
                     ScanPoints& out) noexcept;

 private:
  /// `range_of(beam)`: m; 0 for one that is left out.
  template <class RangeOf>
  void project_beams(const LaserScan& scan, const Pose2& robot_from_laser, const Twist2& twist, RangeOf range_of,
                     ScanPoints& out) noexcept;
  void look_along(const LaserScan& scan, std::size_t beams) noexcept {
    if (scan.first_angle_rad != first_angle_rad_ || scan.angle_step_rad != angle_step_rad_) known_ = 0;
    first_angle_rad_ = scan.first_angle_rad;
    angle_step_rad_ = scan.angle_step_rad;
    for (; known_ < beams; ++known_) direction_[known_] = direction(scan.angle_rad(known_));
  }

  float first_angle_rad_ = 0.0F, angle_step_rad_ = 0.0F;
  std::size_t known_ = 0;  ///< beams whose directions those angles gave
  std::array<Vec2, kMaxBeams> direction_;
};

/// Scans of several scanners come when their sweeps end, so that a slow sweep comes after a later one of another
/// scanner. Tells that from a clock that was set back: such a scan goes on from its own scanner's last.
class ScanOrder {
 public:
  ScanOrder() noexcept { own_.fill(kNever); }
  /// Once a scan: how much earlier (s, 0 or less) it was taken than the newest of another scanner.
  [[nodiscard]] double behind_s(const LaserScan& scan) noexcept {
    Time& own = own_[scan.scanner];
    const bool late = newest_ != kNever && scan.stamp > own && scan.stamp < newest_ && newest_ - scan.stamp < kMost;
    before_ = std::exchange(own, scan.stamp);
    if (late) return to_seconds(scan.stamp - newest_);
    newest_ = scan.stamp;
    return 0.0;
  }
  /// When the scanner of the last scan asked about took the one before; kNever: it is its first.
  [[nodiscard]] Time before() const noexcept { return before_; }

 private:
  static constexpr Duration kMost = std::chrono::seconds(1);  ///< no sweep takes longer
  std::array<Time, kMostScanners> own_;
  Time newest_ = kNever, before_ = kNever;
};

/// A run of neighbouring points that are one thing: points [first, last] of the scan.
struct Segment {
  std::uint32_t first = 0, last = 0;
};

using Segments = FixedVector<Segment, kMaxBeams>;  ///< never full: a segment has a point, and a beam one at most

/// Turns the points of a scan all round so that they begin at a jump, and nothing is cut in two.
void begin_at_a_jump(const Sweep& sweep, ScanPoints& points) noexcept;

/// Cuts the scan where neighbouring points are farther apart than a surface explains: by the range, and by the steps
/// beside theirs, since a wall seen at a slant goes on in long ones.
void cut_at_jumps(const ScanPoints& points, const Sweep& sweep, Segments& out) noexcept;

/// Unreliable first scans: taken from a robot that drove and was thought to stand, since scans alone know no speed
/// before the third. For a second everything then seems to walk a little.
class FirstScans {
 public:
  /// Once a scan, with the robot's speed as it is thought to be at `now`. True while nothing can be said to walk: for a
  /// second after the speed jumped by more than a robot gains from one scan to the next.
  [[nodiscard]] bool are_unreliable(const Twist2& twist, Time now) noexcept;

 private:
  int scans_ = 0;
  Twist2 last_;
  Time jumped_ = kNever;
};

}  // namespace jaywalk
