#pragma once
// From a request in the map to the stages' units, and the planner's rules of thumb, each with its reason.
#include "planner/field/mark_stages.h"
#include "planner/mapping/window.h"
#include "planner/planner.h"

namespace jaywalk::field {

/// A robot that stands in an obstacle or its inflation starts from the nearest free cell this near.
inline constexpr double kStartRadius_m = 1.0;
/// A goal that is not free is replaced by the nearest cell this near that the robot can reach.
inline constexpr double kGoalRadius_m = 0.5;
/// The same for a goal beside which a mover is marked: it will move on, the robot may come closer.
inline constexpr double kGoalRadiusBesideMover_m = 2.0;
/// About a robot in a keep-out zone, beyond the way to the nearest edge: room for its body to leave through.
inline constexpr double kWayOut_m = 1.0;
/// How far unseen places count as walls for a body that must not back into them.
inline constexpr double kUnseenRadius_m = 2.0;
/// Slowest robot that arrival times are computed for; slower ones count as this.
inline constexpr double kLeastSpeed_mps = 0.1;
/// The paper's "very small" process noise: what a mover's velocity wanders in the planner's predictions.
inline constexpr double kProcessNoise_m2ps3 = 1e-3;
/// Widest that uncertainty may make a mark, beyond body and safety distance.
inline constexpr double kMostSpread_m = 0.4;

/// Throws StartupError for a configuration that makes no sense.
void check(const PlannerConfig& config);

/// Whether pose, goal and speed are numbers.
[[nodiscard]] bool is_finite(const PlanRequest& request) noexcept;

[[nodiscard]] Warping warping_for(const PlannerConfig& config, const Window& window,
                                  const PlanRequest& request) noexcept;

/// The tracks that are numbers within reason, in the window's units; at most kMaxTracks, the rest is left out. Their
/// ids in the same order. Returns how many.
[[nodiscard]] std::int32_t fetch_movers(const Window& window, std::span<const Track> tracks, Mover* movers,
                                        std::array<std::uint32_t, kMaxTracks>& ids) noexcept;

/// Walls of the map as occupants; everything else empty.
void fetch_walls(const Window& window, const EvidenceMap* still, std::uint8_t* occupants) noexcept;

/// Adds as walls what lies in keep-out zones. Of a robot in one the way to the zone's nearest edge and what is as near
/// stays open.
void fetch_keep_out(const Window& window, const KeepOut& keep_out, Vec2 robot_in_map, std::uint8_t* occupants) noexcept;

/// Adds as movers all that is of those who stand within `reach` cells of the robot; of numbers within reason.
void fetch_standing(const Window& window, const PlanRequest& request, float reach, std::uint8_t* occupants) noexcept;

}  // namespace jaywalk::field
