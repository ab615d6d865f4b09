#pragma once
// The paper's first two kernels and the marking. Lengths in cells, positions from the window's low corner, times in s.
#include <cmath>

#include "planner/cell/kalman.h"
#include "planner/paper/executor.h"

namespace jaywalk::paper {
/// The Gaussian mark exp(-d^2 / 2 s^2) counts as occupied above exp(-1/2): one standard deviation.
/// A higher reach closes doorways that movers leave open; measured by success, not by principle.
inline constexpr float kMarkDeviations = 1.0F;

/// Distance from a mover's expected position within which cells count as occupied: its body, the safety distance, and
/// one deviation (variance: per axis), at most `most_spread`: a mark that fills the room forbids nothing useful.
JAYWALK_CELL float mark_radius(float body, float safety, float variance, float most_spread) {
  const float spread = kMarkDeviations * std::sqrt(variance);
  return body + safety + (spread < most_spread ? spread : most_spread);
}

JAYWALK_CELL bool within(float dx, float dy, float radius) { return dx * dx + dy * dy <= radius * radius; }

/// The warp number of a place `ahead` of the robot and `left` of it, as the length r of the major axis of the ellipse
/// that it lies on (equation time-warp, solved for r): with r_x = 4 r_y and the centre 0.9 r ahead, 0.19 r^2 + 1.8 a r
/// - (a^2 + 16 l^2) = 0. Same unit as the offsets. Straight ahead a/1.9, straight behind 10 |a|, abeam 9.18 |l|.
JAYWALK_CELL float warp_radius(float ahead, float left) {
  return (std::sqrt(ahead * ahead + 3.04F * (left * left)) - 0.9F * ahead) / 0.19F;
}

/// Time (s) until a party of this speed has covered the warp radius, never beyond `cap_s`.
JAYWALK_CELL float horizon(float radius, float speed, float cap_s) {
  return radius >= speed * cap_s ? cap_s : radius / speed;
}

/// Occupants of a cell: a set of bits.
enum Occupant : std::uint8_t { kWall = 1, kMover = 2 };

/// A track in the window's units.
struct Mover {
  cell::AxisState x, y;
  float radius, speed;
};

/// The robot and the rules of marking.
struct Warping {
  float robot_x, robot_y, cos_heading, sin_heading;
  float cap_s;
  float safety;
  float most_spread;
  float process_noise;  ///< cells^2/s^3
};

/// Expected place of a mover at its horizon.
struct Mark {
  float x, y, radius, horizon_s;
};

/// Kernels 1 and 2: each mover predicted to the horizon of the cell that it stands in (outside: the cap).
struct PredictEachMover {
  Grid grid;
  Warping warping;
  const Mover* movers;
  Mark* marks;

  JAYWALK_CELL void operator()(std::int32_t k) const {
    const Mover& mover = movers[k];
    const bool inside = mover.x.position >= 0.0F && mover.y.position >= 0.0F &&
                        mover.x.position < static_cast<float>(grid.side) &&
                        mover.y.position < static_cast<float>(grid.side);
    float horizon_s = warping.cap_s;
    if (inside) {
      const float dx = middle_of_cell(mover.x.position) - warping.robot_x;
      const float dy = middle_of_cell(mover.y.position) - warping.robot_y;
      const float ahead = warping.cos_heading * dx + warping.sin_heading * dy;
      const float left = warping.cos_heading * dy - warping.sin_heading * dx;
      horizon_s = horizon(warp_radius(ahead, left), mover.speed, warping.cap_s);
    }
    const cell::AxisState x = cell::predict(mover.x, horizon_s, warping.process_noise);
    const cell::AxisState y = cell::predict(mover.y, horizon_s, warping.process_noise);
    marks[k] = {x.position, y.position, mark_radius(mover.radius, warping.safety, x.pp, warping.most_spread),
                horizon_s};
  }

 private:
  JAYWALK_CELL static float middle_of_cell(float at) {
    return static_cast<float>(static_cast<std::int32_t>(at)) + 0.5F;
  }
};

/// Cells that movers occupy: their marks.
struct MarkEachCell {
  Grid grid;
  const Mark* marks;
  std::int32_t mover_count;
  std::uint8_t* occupants;

  JAYWALK_CELL void operator()(std::int32_t i, std::int32_t j) const {
    bool is_marked = false;
    for (std::int32_t k = 0; k < mover_count; ++k) {
      is_marked |=
          within(static_cast<float>(i) + 0.5F - marks[k].x, static_cast<float>(j) + 0.5F - marks[k].y, marks[k].radius);
    }
    if (is_marked) occupants[grid.at(i, j)] |= kMover;
  }
};

}  // namespace jaywalk::paper
