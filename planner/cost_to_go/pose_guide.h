#pragma once
// The time to the goal from poses near the robot, and the way there: what motion of a body that is not round is
// weighed against, and proposes.
#include <array>
#include <cstdint>

#include "planner/cost_to_go/guide.h"
#include "planner/cost_to_go/pose_moves.h"

namespace jaywalk {

struct WayPose {
  float x = 0.0F, y = 0.0F, heading = 0.0F;
  Gear gear = Gear::kForward;  ///< of the move that leads here
  float room_m = 0.0F;         ///< about the outline
};

struct PoseWay {
  static constexpr std::int32_t kMost = 96;
  std::array<WayPose, kMost> poses{};
  std::int32_t count = 0;
};

/// A look at what PoseField has computed; plain values. Valid as long as the plan that it came with.
struct PoseGuide {
  static constexpr std::uint16_t kNoWay = 65535;

  bool known = false;           ///< there is a way from the robot
  bool goal_closed = false;     ///< as the heading there is wanted, the body has no room at the goal
  bool through_unseen = false;  ///< that soon backs or turns into what was never seen
  float low_x = 0.0F, low_y = 0.0F;
  float least_s = 0.0F;  ///< added to all costs
  float speed_mps = 0.6F;
  const std::uint16_t* cost = nullptr;
  const std::uint8_t* rate = nullptr;    ///< of a second there, in kRateOfOpen; 0: no place for the body
  const std::uint8_t* unseen = nullptr;  ///< eighths of the outline; null: none anywhere
  const std::uint8_t* room = nullptr;
  const std::int8_t* shift = nullptr;
  const PoseMoves* moves = nullptr;

  /// Seconds, between the poses round one that have a way; Guide::kNoWay_s where none has. Beyond the lattice the 2-D
  /// time, and a price for facing elsewhere.
  [[nodiscard]] float time_to_go(const Guide& guide, float x, float y, float heading) const noexcept;
  [[nodiscard]] bool covers(float x, float y) const noexcept;
  [[nodiscard]] Place middle_of(std::int32_t i, std::int32_t j) const noexcept;
  /// The lattice's pose in the same cell, with the nearest heading; -1 beyond the lattice.
  [[nodiscard]] std::int32_t pose_at(float x, float y, float heading) const noexcept;
  /// From the lattice's pose that suits best. Empty where there is none.
  void way_from(float x, float y, float heading, PoseWay& out) const noexcept;

  /// Where a move leads, and what it costs; kNoWay where the body cannot be.
  struct Step {
    std::int32_t to = 0;
    std::uint32_t cost = kNoWay;
  };
  [[nodiscard]] Step step(std::int32_t pose, const PoseMove& move) const noexcept;

  /// The 2-D time from a place, and a price for facing away from where that falls.
  [[nodiscard]] float time_beyond(const Guide& guide, float x, float y, const cell::Heading& along) const noexcept;

 private:
  [[nodiscard]] std::int32_t nearest(float x, float y, float heading) const noexcept;
  [[nodiscard]] WayPose place_of(std::int32_t pose, Gear gear) const noexcept;
};

}  // namespace jaywalk
