#pragma once
// Targets that are not seen, and standing pedestrians, as wide as a pedestrian though the map holds only shins.
#include "hal/types/fixed_vector.h"
#include "hal/types/geometry.h"
#include "hal/types/time.h"
#include "planner/mapping/evidence_map.h"
#include "planner/scan/line_of_sight.h"
#include "planner/tracking/target.h"

namespace jaywalk {
/// Whether a target that is not seen is no track any more: beams have passed through where it should be, or it has been
/// unseen for longer than one that moves, stands or is not confirmed yet may be.
[[nodiscard]] bool is_gone(const Track& track, const Existence& existence, Time now) noexcept;

/// Most that are remembered; when full, the one that has been out of view longest is forgotten.
inline constexpr std::size_t kMaxOccludedTracks = 32;

/// How long an occluded track is remembered, s: by trial on simulated seeds 1 to 6, longer gains next to nothing.
inline constexpr double kRememberedS = 8.0;

/// Tracks that moved out of view: a target that comes out where and when one of them should is the same one, and still
/// moves. None of them is published: nothing is said of where they are until they are seen.
class OccludedTracks {
 public:
  /// `target` moved when it was last seen, and is no track any more. One known too shortly is not remembered.
  void remember(const Target& target) noexcept;

  /// Forgets what has been out of view for long, or since a time yet to come, and what is not where it should be: beams
  /// pass over that place.
  void update(const LineOfSight& sight, Time now, double step_s) noexcept;

  /// `newcomer`, seen for the first time, takes the identity, the speed and the width of the track that should be where
  /// it is, and moves. How noisy it is seen is learnt anew: half of it may be hidden yet. False, and nothing changes,
  /// when there is none.
  bool reidentify(Target& newcomer, Time now) noexcept;

  [[nodiscard]] std::size_t size() const { return tracks_.size(); }

 private:
  struct Occluded {
    Track as_seen;  ///< last
    double arc_m = 0.0;
    Time born = kNever;
    double looked_through_s = 0.0;

    /// Straight on: of those that come out again within seconds, most did.
    [[nodiscard]] Vec2 place_at(Time now) const {
      return as_seen.position_in_map + as_seen.velocity_in_map * to_seconds(now - as_seen.last_seen);
    }
  };
  FixedVector<Occluded, kMaxOccludedTracks> tracks_;
};

/// Standing pedestrian, or a candidate for one. The disc is the whole body, of which a low laser sees the shins only.
struct StandingPedestrian {
  Vec2 position_in_map;
  double radius_m = 0.0;
  Time last_seen = kNever;    ///< it, or something that stood in its place
  Time since = kNever;        ///< known to stand there
  PedestrianBelief belief{};  ///< that it is one
  bool followed = false;      ///< a target stands here, and this copies its belief
};

using StandingPedestrians = FixedVector<StandingPedestrian, kMaxTracks>;

/// Standing candidates, pedestrians first. When full, candidates that are no pedestrians are dropped.
using StandingCandidates = FixedVector<StandingPedestrian, 3 * kMaxTracks>;

/// A confirmed target that does not move stands where it was seen last. What is no target any more (the map has it)
/// stands there for as long as the map has something as near to its middle as legs are, or a target stands so near,
/// however little of it is seen; or while it may be hidden there, for kRememberedS. A target takes over what was
/// believed of what stood in its place. What is hardly a pedestrian is dropped.
void update_standing(Targets& targets, const EvidenceMap& still, const LineOfSight& sight, Time now,
                     StandingCandidates& standing) noexcept;

}  // namespace jaywalk
