#include <algorithm>
#include <cmath>

#include "planner/cost_to_go/nearest_surfaces.h"
#include "planner/cost_to_go/pose_field.h"
#include "planner/cost_to_go/pose_price.h"

namespace jaywalk::field {
namespace {

using Lattice = PoseLattice;

constexpr std::int32_t kRimRings = 3;
constexpr float kOutward_m = 0.4F, kOutward_s = 0.2F;  // so far out of the square the time must have fallen by so much
constexpr float kMostRim_s = 100.0F;                   // later than from elsewhere on the rim: none drives there
constexpr float kInside_m = 0.3F;                      // of the square: the goal is there
constexpr float kOffGoal = 0.2F;                       // seconds a metre beside the goal

/// The 2-D time at a place of the rim if it falls towards outside, kNoWay_s else.
float time_outward(const Guide& guide, Place p, std::int32_t out_x, std::int32_t out_y) {
  const float here = guide.time_to_go(p.x, p.y);
  if (here >= Guide::kNoWay_s) return here;
  const auto ox = static_cast<float>(out_x), oy = static_cast<float>(out_y);
  for (std::int32_t k = -2; k <= 2; ++k) {
    const float aside = 0.5F * kOutward_m * static_cast<float>(k);
    const float there = guide.time_to_go(p.x + kOutward_m * ox + aside * oy, p.y + kOutward_m * oy + aside * ox);
    if (there < here - kOutward_s) return here;
  }
  return Guide::kNoWay_s;
}

/// Visits the cells of the rim, and which way is out.
template <class Visit>
void for_each_of_rim(const Visit& visit) {
  constexpr std::int32_t kLast = Lattice::kSide - 1;
  for (std::int32_t ring = 0; ring < kRimRings; ++ring) {
    for (std::int32_t k = 0; k <= kLast; ++k) {
      visit(k, ring, 0, -1), visit(k, kLast - ring, 0, 1);
      visit(ring, k, -1, 0), visit(kLast - ring, k, 1, 0);
    }
  }
}

}  // namespace

void PoseField::sow_goal(const PoseFieldRequest& request, const PoseGuide& guide, Memory& memory) noexcept {
  const Place goal = place_of(request.goal_in_map);
  constexpr float kMost = Lattice::kCell_m * static_cast<float>(Lattice::kSide) - kInside_m;
  const float gx = goal.x - guide.low_x, gy = goal.y - guide.low_y;
  if (!(gx > kInside_m && gy > kInside_m && gx < kMost && gy < kMost)) return;
  const PoseRequest& asked = request.asked;
  const auto cells = static_cast<std::int32_t>(asked.arrives_m / Lattice::kCell_m) + 1;
  const auto ci = static_cast<std::int32_t>(gx / Lattice::kCell_m),
             cj = static_cast<std::int32_t>(gy / Lattice::kCell_m);
  for (std::int32_t j = std::max(cj - cells, 0); j <= std::min(cj + cells, Lattice::kSide - 1); ++j) {
    for (std::int32_t i = std::max(ci - cells, 0); i <= std::min(ci + cells, Lattice::kSide - 1); ++i) {
      const Place p = guide.middle_of(i, j);
      const float away = std::sqrt((p.x - goal.x) * (p.x - goal.x) + (p.y - goal.y) * (p.y - goal.y));
      if (away > std::max(asked.arrives_m, Lattice::kCell_m)) continue;
      for (std::int32_t h = 0; h < Lattice::kHeadings; ++h) {
        const std::int32_t pose = Lattice::at(i, j, h);
        const float off = std::fabs(cell::wrapped(static_cast<float>(h) * Lattice::kStep_rad - asked.heading));
        if (memory.rate[static_cast<std::size_t>(pose)] == 0 || (asked.wants_heading && off >= Lattice::kStep_rad))
          continue;
        const float seconds = kOffGoal * away + (asked.wants_heading ? off / asked.speeds.spot : 0.0F);
        offer(pose, static_cast<std::uint32_t>(seconds * kPoseCostsPerSecond), memory.cost.data());
      }
    }
  }
}

void PoseField::sow_rim(const PoseFieldRequest& request, PoseGuide& guide, Memory& memory) noexcept {
  float least = Guide::kNoWay_s;
  for_each_of_rim([&](std::int32_t i, std::int32_t j, std::int32_t out_x, std::int32_t out_y) {
    least = std::min(least, time_outward(request.guide, guide.middle_of(i, j), out_x, out_y));
  });
  if (least >= Guide::kNoWay_s) return;
  guide.least_s = least;
  for_each_of_rim([&](std::int32_t i, std::int32_t j, std::int32_t out_x, std::int32_t out_y) {
    const Place p = guide.middle_of(i, j);
    if (time_outward(request.guide, p, out_x, out_y) >= Guide::kNoWay_s) return;
    for (std::int32_t h = 0; h < Lattice::kHeadings; ++h) {
      const std::int32_t pose = Lattice::at(i, j, h);
      if (memory.rate[static_cast<std::size_t>(pose)] == 0) continue;
      const cell::Heading along = cell::heading_at(static_cast<float>(h) * Lattice::kStep_rad);
      const float seconds = std::max(guide.time_beyond(request.guide, p.x, p.y, along) - least, 0.0F);
      if (seconds < kMostRim_s)
        offer(pose, static_cast<std::uint32_t>(seconds * kPoseCostsPerSecond), memory.cost.data());
    }
  });
}

}  // namespace jaywalk::field
