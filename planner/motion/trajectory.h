#pragma once
#include <array>
#include <cstdint>

#include "hal/types/time.h"
#include "planner/motion/robot_motion.h"

namespace jaywalk::motion {

inline constexpr float kStepS = 0.1F;  ///< of a trajectory
inline constexpr int kSteps = 60;      ///< 6 s: with 4 s, a third fewer of others' worlds were reached (prototype)

inline constexpr float kLagS = 0.05F;                                  ///< from a decision until the wheels follow it
inline constexpr Duration kHoldsFor = std::chrono::milliseconds(500);  ///< without a new decision; then it stops
inline constexpr float kRestsMps = 0.02F;                              ///< below this speed the robot is at rest

inline constexpr float kSafeForS = 2.0F;    ///< ahead: who is touched later is decided on again in time
inline constexpr float kSafeShare = 0.07F;  ///< of the futures: two of 32 may touch

/// What a trajectory proposes. Recorded by number: new ones at the end.
enum class Proposal : std::uint8_t {
  kLast,    ///< the one decided on before, as far as it is not driven yet
  kFollow,  ///< the guide, at some speed
  kWaitThenGo,
  kGoThenStop,
  kArc,
  kArcBack,
  kArcThenFollow,
  kBackThenFollow,
  kStick,       ///< what a stick asks for, or nearly
  kGoStraight,  ///< turns to one of twelve headings and drives straight on
  kBrake,       ///< as hard as it can, now or soon, for good or for a while
};

/// Timed commands; what comes of them is up to robot_motion.h.
struct Trajectory {
  Proposal proposal = Proposal::kFollow;
  bool perturbed = false;
  std::array<Command, kSteps> commands{};
};

/// What a trajectory costs, in seconds of the passenger's time.
struct Cost {
  float time = 0.0F;       ///< until its end, and from there to the goal
  float conflict = 0.0F;   ///< chance of touching or forcing a mover for the first time, sooner is worse
  float touch = 0.0F;      ///< of walls
  float stop_zone = 0.0F;  ///< what the supervisor would brake: so fast so near a surface, or to where nothing looks
  float clearance = 0.0F;  ///< near surfaces
  float unseen = 0.0F;     ///< parts of the body where nothing was ever seen
  float nearness = 0.0F;   ///< near movers
  float comfort = 0.0F;    ///< changes of speed and of turning, and of the side it turns to
  float hit_share = 0.0F;  ///< of the futures: the robot touches a mover within kSafeForS, itself moving. No price
  [[nodiscard]] float total() const {
    return time + conflict + touch + stop_zone + clearance + unseen + nearness + comfort;
  }
  /// Passive safety (SAFETY 32): it comes to rest before it touches anybody, in nearly all futures.
  [[nodiscard]] bool is_safe() const { return hit_share <= kSafeShare; }
  /// A safe trajectory is better than any other; among equals the price decides.
  [[nodiscard]] bool is_better_than(const Cost& other, float by_s = 0.0F) const {
    return is_safe() != other.is_safe() ? is_safe() : total() < other.total() - by_s;
  }
};

}  // namespace jaywalk::motion
