#pragma once
// The tracker: walls into the evidence map, things that move into tracks, from the laser alone.
#include <memory>
#include <span>

#include "hal/types/laser_scan.h"
#include "hal/types/outside_fix.h"
#include "hal/types/robot_model.h"
#include "planner/mapping/evidence_map.h"
#include "planner/mapping/known_map.h"
#include "planner/tracking/occlusion.h"
#include "planner/tracking/track.h"

namespace jaywalk {
struct PerceptionConfig {
  Pose2 robot_from_laser;
  double cell_m = 0.1;
  std::int32_t map_side_cells = 1024;
  Vec2 map_centre;   ///< where the evidence map is centred at start
  Footprint body{};  ///< of the robot: where it stands nothing else does. Without size: nothing is said of that
  std::shared_ptr<const KnownMap> known_map{};  ///< what stands before the first scan; null: nothing is known
  OfOthers<Pose2> robot_from_others{};          ///< the other lasers' mounts
};

/// Thread: the loop's. The constructor allocates; update() never does, and never throws.
class Tracker {
 public:
  explicit Tracker(const PerceptionConfig& config);
  ~Tracker();

  /// Takes one new scan (the caller calls once a sweep, of each scanner; what one found is missed by that one alone
  /// until it does) seen from `map_from_robot`, the robot's
  /// pose at the scan's stamp. Ranges that are no returns change nothing; nor does a pose that is not
  /// finite. `twist` puts right a sweep that takes time while the robot moves. A moving track is dated to the scan's
  /// stamp, whenever in its sweep it was met. A stamp more than a second before the last one's is a clock's that was
  /// set: tracks are forgotten, what stands is not.
  /// `told`: the loop's time, from which Track::still_since counts; the scan's stamp where it is not given.
  void update(const LaserScan& scan, const Pose2& map_from_robot, const Twist2& twist = {},
              Time told = kNever) noexcept;

  /// Mode paper: movers come from outside, named and noisy; a Kalman filter each. Beams that end
  /// within a mover's radius of its given position are kept out of the map by the next update().
  void update_given(const OutsideFix& fix) noexcept;

  /// For a robot that finds no way: what stands alone in the map, is no wider than bodies are and out of sight now may
  /// have gone, and is unknown from now on (IsolatedObstacles).
  void forget_unseen() noexcept;

  [[nodiscard]] const EvidenceMap& still() const;
  /// All tracks, moving or not; of walls, what is as wide as a body and stands alone: a pillar, or a pedestrian
  /// that stood there for long. A moving track hidden for more than a second is dropped; one that then comes out where
  /// and when it should is the same again (OccludedTracks). One that stood is kept for two seconds.
  [[nodiscard]] std::span<const Track> tracks() const;
  /// Those that move beyond reasonable doubt: what the planner warps.
  [[nodiscard]] std::span<const Track> moving() const;
  /// Standing pedestrians, for as long as something stands there: wider than the map has them. A track that walked, and
  /// everything on two legs, some furniture among it.
  [[nodiscard]] std::span<const StandingPedestrian> standing() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace jaywalk
