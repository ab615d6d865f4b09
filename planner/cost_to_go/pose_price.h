#pragma once
// Prices of the moves between poses.
#include <cstdint>

#include "planner/cell/cell.h"
#include "planner/cost_to_go/pose_moves.h"

namespace jaywalk::price {

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

}  // namespace jaywalk::price
