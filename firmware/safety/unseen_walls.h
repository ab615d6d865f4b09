#pragma once
#include <span>
#include <vector>

#include "firmware/safety/blind_gaps.h"
#include "hal/types/fixed_vector.h"
#include "hal/types/laser_scan.h"
#include "hal/types/robot_model.h"

namespace jaywalk {
/// What the loop's map knows of the ground near the robot, in its frame.
class KnownGround {
 public:
  virtual ~KnownGround() = default;
  [[nodiscard]] virtual bool seen_free(Vec2 place) const noexcept = 0;
  /// A wall may stand there; that is forgotten once the robot is elsewhere. Of a wall's end little is seen, and soon
  /// nothing.
  virtual void suppose(Vec2 place) noexcept = 0;
};

/// Walls where no laser looks, as points for the stop zone: those that the loop knows from its map, and each wall that
/// is straight up to the rim of sight, continued past the body. Of what is seen too little to tell its direction, the
/// guess is that it goes on along the body's side: so a wall begins that stands beside a start.
///
/// The guess only ever slows: it ends a body's length beyond the robot. Thread: the loop's; never allocates or throws.
class UnseenWalls {
 public:
  /// `reach_m`: from the axle; what a wall is supposed to be farther off is left out.
  UnseenWalls(const Footprint& footprint, const OfEach<Pose2>& robot_from_lasers, double reach_m);

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
  KnownGround* ground_ = nullptr;  ///< during update()
  std::vector<Transform2> robot_from_laser_;
  Lookout lookout_;
  FixedVector<Vec2, 1024> points_;  ///< what does not fit is left out: the nearest of a wall come first
};

}  // namespace jaywalk
