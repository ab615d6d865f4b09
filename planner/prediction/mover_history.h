#pragma once
#include <cstdint>
#include <span>

#include "hal/types/fixed_vector.h"
#include "hal/types/laser_scan.h"
#include "planner/cost_to_go/planner.h"
#include "planner/mapping/evidence_map.h"
#include "planner/prediction/futures.h"
#include "planner/scan/line_of_sight.h"
#include "planner/tracking/occlusion.h"
#include "planner/tracking/track.h"

namespace jaywalk::motion {
/// Movers out of sight: where each may be by now, as kFutures walkers that walk on, less those whose place has been
/// seen to be empty. Gone when hardly one is left, or after kRememberedS. Thread: the loop's.
class OccludedMovers {
 public:
  static constexpr std::size_t kMost = 16;  ///< when full, newcomers are left out

  /// Out of sight from now on.
  void add(const MoverBelief& belief, const TurningModel& turning, const Guide& guide) noexcept;
  /// Seen again under its own name.
  void remove(std::uint32_t id) noexcept;
  /// Whether one of them may have come out at a place; it is no longer occluded then, and `usual_mps` is its.
  bool take(Vec2 place, double& usual_mps) noexcept;
  /// `dt` seconds later, with what the scans pass through.
  void update(float dt, const OfEach<SeenFrom>& scans, const TurningModel& turning, const Guide& guide) noexcept;

  [[nodiscard]] std::span<const OccludedMover> movers() const { return {movers_.data(), movers_.size()}; }

 private:
  FixedVector<OccludedMover, kMost> movers_;
};

/// What a new scan has shown.
struct Seen {
  Time now{};
  Pose2 map_from_robot{};
  std::span<const Track> tracks;
  std::span<const StandingPedestrian> standing;
  const EvidenceMap& still;
  OfEach<SeenFrom> scans;  ///< the newest of each scanner
  const Guide& guide;
};

/// What is kept of each track beyond what the tracker says: how fast it walks, what it did when nothing made it turn,
/// and where it may be when it is out of sight. Thread: the loop's.
class MoverHistory {
 public:
  void update(const Seen& seen) noexcept;

  /// Of every track that may walk within reach of the robot, nearest first.
  [[nodiscard]] std::span<const MoverBelief> beliefs() const { return {beliefs_.data(), beliefs_.size()}; }
  [[nodiscard]] std::span<const OccludedMover> hidden() const { return occluded_.movers(); }
  [[nodiscard]] const TurningModel& turning() const { return turning_; }
  /// Bodies that the map may hold and that are no walls.
  [[nodiscard]] std::span<const MoverDisc> masked() const { return {masked_.data(), masked_.size()}; }
  /// Pedestrians within reach of the robot that have stood for over four seconds, tracked or not.
  [[nodiscard]] std::span<const StandingPedestrian> standing() const { return {standing_.data(), standing_.size()}; }

 private:
  /// One look at a track, half a second after the one before.
  struct Look {
    Vec2 place, velocity;
  };
  /// What was learned of one track. Each estimate keeps its own state here: more fields than a struct has elsewhere.
  struct History {
    Track track;  ///< as last seen
    bool here = false;
    bool came_out = false;  ///< of those out of sight one may have come out here
    bool counted = false;   ///< among the newcomers
    Time first_seen{};
    double usual_mps = 0.0, steady_s = 0.0;
    Vec2 velocity;  ///< believed: the track's, but for a drop that did not last
    int drops = 0;
    Time looked{};
    Look before{}, last{};
    int looks = 0, rests = 0;

    [[nodiscard]] bool is_pedestrian() const { return track.is_pedestrian || came_out; }
  };

  History& history_of(const Track& track, const Seen& seen) noexcept;
  static void note(History& m, const Track& track) noexcept;
  void learn(History& m, const Seen& seen) noexcept;
  void count_newcomer(History& m, double known_s, double enough_s) noexcept;
  [[nodiscard]] bool in_the_open(const History& m, const Seen& seen) const noexcept;
  void forget_gone(const Seen& seen) noexcept;
  void believe(const Seen& seen) noexcept;
  [[nodiscard]] bool may_walk(const History& m, const Seen& seen) const noexcept;
  [[nodiscard]] MoverBelief belief_of(const History& m, Time now) const noexcept;
  void add_standing(const Seen& seen) noexcept;

  FixedVector<History, kMaxTracks> histories_;
  FixedVector<MoverBelief, kMaxTracks> beliefs_;
  FixedVector<MoverDisc, kMaxTracks> masked_;
  StandingPedestrians standing_;
  OccludedMovers occluded_;
  TurningModel turning_;
  Time before_ = kNever;
};

}  // namespace jaywalk::motion
