#pragma once
// Social movers: pedestrians that walk by social forces and react to the robot as HuNavSim's do.
#include <cstdint>
#include <span>
#include <vector>

#include "hal/sim/free_grid.h"
#include "hal/sim/movers.h"
#include "hal/sim/random.h"
#include "hal/sim/walls.h"
#include "hal/types/geometry.h"
#include "hal/types/social_measures.h"

// Social forces on a pedestrian, m/s2: Helbing and Molnar 1995, "Social force model for pedestrian dynamics",
// Physical Review E 51, 4282. Its lengths are between points; here they are between the outlines of bodies.
namespace jaywalk::sim::social {

/// Standard deviation of the speeds that pedestrians wish, m/s, over their mean (section III).
inline constexpr double kSpeedSpread = 0.26 / 1.34;
/// Greatest over wished speed of a pedestrian (section III).
inline constexpr double kMostSpeed = 1.3;
/// Time in which a velocity approaches the wished one, s: tau.
inline constexpr double kRelaxation_s = 0.5;
/// Half the angle of sight, rad: 2 phi is 200 degrees.
inline constexpr double kHalfSight_rad = 100.0 / 180.0 * kPi;

/// Force towards a wished velocity (eq. 2).
[[nodiscard]] inline Vec2 towards(Vec2 wished_mps, Vec2 velocity_mps) noexcept {
  return (wished_mps - velocity_mps) * (1.0 / kRelaxation_s);
}
/// Repulsive force of another pedestrian that moves at `velocity_mps` (eqs. 3 and 4). `apart_m`: from it to this one.
[[nodiscard]] Vec2 away_from_walker(Vec2 apart_m, Vec2 velocity_mps) noexcept;
/// Force away from a wall's nearest point (eq. 5). `apart_m`: from that point to the pedestrian.
[[nodiscard]] Vec2 away_from_wall(Vec2 apart_m) noexcept;
/// Returns whether a pedestrian that looks along the unit vector `ahead` has `to` in its field of view.
[[nodiscard]] inline bool in_sight(Vec2 ahead, Vec2 to) noexcept {
  return dot(ahead, to) >= norm(to) * cos(kHalfSight_rad);
}
/// `force` itself, or half of it when its source lies out of sight (eqs. 8 and 9).
[[nodiscard]] Vec2 as_seen(Vec2 force, Vec2 ahead) noexcept;
/// `apart_m` between centres less both radii, 1 cm at least.
[[nodiscard]] Vec2 between_outlines(Vec2 apart_m, double radii_m) noexcept;

}  // namespace jaywalk::sim::social

namespace jaywalk::sim {

/// All social movers of a scenario. Each walks straight to a random place in its view, and then to another; forces of
/// walls, movers and the robot (above) turn it aside. Its reaction to the sight of the robot is HuNavSim's
/// (Perez-Higueras and others 2023; defaults of its loader), once in a run. It is forced as recorded ones are.
class SocialWalkers {
 public:
  /// Beside the movers `placed`; ids follow `last_id`. Throws StartupError without room. The ground outlives this.
  SocialWalkers(const Ground& ground, std::uint64_t seed, std::uint32_t last_id, std::span<const MoverTruth> placed);

  /// Moves all on by `step_s`. `others` are movers of other kinds.
  void step(double step_s, const RobotBody& robot, Vec2 robot_velocity_mps,
            std::span<const MoverTruth> others) noexcept;

  [[nodiscard]] std::span<const MoverTruth> movers() const noexcept { return movers_; }
  [[nodiscard]] std::uint32_t forced() const noexcept { return forced_; }
  /// True when in the last step a mover ran into the robot.
  [[nodiscard]] bool bumped_robot() const noexcept { return bumped_robot_; }
  /// Way lost and turning that the robot caused so far; its times stay 0.
  [[nodiscard]] const SocialMeasures& caused() const noexcept { return caused_; }

 private:
  struct Mind {
    double wished_mps = 0.0;
    Reaction reaction = Reaction::kRegular;
    std::size_t leader = 0;     ///< index of the first of its group
    std::size_t followers = 0;  ///< of a leader: the others of its group
    Vec2 goal{};
    double give_up_s = 0.0;  ///< time when another goal is chosen, s
    double reacted_s = 0.0;  ///< time spent on its reaction, s
    Vec2 force{};            ///< of this step, m/s2
    Random random;
  };
  /// The robot as a pedestrian sees it.
  struct Robot {
    const RobotBody& body;
    Vec2 middle, velocity_mps;
  };

  void place(const SocialSpec& spec, const Ground& ground, std::size_t leader, std::span<const MoverTruth> placed,
             Random random);
  void choose_goal(std::size_t self) noexcept;
  [[nodiscard]] bool reacts(std::size_t self, const Robot& robot, double step_s) noexcept;
  /// Sum of the wish to walk and the robot's force, m/s2; counts what the robot caused.
  [[nodiscard]] Vec2 wish_beside(std::size_t self, const Robot& robot, double step_s) noexcept;
  [[nodiscard]] Vec2 force_of_others(std::size_t self, std::span<const MoverTruth> others) const noexcept;
  [[nodiscard]] Vec2 force_of_walls(const MoverTruth& mover) const noexcept;
  [[nodiscard]] Vec2 force_of_group(std::size_t self) const noexcept;
  void walk(std::size_t self, double step_s, const RobotBody& robot) noexcept;

  const Walls& walls_;
  const FreeGrid& grid_;
  std::vector<MoverTruth> movers_;
  std::vector<Mind> minds_;
  double now_s_ = 0.0;
  SocialMeasures caused_;
  std::uint32_t forced_ = 0;
  bool bumped_robot_ = false;
};

}  // namespace jaywalk::sim
