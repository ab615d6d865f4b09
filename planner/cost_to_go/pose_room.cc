#include <algorithm>
#include <cmath>

#include "planner/cost_to_go/nearest_surfaces.h"
#include "planner/cost_to_go/pose_field.h"

namespace jaywalk::field {
namespace {

constexpr double kSpacing_m = 0.08;  // of points along the outline
constexpr float kNode_m = 0.025F;
constexpr std::int32_t kSide = PoseLattice::kSide;

constexpr std::int32_t kWallNodes = 24;  // about a wall's point: a body's half width and where it is dear
constexpr std::int32_t kWallColumns = 2 * kWallNodes / PoseLook::kPerCell + 1;
/// Table of distances from a wall's point, in units of room, by row and node off it. Every fourth node of a row lies
/// side by side, as in PoseLook.
struct AwayFromWall {
  AwayFromWall() {
    for (std::int32_t dj = 0; dj <= kWallNodes; ++dj) {
      for (std::int32_t k = 0; k < PoseLook::kPerCell * kWallColumns; ++k) {
        const auto dx = static_cast<float>(k - kWallNodes), dy = static_cast<float>(dj);
        const float units = std::min(std::sqrt(dx * dx + dy * dy) * (kNode_m / PoseRoom::kUnit_m), 250.0F);
        rows[dj][k % PoseLook::kPerCell][k / PoseLook::kPerCell] =
            k > 2 * kWallNodes ? std::uint8_t{255} : static_cast<std::uint8_t>(units);
      }
    }
  }
  std::uint8_t rows[kWallNodes + 1][PoseLook::kPerCell][kWallColumns];
};
const AwayFromWall kAwayFromWall;

/// Node of a place in a body's frame, turned to a heading, about cell 0 in row 0: the first of 64 nodes, a cell apart.
std::int32_t node_of(float x, float y, std::int32_t heading) {
  const cell::Heading a = cell::heading_at(static_cast<float>(heading) * PoseLattice::kStep_rad);
  const auto nodes = [](float m) {
    const auto away = static_cast<std::int32_t>(std::lround(m / kNode_m));
    return std::clamp(away, -PoseLook::kMargin, PoseLook::kMargin) + PoseLook::kPerCell / 2 + PoseLook::kMargin;
  };
  const std::int32_t i = nodes(x * a.x - y * a.y), j = nodes(x * a.y + y * a.x);
  return (i % PoseLook::kPerCell * PoseLook::kNodes + j) * PoseLook::kColumns + i / PoseLook::kPerCell;
}

/// Sets every node, in the order of PoseLook, to value(x, y) of its place in the map; `low`: the lattice's low corner.
template <class Value>
void fill_nodes(Place low, std::vector<std::uint8_t>& nodes, const Value& value) {
  for (std::int32_t phase = 0; phase < PoseLook::kPerCell; ++phase) {
    for (std::int32_t j = 0; j < PoseLook::kNodes; ++j) {
      const float y = low.y + static_cast<float>(j - PoseLook::kMargin) * kNode_m;
      std::uint8_t* out = &nodes[static_cast<std::size_t>((phase * PoseLook::kNodes + j) * PoseLook::kColumns)];
      for (std::int32_t k = 0; k < PoseLook::kColumns; ++k) {
        const float x = low.x + static_cast<float>(k * PoseLook::kPerCell + phase - PoseLook::kMargin) * kNode_m;
        out[k] = value(x, y);
      }
    }
  }
}

}  // namespace

PoseRoom::PoseRoom(const Footprint& body)
    : nodes_(static_cast<std::size_t>(kNodes) * kNodes), unseen_(static_cast<std::size_t>(kNodes) * kNodes) {
  const auto front = static_cast<float>(body.front_m), rear = static_cast<float>(-body.rear_m),
             half = static_cast<float>(body.half_width_m), middle = 0.5F * (front + rear);
  const std::array<Place, 8> rim{{{front, half},
                                  {front, 0.0F},
                                  {front, -half},
                                  {middle, half},
                                  {middle, -half},
                                  {rear, half},
                                  {rear, 0.0F},
                                  {rear, -half}}};
  const std::array<Vec2, 5> corners{{{body.front_m, -body.half_width_m},
                                     {body.front_m, body.half_width_m},
                                     {-body.rear_m, body.half_width_m},
                                     {-body.rear_m, -body.half_width_m},
                                     {body.front_m, -body.half_width_m}}};
  std::vector<Place> points;  // in the body's frame
  for (std::size_t k = 0; k + 1 < corners.size(); ++k) {
    const Vec2 side = corners[k + 1] - corners[k];
    const double pieces = std::max(1.0, std::ceil(norm(side) / kSpacing_m - 1e-9));
    for (double n = 0.0; n < pieces; n += 1.0) {
      points.push_back(place_of(corners[k] + side * (n / pieces)));
    }
  }
  radius_.assign(points.size(), 0);
  const float radius = std::min(half, 0.5F * (front - rear)), between = front - rear - 2.0F * radius;
  const float gaps = std::ceil(between / std::max(radius, 0.05F));
  for (float k = 0.0F; k <= gaps; k += 1.0F) {
    points.push_back({rear + radius + between * k / std::max(gaps, 1.0F), 0.0F});
    radius_.push_back(static_cast<std::uint8_t>(std::min(radius / kUnit_m, 200.0F)));
  }
  for (std::int32_t heading = 0; heading < PoseLattice::kHeadings; ++heading) {
    std::transform(rim.begin(), rim.end(), rim_[static_cast<std::size_t>(heading)].begin(),
                   [heading](Place p) { return node_of(p.x, p.y, heading); });
    for (std::int32_t side = 0; side < PoseLook::kSides; ++side) {
      const float left = static_cast<float>(PoseLook::shift_of(side)) * kShift_m;
      for (const Place& p : points) places_.push_back(node_of(p.x, p.y + left, heading));
    }
  }
}

/// Row j of a heading and side, `places` of their points, with what is least on the stack: compilers take 16 bytes at
/// once.
void PoseRoom::look_along(const std::int32_t* places, std::int32_t j, std::uint8_t* least) const noexcept {
  std::fill(least, least + kSide, std::uint8_t{255});
  for (std::size_t p = 0; p < radius_.size(); ++p) {
    const std::uint8_t* from = &nodes_[static_cast<std::size_t>(places[p] + j * kPerCell * kColumns)];
    const std::uint8_t radius = radius_[p];
    for (std::int32_t i = 0; i < kSide; ++i) least[i] = std::min(least[i], PoseLook::left(from[i], radius));
  }
}

/// `at`: from the square's low corner.
void PoseRoom::add_wall(Place at) noexcept {
  const auto ci = static_cast<std::int32_t>(std::lround(at.x / kNode_m)) + kMargin,
             cj = static_cast<std::int32_t>(std::lround(at.y / kNode_m)) + kMargin;
  for (std::int32_t k = 0; k < kPerCell; ++k) {
    const std::int32_t first = ci - kWallNodes + k, phase = (first % kPerCell + kPerCell) % kPerCell,
                       column = (first - phase) / kPerCell;
    const std::int32_t from = std::max(0, -column), to = std::min(kWallColumns, kColumns - column);
    for (std::int32_t j = std::max(cj - kWallNodes, 0); j <= std::min(cj + kWallNodes, kNodes - 1); ++j) {
      std::uint8_t* const row = nodes_.data() + (phase * kNodes + j) * kColumns + column;
      const std::uint8_t* const away = kAwayFromWall.rows[std::abs(j - cj)][k];
      for (std::int32_t n = from; n < to; ++n) row[n] = std::min(row[n], away[n]);
    }
  }
}

void PoseRoom::take_surfaces(const Guide& guide, Place low, std::span<const Vec2> walls) noexcept {
  fill_nodes(low, nodes_, [&guide](float x, float y) {
    return static_cast<std::uint8_t>(std::max(guide.room(x, y), 0.0F) / kUnit_m);
  });
  for (const Vec2 wall : walls) add_wall({static_cast<float>(wall.x) - low.x, static_cast<float>(wall.y) - low.y});
}

void PoseRoom::find(const PoseLook& look) const noexcept {
  for (std::int32_t j = 0; j < kSide; ++j) {
    for (std::int32_t heading = 0; heading < PoseLattice::kHeadings; ++heading) {
      std::uint8_t least[PoseLook::kSides][kSide];
      for (std::int32_t side = 0; side < PoseLook::kSides; ++side)
        look_along(&places_[static_cast<std::size_t>((heading * PoseLook::kSides + side) * look.points)], j,
                   least[side]);
      for (std::int32_t i = 0; i < kSide; ++i) {
        const std::int32_t pose = PoseLattice::at(i, j, heading);
        const std::int32_t aside = least[2][i] > least[1][i] ? 2 : 1, side = least[aside][i] > least[0][i] ? aside : 0;
        look.room[pose] = least[side][i], look.shift[pose] = PoseLook::shift_of(side);
      }
    }
  }
}

bool PoseRoom::find_unseen(const Guide& guide, Place low, std::uint8_t* unseen) noexcept {
  bool any = false;
  fill_nodes(low, unseen_, [&](float x, float y) {
    const bool is_unseen = guide.is_unseen(x, y);
    any |= is_unseen;
    return static_cast<std::uint8_t>(is_unseen ? 1 : 0);
  });
  if (!any) return false;
  for (std::int32_t j = 0; j < kSide; ++j) {
    for (std::int32_t heading = 0; heading < PoseLattice::kHeadings; ++heading) {
      std::array<std::uint8_t, kSide> eighths{};
      for (const std::int32_t place : rim_[static_cast<std::size_t>(heading)]) {
        const std::uint8_t* from = &unseen_[static_cast<std::size_t>(place + j * kPerCell * kColumns)];
        for (std::size_t i = 0; i < eighths.size(); ++i) eighths[i] = static_cast<std::uint8_t>(eighths[i] + from[i]);
      }
      for (std::int32_t i = 0; i < kSide; ++i)
        unseen[PoseLattice::at(i, j, heading)] = eighths[static_cast<std::size_t>(i)];
    }
  }
  return true;
}

}  // namespace jaywalk::field
