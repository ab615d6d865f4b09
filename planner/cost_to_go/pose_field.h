#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "planner/cost_to_go/cost_settler.h"
#include "planner/cost_to_go/pose_guide.h"
#include "planner/cost_to_go/pose_room.h"
#include "planner/planner.h"

namespace jaywalk::field {

/// What the time from poses depends on, beside the time to go from places.
struct PoseFieldRequest {
  const Guide& guide;
  Pose2 map_from_robot;
  Vec2 goal_in_map;
  std::span<const MoverDisc> movers;  ///< ways past those that last are dear
  PoseRequest asked;
};

/// The time to the goal from every pose in a square about the robot, for the outline of its body. Sown at the goal,
/// with its heading where one is wanted, and where the 2-D way leads out of the square with the 2-D time from there;
/// settled backward in buckets. Costs are integers: the fixed point of cost[p] = min(cost[q] + step) over the moves p
/// to q, whatever the order of the work, up to what costs kBeyond_s more than the robot's own way.
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

  /// `settler`: asked first; where it fails, and without one, costs are settled here.
  explicit PoseField(const Footprint& body, CostSettler* settler = nullptr);

  /// Fills `memory` and returns a view of it.
  PoseGuide settle(const PoseFieldRequest& request, Memory& memory) noexcept;

 private:
  struct Entry {
    std::int32_t pose, next;
  };
  /// A move backward: from the pose that it leads to, to where it began.
  struct BackMove {
    std::int32_t offset;  ///< of poses
    std::uint32_t cost, unseen_weight;
  };

  void weigh(const PoseFieldRequest& request, const PoseGuide& guide, Memory& memory) const noexcept;
  void open_about(const Pose2& robot, const PoseGuide& guide, Memory& memory) const noexcept;
  void weigh_standing(const MoverDisc& mover, const PoseGuide& guide, Memory& memory) const noexcept;
  void turn_moves_back(const PoseMoves& moves) noexcept;
  void sow_goal(const PoseFieldRequest& request, const PoseGuide& guide, Memory& memory) noexcept;
  void sow_rim(const PoseFieldRequest& request, PoseGuide& guide, Memory& memory) noexcept;
  void offer(std::int32_t pose, std::uint32_t cost, std::uint16_t* costs) noexcept;
  void settle_costs(std::int32_t robot, const PoseGuide& guide, Memory& memory) noexcept;
  /// Returns what costs are of concern.
  [[nodiscard]] std::uint32_t spread(std::int32_t robot, const PoseGuide& guide, std::uint16_t* costs) noexcept;
  void relax(std::int32_t pose, std::uint32_t cost, const PoseGuide& guide, std::uint16_t* costs) noexcept;

  Footprint body_;
  CostSettler* settler_;
  PoseRoom room_;
  std::array<std::array<BackMove, 2 * PoseMoves::kMost>, PoseLattice::kHeadings> back_{};
  std::array<std::int32_t, PoseLattice::kHeadings> back_count_{};
  std::vector<Entry> entries_;
  std::vector<std::int32_t> buckets_;
  PoseWay way_;
};

}  // namespace jaywalk::field
