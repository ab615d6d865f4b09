#include "planner/mapping/known_map.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace jaywalk {
namespace {
constexpr int kWall = 40, kFree = -40;  ///< below certain, both: a few scans change them
/// From a wall's middle to its side, in cells: a drawn wall's face; one that was mapped lies anywhere in its cell.
constexpr double kHalf = 0.5;

constexpr std::array<CellIndex, 4> kBeside{{{1, 0}, {-1, 0}, {0, 1}, {0, -1}}};

/// Towards the free cells beside it; 0 where they are on both sides, or none is.
Vec2 to_free_side(const KnownMap& known, CellIndex at) {
  Vec2 side;
  for (const CellIndex by : kBeside) {
    if (known.at({at.i + by.i, at.j + by.j}) == KnownCell::kFree) side = side + Vec2{1.0 * by.i, 1.0 * by.j};
  }
  return side;
}

/// A wall's inside, which no laser sees.
bool is_inside(const KnownMap& known, CellIndex at) {
  return std::all_of(kBeside.begin(), kBeside.end(), [&](CellIndex by) {
    const CellIndex cell{at.i + by.i, at.j + by.j};
    return !known.holds(cell) || known.at(cell) == KnownCell::kWall;
  });
}

constexpr double kNode_m = 0.1, kFar_m = static_cast<double>(KeepOut::kFar_m);
constexpr double kRim_m = kFar_m + kZoneMargin_m + 2.0 * kNode_m;  ///< beyond it every zone is far

std::int32_t nodes_in(double metres) { return static_cast<std::int32_t>(std::floor(metres / kNode_m)); }

}  // namespace

void enter(const KnownMap& known, EvidenceMap& map, std::optional<CellIndex> before) noexcept {
  const CellIndex low{std::max(known.low.i, map.low().i), std::max(known.low.j, map.low().j)};
  const CellIndex end{std::min(known.low.i + known.width, map.low().i + map.side()),
                      std::min(known.low.j + known.height, map.low().j + map.side())};
  const auto was_inside = [&](std::int32_t at, std::int32_t first) { return at >= first && at < first + map.side(); };
  for (std::int32_t j = low.j; j < end.j; ++j) {
    for (std::int32_t i = low.i; i < end.i; ++i) {
      if (before && was_inside(i, before->i) && was_inside(j, before->j)) continue;
      const KnownCell cell = known.at({i, j});
      const Vec2 middle = map.centre_of({i, j});
      if (cell == KnownCell::kFree) map.tell({i, j}, kFree, middle);
      if (cell != KnownCell::kWall || is_inside(known, {i, j})) continue;
      const Vec2 free_side = to_free_side(known, {i, j});
      map.tell({i, j}, kWall, middle + free_side * (kHalf * known.cell_m), free_side);
    }
  }
}

KeepOutField::KeepOutField(std::span<const MapZone> zones) {
  const Box2 all = box_of_keep_out(zones);
  if (all.is_empty()) return;
  low_ = {std::floor((all.low.x - kRim_m) / kNode_m) * kNode_m, std::floor((all.low.y - kRim_m) / kNode_m) * kNode_m};
  width_ = nodes_in(all.high.x + kRim_m - low_.x) + 1;
  height_ = nodes_in(all.high.y + kRim_m - low_.y) + 1;
  distance_m_.assign(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_), KeepOut::kFar_m);
  for (const MapZone& zone : zones) {
    if (zone.kind == ZoneKind::kKeepOut) add(zone);
  }
}

void KeepOutField::add(const MapZone& zone) {
  const Box2 box = box_of_keep_out({&zone, 1});
  const std::int32_t i0 = nodes_in(box.low.x - kRim_m - low_.x), j0 = nodes_in(box.low.y - kRim_m - low_.y);
  const std::int32_t i1 = nodes_in(box.high.x + kRim_m - low_.x), j1 = nodes_in(box.high.y + kRim_m - low_.y);
  for (std::int32_t j = std::max(j0, 0); j <= std::min(j1, height_ - 1); ++j) {
    for (std::int32_t i = std::max(i0, 0); i <= std::min(i1, width_ - 1); ++i) {
      const double d = signed_distance(zone, low_ + Vec2{i * kNode_m, j * kNode_m}) - kZoneMargin_m;
      float& least =
          distance_m_[static_cast<std::size_t>(j) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(i)];
      least = std::min(least, static_cast<float>(std::max(d, -kFar_m)));
    }
  }
}

KeepOut KeepOutField::view() const noexcept {
  return {static_cast<float>(low_.x), static_cast<float>(low_.y), static_cast<float>(kNode_m), width_, height_,
          distance_m_.data()};
}

}  // namespace jaywalk
