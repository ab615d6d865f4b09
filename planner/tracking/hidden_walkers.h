#pragma once
// Walkers who went out of view, remembered for when they come out again: whoever does so where and when he should is
// the same one, and still walks.
#include "planner/tracking/bodies.h"
#include "planner/scan/line_of_sight.h"

namespace jaywalk {

/// Most that are remembered; when full, who has been out of view longest is forgotten.
inline constexpr std::size_t kMaxHiddenWalkers = 32;

/// How long anybody is remembered, s: by trial on simulated seeds 1 to 6, longer gains next to nothing.
inline constexpr double kRememberedS = 8.0;

/// Nobody here is a track: nothing is said of where they are until they are seen.
class HiddenWalkers {
 public:
  /// `body` moved when it was last seen, and is no track any more. One known too shortly is not remembered.
  void remember(const Body& body) noexcept;

  /// Forgets who has been away for long, or since a time yet to come, and who is not where he should be: beams pass
  /// over that place.
  void wait(const LineOfSight& sight, Time now, double step_s) noexcept;

  /// `newcomer`, seen for the first time, takes the name, the speed and the width of the walker that should be where
  /// it is, and moves. How noisy it is seen is learnt anew: half of it may be hidden yet. False, and nothing changes,
  /// when there is none.
  bool return_as(Body& newcomer, Time now) noexcept;

  /// Whether one of them was within `within_m` of a place when he was seen last.
  [[nodiscard]] bool lost_near(Vec2 place, double within_m) const noexcept;

  [[nodiscard]] std::size_t size() const { return walkers_.size(); }

 private:
  struct Walker {
    Track as_seen;  ///< last
    double arc_m = 0.0;
    Time born = kNever;
    double looked_through_s = 0.0;

    /// Straight on: of those who come out again within seconds, most did.
    [[nodiscard]] Vec2 place_at(Time now) const;
  };
  FixedVector<Walker, kMaxHiddenWalkers> walkers_;
};

}  // namespace jaywalk
