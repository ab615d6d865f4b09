#pragma once
// Entry to mode paper: its planner and follower, a request in the stages' units, and the paper's rules of thumb.
#include <array>
#include <memory>
#include <span>

#include "planner/cost_to_go/planning_rules.h"
#include "planner/mapping/window.h"
#include "planner/motion/motion.h"
#include "planner/motion/twist_ramp.h"
#include "planner/paper/mark_stages.h"

namespace jaywalk::paper {
/// Which point of the path is nearest to `place`, the first of equals. The path is not empty.
[[nodiscard]] std::size_t nearest_point(const Path& path, Vec2 place) noexcept;

/// The point of the path `ahead_m` of arc length beyond the point nearest to `robot`; the last one where the path ends
/// before. The path is not empty.
[[nodiscard]] Vec2 look_ahead(const Path& path, Vec2 robot, double ahead_m) noexcept;

/// How to steer for the point that a robot at `v_mps` (0 or more) looks at. The path is not empty.
struct Steering {
  double bearing = 0.0;          ///< of that point (rad, left positive)
  double curvature_per_m = 0.0;  ///< of the circle through it that is tangent to the heading
  /// It lies so far aside that the robot turns on the spot before it drives.
  [[nodiscard]] bool turns_first() const noexcept;
  /// Turning on the spot (rad/s), at most `most_radps`.
  [[nodiscard]] double turn_radps(double most_radps) const noexcept;
  /// Turning (rad/s) on the circle at `v_mps`, at most `most_radps`.
  [[nodiscard]] double circle_radps(double v_mps, double most_radps) const noexcept {
    return std::clamp(curvature_per_m * v_mps, -most_radps, most_radps);
  }
};
[[nodiscard]] Steering pursue(const Path& path, const Pose2& map_from_robot, double v_mps) noexcept;

/// Follows the plan's path at constant speed, never stopping: the paper's experiment. Pure pursuit, ramped within the
/// comfort limits; without a path it goes straight on, without a goal it comes to rest.
class PathMotion final : public motion::Motion {
 public:
  explicit PathMotion(const motion::MotionSetup& setup);

  void observe(const motion::World& world, const motion::Intent& intent) noexcept override;
  [[nodiscard]] Twist2 command(const motion::World& world, const motion::Intent& intent) noexcept override;
  void decide(const motion::World&, const motion::Intent&) noexcept override {}
  [[nodiscard]] motion::MotionStatus status() const noexcept override { return status_; }
  [[nodiscard]] PlanRequest request(const motion::World& world) const noexcept override;

 private:
  [[nodiscard]] Twist2 target(const motion::World& world, const motion::Intent& intent) const noexcept;

  MotionLimits limits_;
  double tick_s_;
  TwistRamp ramp_;
  motion::MotionStatus status_;
};

using field::Window;

/// Radius as field::kGoalRadius_m, of a goal beside a marked mover: it will move on, the robot may come closer.
inline constexpr double kGoalRadiusBesideMover_m = 2.0;
/// About a robot in a keep-out zone, beyond the way to the nearest edge: room for its body to leave through.
inline constexpr double kWayOut_m = 1.0;
/// The paper's "very small" process noise: what a mover's velocity wanders in the planner's predictions.
inline constexpr double kProcessNoise_m2ps3 = 1e-3;
/// Widest that uncertainty may make a mark, beyond body and safety distance.
inline constexpr double kMostSpread_m = 0.4;

struct PaperConfig : PlannerConfig {
  double inflation_m = 0.3;     ///< obstacle cells grow by this: the robot's radius and a margin
  double mover_margin_m = 0.3;  ///< the "safety distance" round a mover's predicted body
  double horizon_cap_s = 5.0;   ///< predictions go no further
};

/// Throws StartupError for a configuration that makes no sense.
void check(const PaperConfig& config);

[[nodiscard]] Warping warping_for(const PaperConfig& config, const Window& window, const PlanRequest& request) noexcept;

/// The tracks that are numbers within reason, in the window's units; at most kMaxTracks, the rest is left out. Their
/// ids in the same order. Returns how many.
[[nodiscard]] std::int32_t fetch_movers(const Window& window, std::span<const Track> tracks, Mover* movers,
                                        std::array<std::uint32_t, kMaxTracks>& ids) noexcept;

/// Walls of the map as occupants; everything else empty.
void fetch_walls(const Window& window, const EvidenceMap* still, std::uint8_t* occupants) noexcept;

/// Adds as walls what lies in keep-out zones. Of a robot in one the way to the zone's nearest edge and what is as near
/// stays open.
void fetch_keep_out(const Window& window, const KeepOut& keep_out, Vec2 robot_in_map, std::uint8_t* occupants) noexcept;

/// Marks the cells of standing pedestrians as occupied by movers. Places that are no numbers are left out.
void fetch_standing(const Window& window, std::span<const StandingPedestrian> standing,
                    std::uint8_t* occupants) noexcept;

/// Plans by the potential among marks, on the CPU: status and path are theirs. Throws StartupError for a configuration
/// that makes no sense.
[[nodiscard]] std::unique_ptr<Planner> make_cpu_paper_planner(const PaperConfig& config);

/// Follows the plan's path at constant speed, never stopping.
[[nodiscard]] std::unique_ptr<motion::Motion> make_motion(const motion::MotionSetup& setup);

}  // namespace jaywalk::paper
