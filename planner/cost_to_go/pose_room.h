#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "hal/types/robot_model.h"
#include "planner/cost_to_go/guide.h"
#include "planner/cost_to_go/pose_moves.h"

namespace jaywalk::field {

/// How much room a body's outline has at every pose of the lattice: by points along it, on nodes 2.5 cm apart. A pose
/// stands for the place in its cell, across its heading, at which the body has most room.
///
/// Memory in the constructor. Thread: the planner's.
class PoseRoom {
 public:
  static constexpr float kUnit_m = 0.008F;   ///< of room
  static constexpr float kShift_m = 0.035F;  ///< to one side of a cell's middle or the other

  explicit PoseRoom(const Footprint& body);

  /// By pose: room, and the shift to the left in kShift_m; of the lattice whose low corner is there. `walls`: surfaces
  /// beside the guide's, in the map.
  void find(const Guide& guide, Place low, std::span<const Vec2> walls, std::uint8_t* room,
            std::int8_t* shift) noexcept;
  /// By pose: how many of eight points of the outline lie where nothing was ever seen, but for those near the robot.
  /// Whether there are any.
  [[nodiscard]] bool find_unseen(const Guide& guide, Place low, std::uint8_t* unseen) noexcept;

 private:
  struct Point {
    float x, y;
    std::uint8_t radius;  ///< of a circle within the body, in kUnit_m; 0: of the outline
  };
  static constexpr std::int32_t kPerCell = 4, kMargin = 60;  ///< nodes; a body reaches 1.5 m from its axle at most
  static constexpr std::int32_t kNodes = PoseLattice::kSide * kPerCell + 2 * kMargin, kColumns = kNodes / kPerCell;

  [[nodiscard]] const std::uint8_t* row(const std::vector<std::uint8_t>& nodes, std::int32_t x, std::int32_t y) const;
  void take_nodes(const Guide& guide, Place low) noexcept;
  void add_wall(Place at) noexcept;
  void look_round(std::int32_t heading, std::int32_t shift) noexcept;

  std::vector<Point> points_;                 ///< in the body's frame
  std::array<Place, 8> rim_;                  ///< corners and the sides' middles
  std::vector<std::uint8_t> nodes_, unseen_;  ///< every fourth of a row side by side
  std::array<std::uint8_t, PoseLattice::kSide * PoseLattice::kSide> looked_{};
};

}  // namespace jaywalk::field
