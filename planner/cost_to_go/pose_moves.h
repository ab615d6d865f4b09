#pragma once
// Poses on a lattice, the moves between them that a robot with two driven wheels can make, and their prices.
#include <array>
#include <cstdint>

#include "planner/cell/cell.h"

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
};

namespace price {

inline constexpr float kPoseLeast_m = 0.045F;                   ///< nearer than this to a surface there is no way
inline constexpr float kPoseNear = 20.0F, kPoseNear_m = 0.15F;  ///< a second more at the edge, and how far that reaches
inline constexpr float kPoseBy = 0.6F, kPoseBy_m = 0.28F;
// Beside a pedestrian that stands, by the gap to its disc; the same for cells and for poses.
/// Nearer the robot does not pass: at 0.12 a wheelchair left 0.15 m, at 0.2 0.28 m (WORLDS passages, seed 331).
inline constexpr float kFromStanding_m = 0.2F;
inline constexpr float kBeside = 4.0F, kBeside_m = 0.25F;  ///< a second more. At 10 it circled before narrow passages
inline constexpr float kPolite = 2.0F, kPolite_m = 1.0F;   ///< the same, out to where it may pass at 1 m/s (kTooFast)
/// Beyond the lattice: facing across the way, and twice as much facing back; and so far ahead that is looked for.
inline constexpr float kFacing_s = 1.3F, kFacing_m = 0.35F;

inline constexpr std::uint32_t kRateOfOpen = 8;  ///< integers, of a second that costs a second
inline constexpr std::uint32_t kLeastCost = 16;  ///< of a move: a bucket's width

/// How much dearer a move into what was never seen is: a second ahead, back, and turning where the laser does not look.
JAYWALK_CELL constexpr std::uint32_t unseen_weight(Gear gear, std::int32_t turn) {
  return gear == Gear::kForward ? 1U : turn != 0 ? 30U : 2U;
}

/// Cost of a move between two poses.
JAYWALK_CELL constexpr std::uint32_t cost_of(std::uint32_t in_open, std::uint32_t rate, std::uint32_t other_rate,
                                             std::uint32_t unseen_eighths, std::uint32_t unseen_weight) {
  const std::uint32_t cost =
      (in_open * (rate + other_rate)) / (2U * kRateOfOpen) + in_open * unseen_eighths * unseen_weight / 8U;
  return cost < kLeastCost ? kLeastCost : cost;
}

}  // namespace price
}  // namespace jaywalk
