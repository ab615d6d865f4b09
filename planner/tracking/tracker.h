#pragma once
// The tracker: walls into the evidence map, things that move into tracks, from the laser alone.
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "hal/types/laser_scan.h"
#include "hal/types/outside_fix.h"
#include "hal/types/robot_model.h"
#include "planner/mapping/known_map.h"
#include "planner/tracking/occlusion.h"
#include "planner/tracking/scene.h"

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

/// Its parts, one a step of the update: more fields than a class has elsewhere. Thread: the loop's. The constructor
/// allocates; update() never does, and never throws.
class Tracker {
 public:
  explicit Tracker(const PerceptionConfig& config);

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

  [[nodiscard]] const EvidenceMap& still() const { return still_; }
  /// All tracks, moving or not; of walls, what is as wide as a body and stands alone: a pillar, or a pedestrian
  /// that stood there for long. A moving track hidden for more than a second is dropped; one that then comes out where
  /// and when it should is the same again (OccludedTracks). One that stood is kept for two seconds.
  [[nodiscard]] std::span<const Track> tracks() const { return {tracks_.data(), tracks_.size()}; }
  /// Those that move beyond reasonable doubt: what the planner warps.
  [[nodiscard]] std::span<const Track> moving() const { return {moving_.data(), moving_.size()}; }
  /// Standing pedestrians, for as long as something stands there: wider than the map has them. A track that walked, and
  /// everything on two legs, some furniture among it.
  [[nodiscard]] std::span<const StandingPedestrian> standing() const { return {standing_.data(), standing_.size()}; }

 private:
  void begin(const LaserScan& scan, const Pose2& map_from_robot) noexcept;
  void predict_all_to(Time stamp) noexcept;
  void associate_and_correct() noexcept;
  void judge(const LineOfSight& sight, const Twist2& twist) noexcept;
  void look_at(Vec2 place, PedestrianBelief& belief) noexcept;
  void drop_unseen(const LineOfSight& sight) noexcept;
  void leave_hidden(const Target& target) noexcept;
  void birth() noexcept;
  void enter_still() noexcept;
  void note_history(Target& target) const noexcept;
  void publish() noexcept;
  [[nodiscard]] Scene& scene() noexcept { return scenes_[scanner_]; }

  PerceptionConfig config_;
  EvidenceMap still_;
  MapEntry entry_;
  IsolatedObstacles loose_;
  std::vector<Scene> scenes_;  ///< of each scanner's newest scan
  Entries entries_{};

  FirstScans first_scans_;
  PastScans past_;
  Targets targets_;
  OccludedTracks hidden_;
  std::uint32_t last_id_ = 0;
  double unreported_s_ = std::numeric_limits<double>::infinity();  ///< since an outside system last told of movers
  Time now_ = kNever, told_ = kNever;                              ///< the scan's stamp; the loop's time
  ScanOrder order_;
  std::size_t scanner_ = 0;  ///< of the scan at hand
  Pose2 map_from_first_;     ///< at that scan, of the first laser
  double behind_s_ = 0.0;    ///< 0 or less: so much before `now_` it was taken
  /// What it adds to how long things are seen: no more in a second than a second, however many look at them.
  double step_s_ = 0.0;

  FixedVector<Track, kMaxTracks> tracks_, moving_;
  StandingCandidates candidates_;
  StandingPedestrians standing_;  ///< those of them that are pedestrians
};

}  // namespace jaywalk
