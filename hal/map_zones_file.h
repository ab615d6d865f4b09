#pragma once
// [[zones]] of scenario and robot files.
#include <vector>

#include "hal/toml_file.h"
#include "hal/types/map_zones.h"

namespace jaywalk {

inline constexpr std::size_t kMostZones = 64, kMostZoneCorners = 64;
/// Keep-out zones of one file lie in a square of this side: the memory that their distances take.
inline constexpr double kWidestZones_m = 400.0;

/// The rows of [[zones]], and the one that says so at the top.
[[nodiscard]] std::vector<SettingKey> zone_keys();

/// Throws StartupError "FILE:LINE: cause; remedy" for a zone of no area or with sides that cross.
[[nodiscard]] std::vector<MapZone> read_zones(TomlTable& root);

/// Throws StartupError beginning with `place` where a body of `radius_m` at `goal` reaches into a keep-out zone.
void require_goal_outside(const std::vector<MapZone>& zones, Vec2 goal, double radius_m, const std::string& place);

}  // namespace jaywalk
