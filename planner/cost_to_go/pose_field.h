#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "planner/cost_to_go/cost_settler.h"
#include "planner/cost_to_go/planner.h"
#include "planner/cost_to_go/pose_graph.h"
#include "planner/cost_to_go/pose_room.h"
#include "planner/cost_to_go/shortest.h"

namespace jaywalk::field {

/// What the time from poses depends on, beside the time to go from places.
struct PoseFieldRequest {
  const Guide& guide;
  Pose2 map_from_robot;
  Vec2 goal_in_map;
  std::span<const StandingPedestrian> standing = {};  ///< ways past them are dear
  PoseRequest asked;
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
    std::vector<std::uint16_t> cost;
    std::vector<std::uint8_t> rate, room, unseen;
    std::vector<std::int8_t> shift;
    PoseMoves moves;
    PoseSpeeds speeds{0.0F, 0.0F, 0.0F, 0.0F};
    Memory();
  };

  /// `settler`: asked first; where it fails, and without one, costs are settled here, with `entries` in the queue: five
  /// a pose, three were the most that any map took. Where they are too few no way is known from any pose.
  explicit PoseField(const Footprint& body, CostSettler* settler = nullptr, std::size_t entries = 1U << 20);

  /// Fills `memory` and returns a view of it.
  PoseGuide settle(const PoseFieldRequest& request, Memory& memory) noexcept;

 private:
  void weigh_standing(const StandingPedestrian& pedestrian, const PoseGuide& guide) noexcept;
  /// False where the goal lies beyond the square.
  [[nodiscard]] bool sow_goal(const PoseFieldRequest& request, const PoseGuide& guide, Memory& memory) noexcept;
  void sow_rim(const PoseFieldRequest& request, PoseGuide& guide, Memory& memory) noexcept;
  void forget_seeds(Memory& memory) noexcept;
  void sow(std::int32_t pose, float seconds, Memory& memory) noexcept;
  void settle_costs(bool anybody_stands, Memory& memory) noexcept;
  [[nodiscard]] bool settle_here(const PoseCosts& poses) noexcept;

  Footprint body_;
  CostSettler* settler_;
  PoseRoom room_;
  std::vector<std::uint8_t> dearer_;  ///< by pose, beside pedestrians that stand: PoseRates
  std::vector<std::int32_t> seeds_;   ///< poses that a cost is given for
  PoseGraph graph_;
  Shortest queue_;
  PoseWay way_;
};

}  // namespace jaywalk::field
