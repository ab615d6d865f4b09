#pragma once
// Ground that no scan proves free: gaps between beams, walls that stand there, and parts of the body that move there.
#include <array>
#include <cstdint>
#include <vector>

#include "firmware/safety/stop_zone.h"
#include "hal/types/laser_scan.h"
#include "hal/types/robot_model.h"
#include "hal/types/time.h"

namespace jaywalk {
/// What a scan says of a place.
enum class Coverage : std::uint8_t {
  kProven,     ///< a post of 70 mm there would cut a beam that measured
  kLost,       ///< it would not: beams that should measure there did not
  kUnwatched,  ///< the laser never looks there: outside its field of view, or a blanked sector
};

/// How many beams of a scan proved something. Blanked ones do not count.
struct BeamCounts {
  std::uint32_t measured = 0;
  std::uint32_t lost = 0;
  std::uint32_t ahead = 0;       ///< within 60 degrees of the robot's way ahead
  std::uint32_t lost_ahead = 0;  ///< of these
};

/// The gaps between the beams of the newest scan that measured something.
///
/// Between two of them that are an angle g apart a cylinder of 70 mm can hide from 0.035 m / sin(g/2) on: that is as
/// far as its middle must be from the laser to cut neither. What is nearer is proven. A gap at the rim of the field of
/// view has one neighbour, and counts twice its width. Thread: the loop's; never allocates, never throws.
class BlindGaps {
 public:
  explicit BlindGaps(const LaserModel& laser)
      : laser_(laser), robot_from_laser_(laser.robot_from_laser), laser_from_robot_(inverse(laser.robot_from_laser)) {}

  void update(const LaserScan& scan) noexcept;

  /// Of a place in the laser's frame.
  [[nodiscard]] Coverage at(Vec2 place_in_laser) const noexcept;
  [[nodiscard]] const Transform2& robot_from_laser() const noexcept { return robot_from_laser_; }
  [[nodiscard]] const Transform2& laser_from_robot() const noexcept { return laser_from_robot_; }
  [[nodiscard]] const BeamCounts& counts() const noexcept { return counts_; }
  /// How near the laser something can be hidden by lost beams; +infinity where nothing can.
  [[nodiscard]] double nearest_lost_m() const noexcept { return nearest_lost_m_; }
  [[nodiscard]] bool has_blanked() const noexcept { return !laser_.blanked.empty(); }
  [[nodiscard]] std::size_t beams() const noexcept { return beams_; }
  /// The beam `step` (1 or -1) from one; beams() beyond the rim of the field of view.
  [[nodiscard]] std::size_t beside(std::size_t beam, int step) const noexcept {
    if (!all_round_ && beam == (step > 0 ? beams_ - 1 : 0)) return beams_;
    return step > 0 ? (beam + 1) % beams_ : (beam + beams_ - 1) % beams_;
  }
  [[nodiscard]] bool looks(std::size_t beam) const noexcept { return beam < beams_ && !blanked_[beam]; }

 private:
  /// Of a beam: measured something or not, or never asked.
  enum class Beam : std::uint8_t { kMeasured, kLost, kBlanked };
  struct Gap {
    double near_m;  ///< from here on something can hide
    Coverage coverage;
  };

  void learn_directions(const LaserScan& scan) noexcept;
  void judge_beams(const LaserScan& scan) noexcept;
  void find_gaps() noexcept;
  /// The `count` intervals from beam `from` on lie between two that measured, or between one and the rim.
  void mark(std::size_t from, std::size_t count, double half_rad) noexcept;

  LaserModel laser_;
  Transform2 robot_from_laser_, laser_from_robot_;
  std::size_t beams_ = 0;
  double first_rad_ = 0.0, step_rad_ = 0.0;
  bool all_round_ = false;
  std::array<bool, kMaxBeams> blanked_{}, ahead_{};
  std::array<Beam, kMaxBeams> beam_{};
  std::array<Gap, kMaxBeams> gap_{};  ///< between a beam and the next
  BeamCounts counts_;
  double nearest_lost_m_ = 0.0;
};

/// The best that one of the scanners says of a place in the robot's frame.
[[nodiscard]] Coverage coverage_at(const OfEach<BlindGaps>& gaps, Vec2 place) noexcept;

/// Whether so many beams prove nothing that the scanner has to be seen to (SAFETY 17): more than half of those that it
/// should measure, at once; more than a third of those within 60 degrees of the way ahead, for longer than a second.
class SightLoss {
 public:
  /// Once a tick.
  [[nodiscard]] bool is_lost(const BeamCounts& counts, Time now) noexcept;

