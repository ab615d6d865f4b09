#pragma once
// The paper's first two kernels and the marking: warp of each cell, prediction of each mover, cells
// occupied. Lengths in cells, positions from the window's low corner, times in seconds.
#include "planner/cell/kalman.h"
#include "planner/cell/mark.h"
#include "planner/cell/warp.h"
#include "planner/mapping/grid.h"

namespace jaywalk::field {

/// What stands in a cell: a set of bits.
enum Occupant : std::uint8_t { kWall = 1, kMover = 2 };

/// A track in the window's units.
struct Mover {
  cell::AxisState x, y;
  float radius, speed;
};

/// The robot and the rules of marking.
struct Warping {
  bool ellipses;  ///< mode paper: one warp a mover; otherwise one arrival time a cell
  float robot_x, robot_y, cos_heading, sin_heading;
  float robot_speed;
  float cap_s;
  float safety;
  float most_spread;
  float process_noise;  ///< cells^2/s^3
  float reach;          ///< mode full: movers occupy no cell farther than this from the robot
};

/// Where a mover is expected at its horizon.
struct Mark {
  float x, y, radius, horizon_s;
};

JAYWALK_CELL Mark mark_at(const Mover& mover, const Warping& warping, float horizon_s) {
  const cell::AxisState x = cell::predict(mover.x, horizon_s, warping.process_noise);
  const cell::AxisState y = cell::predict(mover.y, horizon_s, warping.process_noise);
  return {x.position, y.position, cell::mark_radius(mover.radius, warping.safety, x.pp, warping.most_spread),
          horizon_s};
}

/// Kernel 1: the warp radius of each cell.
struct WarpOfEachCell {
  Grid grid;
  Warping warping;
  float* warp;

  JAYWALK_CELL void operator()(std::int32_t i, std::int32_t j) const {
    const float dx = static_cast<float>(i) + 0.5F - warping.robot_x;
    const float dy = static_cast<float>(j) + 0.5F - warping.robot_y;
    const float ahead = warping.cos_heading * dx + warping.sin_heading * dy;
    const float left = warping.cos_heading * dy - warping.sin_heading * dx;
    warp[grid.at(i, j)] = warping.ellipses ? cell::warp_radius(ahead, left) : cell::arrival_radius(ahead, left);
  }
};

/// Kernel 2: each mover predicted to the horizon of the cell that it stands in (outside: the cap).
struct PredictEachMover {
  Grid grid;
  Warping warping;
  const float* warp;
  const Mover* movers;
  Mark* marks;

  JAYWALK_CELL void operator()(std::int32_t k) const {
    const Mover& mover = movers[k];
    const bool inside = mover.x.position >= 0.0F && mover.y.position >= 0.0F &&
                        mover.x.position < static_cast<float>(grid.side) &&
                        mover.y.position < static_cast<float>(grid.side);
    float horizon_s = warping.cap_s;
    if (inside) {
      const auto i = static_cast<std::int32_t>(mover.x.position);
      const auto j = static_cast<std::int32_t>(mover.y.position);
      const float speed = warping.ellipses ? mover.speed : warping.robot_speed;
      horizon_s = cell::horizon(warp[grid.at(i, j)], speed, warping.cap_s);
    }
    marks[k] = mark_at(mover, warping, horizon_s);
  }
};

/// Cells of a piece of a row that movers occupy: at their marks in mode paper; otherwise where a mover now is,
/// and where it will be at the cell's own time of arrival.
struct MarkRow {
  Grid grid;
  std::int32_t cells;  ///< of a piece; divides the side
  Warping warping;
  const float* warp;
  const Mover* movers;
  const Mark* marks;
  std::int32_t mover_count;
  std::uint8_t* occupants;

  JAYWALK_CELL void operator()(std::int32_t piece, std::int32_t j) const {
    for (std::int32_t k = 0; k < mover_count; ++k) {
      const Mover& mover = movers[k];
      if (warping.ellipses) {
        disc(marks[k].x, marks[k].y, marks[k].radius, piece, j);
      } else {
        disc(mover.x.position, mover.y.position, mover.radius, piece, j);
        swept(mover, piece, j);
      }
    }
  }

 private:
  /// The piece's columns between two places.
  struct Columns {
    std::int32_t first, last;
  };
  JAYWALK_CELL Columns columns(float low, float high, std::int32_t piece) const {
    const std::int32_t a = column(low), b = column(high), first = piece * cells, last = first + cells - 1;
    return {a > first ? a : first, b < last ? b : last};
  }
  JAYWALK_CELL std::int32_t column(float x) const {
    const auto last = static_cast<float>(grid.side - 1);
    return static_cast<std::int32_t>(x < 0.0F ? 0.0F : (x > last ? last : x));
  }

  JAYWALK_CELL void disc(float x, float y, float radius, std::int32_t piece, std::int32_t j) const {
    const float dy = static_cast<float>(j) + 0.5F - y;
    if (dy > radius || dy < -radius) return;
    const Columns across = columns(x - radius, x + radius, piece);
    for (std::int32_t i = across.first; i <= across.last; ++i) {
      if (cell::within(static_cast<float>(i) + 0.5F - x, dy, radius)) occupy(i, j);
    }
  }

  JAYWALK_CELL void occupy(std::int32_t i, std::int32_t j) const {
    const std::int32_t c = grid.at(i, j);
    if (warping.ellipses || warp[c] <= warping.reach) occupants[c] |= kMover;
  }

  JAYWALK_CELL void swept(const Mover& mover, std::int32_t piece, std::int32_t j) const {
    const Mark last = mark_at(mover, warping, warping.cap_s);
    const float centre_y = static_cast<float>(j) + 0.5F;
    const float low_y = mover.y.position < last.y ? mover.y.position : last.y;
    const float high_y = mover.y.position < last.y ? last.y : mover.y.position;
    if (centre_y < low_y - last.radius || centre_y > high_y + last.radius) return;
    const float low_x = mover.x.position < last.x ? mover.x.position : last.x;
    const float high_x = mover.x.position < last.x ? last.x : mover.x.position;
    const Columns across = columns(low_x - last.radius, high_x + last.radius, piece);
    for (std::int32_t i = across.first; i <= across.last; ++i) {
      const Mark then = mark_at(mover, warping, cell::horizon(warp[grid.at(i, j)], warping.robot_speed, warping.cap_s));
      const float dx = static_cast<float>(i) + 0.5F - then.x;
      if (cell::within(dx, centre_y - then.y, then.radius)) occupy(i, j);
    }
  }
};

}  // namespace jaywalk::field
