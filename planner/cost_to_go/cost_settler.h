#pragma once
// The time to go's long work, done elsewhere than by the processor's loops and queues: on a device.
#include <cstdint>

#include "planner/cost_to_go/pose_look.h"
#include "planner/cost_to_go/pose_moves.h"

namespace jaywalk::field {

/// cost[p] = min(cost[q] + step(p, q)) over the moves p to q of a lattice of poses.
struct PoseCosts {
  const std::uint8_t* rate;    ///< 0: no place for the body
  const std::uint8_t* unseen;  ///< null: none anywhere
  const PoseMoves& moves;
  std::int32_t robot;    ///< pose; negative: none
  std::uint32_t beyond;  ///< more than the robot's cost: of no concern
  std::uint16_t* cost;   ///< what is given, else PoseGuide::kNoWay; then the fixed point, where that is of concern
};

/// cost[n] = min(cost[c] + step) over sixteen neighbours (guide_ways.h).
struct CellCosts {
  std::int32_t side;
  const std::uint16_t* rate;  ///< 0: not free
  std::int32_t robot;         ///< cell
  std::uint32_t beyond;       ///< more than the robot's cost: of no concern
  std::uint32_t* cost;        ///< what is given, else kNoWay; then the fixed point, where that is of concern
};

class CostSettler {
 public:
  CostSettler() = default;
  virtual ~CostSettler() = default;
  CostSettler(const CostSettler&) = delete;
  CostSettler& operator=(const CostSettler&) = delete;
  /// False: it failed, and nothing has been written.
  [[nodiscard]] virtual bool settle(const PoseCosts& poses) noexcept = 0;
  [[nodiscard]] virtual bool settle(const CellCosts& cells) noexcept = 0;
  /// The room and shift of all poses.
  [[nodiscard]] virtual bool find(const PoseLook& look) noexcept = 0;
};

}  // namespace jaywalk::field
