#pragma once
#include <span>
#include <vector>

#include "hal/types/fixed_vector.h"
#include "hal/types/laser_scan.h"
#include "planner/mapping/evidence_map.h"
#include "planner/prediction/occluded_movers.h"
#include "planner/prediction/walker.h"
#include "planner/tracking/stander.h"
#include "planner/tracking/track.h"
#include "planner/planner.h"

namespace jaywalk::motion {

/// What a new scan has shown.
struct Seen {
  Time now{};
  Time stamp = kNever;  ///< the scan's
  Pose2 map_from_robot{};
  std::span<const Track> tracks;
  std::span<const Stander> standing;
  const EvidenceMap& still;
  const LaserScan& scan;
  Pose2 map_from_laser{};  ///< at the scan
  const Guide& guide;
};

/// What is kept of each track beyond what the tracker says: whether it ever walked, how fast it does, for how long it
/// has stood, what it did when nothing made it turn, and where it may be when it is out of sight. Thread: the loop's.
class MoverMemory {
 public:
  void update(const Seen& seen) noexcept;

  /// Of everybody who may walk within reach of the robot, nearest first.
  [[nodiscard]] std::span<const MoverBelief> beliefs() const { return {beliefs_.data(), beliefs_.size()}; }
  [[nodiscard]] std::span<const Walker> hidden() const { return occluded_.walkers(); }
  [[nodiscard]] const TurningModel& turning() const { return turning_; }
  /// Bodies that the map may hold and that are no walls.
  [[nodiscard]] std::span<const MoverDisc> masked() const { return {masked_.data(), masked_.size()}; }

 private:
  /// One look at a track, half a second after the one before.
  struct Look {
    Vec2 place, velocity;
  };
  struct Memory {
    Track track;  ///< as last seen
    bool here = false, has_walked = false;
    bool counted = false;  ///< among the newcomers
    Time first_seen{}, still_since{};
    Vec2 anchor;  ///< it has been within kStillM of there since then
    double usual_mps = 0.0, steady_s = 0.0;
    Vec2 velocity;  ///< believed: the track's, but for a drop that did not last
    int drops = 0;
    Time looked{};
    Look before{}, last{};
    int looks = 0, rests = 0;
  };

  Memory& memory_of(const Track& track, const Seen& seen) noexcept;
  void note(Memory& m, const Track& track, const Seen& seen) noexcept;
  void learn(Memory& m, const Seen& seen) noexcept;
  void count_newcomer(Memory& m, double known_s, double enough_s) noexcept;
  [[nodiscard]] bool in_the_open(const Memory& m, const Seen& seen) const noexcept;
  void forget_gone(const Seen& seen) noexcept;
  void believe(const Seen& seen) noexcept;
  [[nodiscard]] bool may_walk(const Memory& m, const Seen& seen) const noexcept;
  [[nodiscard]] MoverBelief belief_of(const Memory& m, Time now) const noexcept;
  void add_standers(const Seen& seen) noexcept;

  FixedVector<Memory, kMaxTracks> memories_;
  FixedVector<MoverBelief, kMaxTracks> beliefs_;
  FixedVector<MoverDisc, kMaxTracks> masked_;
  OccludedMovers occluded_;
  TurningModel turning_;
  Time before_ = kNever;
};

}  // namespace jaywalk::motion
