#pragma once
// Entry to mode paper: its planner and follower, a request in the stages' units, and the paper's rules of thumb.
#include <array>
#include <memory>
#include <span>

#include "planner/cost_to_go/planner.h"
#include "planner/mapping/window.h"
#include "planner/motion/motion.h"
#include "planner/paper/mark_stages.h"

namespace jaywalk::paper {
/// The point of the path `ahead_m` of arc length beyond the point nearest to `robot`, the first of equals; the last
/// one where the path ends before. The path is not empty.
[[nodiscard]] Vec2 look_ahead(const Path& path, Vec2 robot, double ahead_m) noexcept;

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

/// Tracks that are numbers within reason, kMaxTracks at most, in the window's units, and their ids. Returns how many.
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

/// Plans by the potential among marks, on the CPU. Throws as check() does.
[[nodiscard]] std::unique_ptr<Planner> make_cpu_paper_planner(const PaperConfig& config);

/// Follows the plan's path at constant speed, never stopping: the paper's experiment. Pure pursuit, ramped within the
/// comfort limits; without a path it goes straight on, without a goal it comes to rest.
[[nodiscard]] std::unique_ptr<motion::Motion> make_motion(const motion::MotionSetup& setup);

}  // namespace jaywalk::paper
