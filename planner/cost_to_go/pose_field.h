#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "planner/cost_to_go/cost_settler.h"
#include "planner/cost_to_go/planner.h"
#include "planner/cost_to_go/shortest.h"

namespace jaywalk::field {

/// How much room a body's outline has at every pose of the lattice: by points along it, on nodes 2.5 cm apart
/// (PoseLook).
///
/// Memory in the constructor. Thread: the planner's.
class PoseRoom {
 public:
  static constexpr float kUnit_m = 0.008F;   ///< of room
  static constexpr float kShift_m = 0.035F;  ///< to one side of a cell's middle or the other

  explicit PoseRoom(const Footprint& body);

  /// Of the lattice whose low corner is there. `walls`: surfaces beside the guide's, in the map.
  void take_surfaces(const Guide& guide, Place low, std::span<const Vec2> walls) noexcept;
  /// By pose: room, and the shift to the left in kShift_m.
  [[nodiscard]] PoseLook look(std::uint8_t* room, std::int8_t* shift) const noexcept {
    return {nodes_.data(), places_.data(), radius_.data(), static_cast<std::int32_t>(radius_.size()), room, shift};
  }
  /// Does as `look` says.
  void find(const PoseLook& look) const noexcept;
  /// By pose: how many of eight points of the outline lie where nothing was ever seen, but for those near the robot.
  /// Whether there are any.
  [[nodiscard]] bool find_unseen(const Guide& guide, Place low, std::uint8_t* unseen) noexcept;

 private:
  static constexpr std::int32_t kPerCell = PoseLook::kPerCell, kMargin = PoseLook::kMargin;
  static constexpr std::int32_t kNodes = PoseLook::kNodes, kColumns = PoseLook::kColumns;

  void add_wall(Place at) noexcept;
  void look_along(const std::int32_t* places, std::int32_t j, std::uint8_t* least) const noexcept;

  std::vector<std::uint8_t> radius_;                                     ///< of each point, in kUnit_m
  std::vector<std::int32_t> places_;                                     ///< as PoseLook has them
  std::array<std::array<std::int32_t, 8>, PoseLattice::kHeadings> rim_;  ///< the same of corners and sides' middles
  std::vector<std::uint8_t> nodes_, unseen_;                             ///< every fourth of a row side by side
};

/// The time to the goal from every pose in a square about the robot, for the outline of its body. Sown at the goal,
/// with its heading where one is wanted, and where the 2-D way leads out of the square with the 2-D time from there;
/// settled backward in buckets. Costs are integers: the fixed point of cost[p] = min(cost[q] + step) over the moves p
/// to q, whatever the order of the work, up to what costs kBeyond_s more than the robot's own way.
/// Each plan settles all costs anew: the times at the square's rim, from which they come, change with each.
///
/// Memory in the constructor. Thread: the planner's.
class PoseField {
 public:
  /// The arrays that a result needs; take one a result, for one PoseField.
  struct Memory {
    std::vector<std::uint16_t> cost = std::vector(PoseLattice::kPoses, PoseGuide::kNoWay);
    std::vector<std::uint8_t> rate = std::vector<std::uint8_t>(PoseLattice::kPoses), room = rate, unseen = rate;
    std::vector<std::int8_t> shift = std::vector<std::int8_t>(PoseLattice::kPoses);
    PoseMoves moves;
    PoseSpeeds speeds{0.0F, 0.0F, 0.0F, 0.0F};
  };

  /// `settler`: asked first; where it fails, and without one, costs are settled here, with `entries` in the queue: five
  /// a pose, three were the most that any map took. Where they are too few no way is known from any pose.
  explicit PoseField(const Footprint& body, CostSettler* settler = nullptr, std::size_t entries = 1U << 20);

  /// Fills `memory` and returns a view of it. `places`: the time to go from places, for the same request.
  PoseGuide settle(const PlanRequest& request, const Guide& places, Memory& memory) noexcept;

 private:
  void weigh_standing(const StandingPedestrian& pedestrian, const PoseGuide& guide) noexcept;
  /// False where the goal lies beyond the square.
  [[nodiscard]] bool sow_goal(const PlanRequest& request, const PoseGuide& guide, Memory& memory) noexcept;
  void sow_rim(const Guide& places, PoseGuide& guide, Memory& memory) noexcept;
  void forget_seeds(Memory& memory) noexcept;
  void sow(std::int32_t pose, float seconds, Memory& memory) noexcept;
  void settle_costs(const PoseCosts& poses) noexcept;
  [[nodiscard]] bool settle_here(const PoseCosts& poses) noexcept;

  Footprint body_;
  CostSettler* settler_;
  PoseRoom room_;
  std::vector<std::uint8_t> dearer_;  ///< by pose, beside pedestrians that stand: PoseRates
  std::vector<std::int32_t> seeds_;   ///< poses that a cost is given for
  BackMoves moves_{};
  Shortest queue_;
  PoseWay way_;
};

}  // namespace jaywalk::field
