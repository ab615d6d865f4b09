#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "hal/types/robot_model.h"
#include "planner/cost_to_go/cost_settler.h"
#include "planner/cost_to_go/guide.h"
#include "planner/cost_to_go/pose_moves.h"

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

}  // namespace jaywalk::field
