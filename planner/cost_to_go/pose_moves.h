#pragma once
// Poses on a lattice, and the moves between them that a robot with two driven wheels can make.
#include <array>
#include <cstdint>

#include "planner/cell/circle.h"

namespace jaywalk {

enum class Gear : std::uint8_t { kForward, kBackward, kTurn };

/// 64 x 64 cells of 0.1 m with 48 headings each, and a rim round the cells that no move leaves. A cell's headings lie
/// side by side: the moves to a pose come from few lines of a cache.
struct PoseLattice {
  static constexpr std::int32_t kSide = 64, kHeadings = 48, kReach = 4;
  static constexpr std::int32_t kStride = kSide + 2 * kReach, kPoses = kHeadings * kStride * kStride;
  static constexpr float kCell_m = 0.1F, kStep_rad = 2.0F * cell::kPiF / static_cast<float>(kHeadings);

  /// Numbers of cell and heading; the cell may lie in the rim.
  JAYWALK_CELL static constexpr std::int32_t at(std::int32_t i, std::int32_t j, std::int32_t heading) {
    return ((j + kReach) * kStride + i + kReach) * kHeadings + heading;
  }
  JAYWALK_CELL static constexpr std::int32_t heading_of(std::int32_t pose) { return pose % kHeadings; }
  JAYWALK_CELL static constexpr std::int32_t i_of(std::int32_t pose) { return pose / kHeadings % kStride - kReach; }
  JAYWALK_CELL static constexpr std::int32_t j_of(std::int32_t pose) { return pose / kHeadings / kStride - kReach; }
  /// From a pose to the one so many cells and headings on.
  JAYWALK_CELL static constexpr std::int32_t offset(std::int32_t di, std::int32_t dj, std::int32_t headings) {
    return (dj * kStride + di) * kHeadings + headings;
  }
  JAYWALK_CELL static constexpr std::int32_t wrapped(std::int32_t heading) {
    return (heading % kHeadings + kHeadings) % kHeadings;
  }
};

/// Costs are counted in these, so that they add up to the same in any order.
inline constexpr float kPoseCostsPerSecond = 256.0F;

/// How fast the body drives and turns, SI.
struct PoseSpeeds {
  float forward = 0.6F, back = 0.3F;
  float turn = 1.0F;  ///< while it drives
  float spot = 0.3F;  ///< on the spot
  bool operator==(const PoseSpeeds&) const = default;
};

struct PoseMove {
  std::int8_t di = 0, dj = 0, turn = 0;  ///< cells and steps of heading, left positive
  Gear gear = Gear::kForward;
  std::uint16_t cost = 0;  ///< in the open
  bool operator==(const PoseMove&) const = default;
};

/// The moves from each heading: ahead and back, straight or in arcs, each to cells whose direction is off by no more
/// than a step of heading; and turns on the spot.
struct PoseMoves {
  static constexpr int kMost = 20;
  std::array<std::array<PoseMove, kMost>, PoseLattice::kHeadings> from{};
  std::array<std::int32_t, PoseLattice::kHeadings> count{};

  /// Anew for other speeds.
  void draw(const PoseSpeeds& speeds) noexcept;

 private:
  void add(std::int32_t heading, const PoseMove& move) noexcept;
  void add_best(std::int32_t heading, std::int32_t turn, Gear gear, float side, const PoseSpeeds& speeds) noexcept;
};

}  // namespace jaywalk