 private:
  Time lost_ahead_since_ = kNever;
};

/// Where the body goes without the scan having proved that it is free: points along the footprint's outline, grown by a
/// margin, that their motion pushes outward. Thread: the loop's; allocates in the constructor alone.
class Watch {
 public:
  /// `margin_m`: the most that is kept free round the footprint.
  Watch(const Footprint& footprint, double margin_m);

  /// Speed (m/s) of the body's fastest point that moves mostly outward to where no laser ever looks; 0 where none does.
  [[nodiscard]] double unwatched_mps(const OfEach<BlindGaps>& gaps, const Twist2& twist,
                                     const SweptPath& path) const noexcept;

  /// How far the fastest-moving part of the body goes along the path until its outline, grown by `margin_m`, enters
  /// what lost beams could hide; +infinity where it does not. What lies within the margin at the start does not count:
  /// the robot came there while it was proven.
  [[nodiscard]] double way_to_lost_m(const OfEach<BlindGaps>& gaps, const Twist2& twist, const SweptPath& path,
                                     double margin_m) const noexcept;

 private:
  struct RimPoint {
    Vec2 on_body;
    Vec2 outward;  ///< a unit vector; at a corner both sides' together
  };
  [[nodiscard]] static Vec2 velocity(const Twist2& twist, Vec2 point) noexcept {
    return {twist.v_mps - twist.w_radps * point.y, twist.w_radps * point.x};
  }
  /// The share of a point's velocity that pushes outward, m/s; a corner's is the greater of its two sides'.
  [[nodiscard]] static double outward_mps(const RimPoint& rim, Vec2 moves) noexcept {
    return std::max(moves.x * rim.outward.x, moves.y * rim.outward.y);
  }

  double margin_m_;
  Footprint held_free_;  ///< the footprint grown by the margin
  std::vector<RimPoint> rim_;
};

/// Ground near the robot, in its frame, as the loop's map knows it.
class KnownGround {
 public:
  virtual ~KnownGround() = default;
  [[nodiscard]] virtual bool seen_free(Vec2 place) const noexcept = 0;
  /// A wall may stand there: of its end little is seen, and soon nothing. Forgotten once the robot is elsewhere.
  virtual void suppose(Vec2 place) noexcept = 0;
};

/// Walls where no laser looks, as points for the stop zone: those that the loop knows from its map, and each wall that
/// is straight up to the rim of sight, continued past the body. One seen too little to tell its direction is guessed to
/// go on along the body's side, a body's length beyond it. Thread: the loop's; never allocates or throws.
class UnseenWalls {
 public:
  /// `reach_m`: from the axle; what a wall is supposed to be farther off is left out.
  UnseenWalls(const Footprint& footprint, double reach_m) : footprint_(footprint), reach_m_(reach_m) {}

  /// `known`: surfaces near the robot, in its frame. `ground`: null where there is no map.
  void update(const OfEach<LaserScan>& scans, const OfEach<BlindGaps>& gaps, std::span<const Vec2> known,
              KnownGround* ground = nullptr) noexcept;
  /// In the robot's frame, 4 cm apart or less.
  [[nodiscard]] std::span<const Vec2> points() const noexcept { return {points_.data(), points_.size()}; }

 private:
  /// A scanner's, which looks no farther than beam `rim`.
  struct Rim {
    std::size_t scanner, beam;
    int inward;  ///< 1 or -1: to the next beam that looks
  };
  /// Fits a line to the hits from the rim of sight inward, and continues it out of sight.
  void continue_wall(const LaserScan& scan, const OfEach<BlindGaps>& gaps, const Rim& rim) noexcept;
  void add_line(const OfEach<BlindGaps>& gaps, Vec2 from, Vec2 along, double length_m) noexcept;
  void add(const OfEach<BlindGaps>& gaps, Vec2 point) noexcept;

  Footprint footprint_;
  double reach_m_;
  KnownGround* ground_ = nullptr;   ///< during update()
  FixedVector<Vec2, 1024> points_;  ///< what does not fit is left out: the nearest of a wall come first
};

}  // namespace jaywalk
