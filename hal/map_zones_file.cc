#include "hal/map_zones_file.h"

#include <algorithm>
#include <cmath>

#include "hal/types/errors.h"

namespace jaywalk {
namespace {

constexpr double kLeastArea_m2 = 1e-4;

double area_m2(const std::vector<Vec2>& corners) {
  double twice = 0.0;
  for (std::size_t k = 0; k < corners.size(); ++k)
    twice += cross(corners[k] - corners[0], corners[(k + 1) % corners.size()] - corners[0]);
  return 0.5 * std::fabs(twice);
}

/// Which side of the line from `a` to `b` a point lies on: 1, -1, or 0 on it.
int side_of(Vec2 a, Vec2 b, Vec2 p) {
  const double turn = cross(b - a, p - a);
  return turn > 0.0 ? 1 : turn < 0.0 ? -1 : 0;
}

bool is_between(Vec2 a, Vec2 b, Vec2 p) {
  return p.x >= std::min(a.x, b.x) && p.x <= std::max(a.x, b.x) && p.y >= std::min(a.y, b.y) &&
         p.y <= std::max(a.y, b.y);
}

/// Whether two sides have a point in common.
bool do_meet(Vec2 a, Vec2 b, Vec2 c, Vec2 d) {
  const int ac = side_of(a, b, c), ad = side_of(a, b, d), ca = side_of(c, d, a), cb = side_of(c, d, b);
  if (ac * ad < 0 && ca * cb < 0) return true;
  return (ac == 0 && is_between(a, b, c)) || (ad == 0 && is_between(a, b, d)) || (ca == 0 && is_between(c, d, a)) ||
         (cb == 0 && is_between(c, d, b));
}

/// The first two sides that meet and are no neighbours, counted from 1; {0, 0} where none do.
std::pair<std::size_t, std::size_t> crossing(const std::vector<Vec2>& corners) {
  const std::size_t n = corners.size();
  for (std::size_t k = 0; k < n; ++k) {
    for (std::size_t m = k + 2; m < n; ++m) {
      if (k == 0 && m == n - 1) continue;
      if (do_meet(corners[k], corners[k + 1], corners[m], corners[(m + 1) % n])) return {k + 1, m + 1};
    }
  }
  return {0, 0};
}

MapZone read_zone(TomlTable& table) {
  MapZone zone;
  zone.kind = table.choose_keys("kind") == 0 ? ZoneKind::kKeepOut : ZoneKind::kSpeed;
  zone.corners = table.points_in_map("points", 3, kMostZoneCorners);
  if (zone.kind == ZoneKind::kSpeed) zone.speed_mps = table.number("speed_mps");
  table.finish();
  if (area_m2(zone.corners) < kLeastArea_m2)
    table.refuse("points", "encloses no area", "give the corners in order round the zone");
  if (const auto [one, other] = crossing(zone.corners); one > 0)
    table.refuse("points", "crosses itself: side " + std::to_string(one) + " meets side " + std::to_string(other),
                 "give the corners in order round the zone, or draw two zones");
  return zone;
}

}  // namespace

std::vector<SettingKey> zone_keys() {
  using enum KeyKind;
  return {key_row("zones", kTables, "none", "polygons in the map: where not to drive, or slowly"),
          in_section("zones", choice_row("kind", kNeeded, "keep_out: the body stays outside; speed: slowly inside",
                                         {"keep_out", "speed"})),
          in_section("zones",
                     key_row("points", kPoints, kNeeded, "corners [x, y] in order round the zone: 3 to 64", "m, m")),
          in_section("zones:speed",
                     number_row("speed_mps", {0.05, 10.0}, "m/s", kNeeded, "fastest while the body is in it"))};
}

std::vector<MapZone> read_zones(TomlTable& root) {
  std::vector<MapZone> zones;
  std::vector<TomlTable> tables = root.tables("zones");
  if (tables.size() > kMostZones)
    root.refuse("zones", "has " + std::to_string(tables.size()) + " zones", "draw at most 64");
  for (TomlTable& table : tables) {
    zones.push_back(read_zone(table));
    const Box2 all = box_of_keep_out(zones);
    if (all.high.x - all.low.x > kWidestZones_m || all.high.y - all.low.y > kWidestZones_m)
      table.refuse("points", "lies more than 400 m from another keep-out zone", "leave out the zones of other places");
  }
  return zones;
}

void require_goal_outside(const std::vector<MapZone>& zones, Vec2 goal, double radius_m, const std::string& place) {
  if (is_kept_out(zones, goal, radius_m + kZoneMargin_m))
    throw StartupError(place + "the goal lies in a keep-out zone or too near one",
                       "choose another place, or see to [[zones]]");
}

}  // namespace jaywalk
