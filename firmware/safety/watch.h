#pragma once
#include <vector>

#include "firmware/safety/blind_gaps.h"
#include "firmware/safety/stop_zone.h"

namespace jaywalk {

/// Where the body goes without the scan having proved that it is free.
///
/// It follows points all along the footprint's outline, grown by a margin, over the way that the robot needs to stop;
/// only those count that their motion pushes outward. Thread: the loop's; allocates in the constructor alone.
class Watch {
 public:
  /// `margin_m`: the most that is kept free round the footprint.
  Watch(const Footprint& footprint, const OfEach<Pose2>& robot_from_lasers, double margin_m);

  /// Speed (m/s) of the fastest point of the body that moves, by more than half of that speed, outward to where no
  /// laser ever looks; 0 where none does.
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
  [[nodiscard]] static double outward_mps(const RimPoint& rim, Vec2 moves) noexcept;
  [[nodiscard]] bool held_free(Vec2 place) const noexcept;

  Footprint footprint_;
  Lookout lookout_;
  double margin_m_;
  std::vector<RimPoint> rim_;
};

}  // namespace jaywalk
