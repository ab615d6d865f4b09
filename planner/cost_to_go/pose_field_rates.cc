#include <algorithm>
#include <array>
#include <cmath>

#include "planner/cost_to_go/nearest_surfaces.h"
#include "planner/cost_to_go/pose_field.h"
#include "planner/cost_to_go/pose_price.h"

namespace jaywalk::field {
namespace {

using Lattice = PoseLattice;

constexpr std::size_t kRooms = 256;

/// Of a second where the outline has so much room, in kRateOfOpen; 0 where the body cannot be.
constexpr std::array<std::uint8_t, kRooms> kRateOfRoom = [] {
  std::array<std::uint8_t, kRooms> rates{};
  for (std::size_t k = 0; k < kRooms; ++k) {
    const float c = static_cast<float>(k) * PoseRoom::kUnit_m;
    const float near = c < price::kPoseNear_m ? (price::kPoseNear_m - c) / price::kPoseNear_m : 0.0F;
    const float by = c < price::kPoseBy_m ? (price::kPoseBy_m - c) / price::kPoseBy_m : 0.0F;
    const float rate = 1.0F + price::kPoseNear * near * near + price::kPoseBy * by;
    rates[k] = c < price::kPoseLeast_m ? std::uint8_t{0}
                                       : static_cast<std::uint8_t>(rate * static_cast<float>(price::kRateOfOpen));
  }
  return rates;
}();

constexpr std::int32_t kOpenCells = 6, kOpenTurns = 6;  // about a body that has no way else
constexpr std::int32_t kUneven = 1;                     // of room: along a straight wall
constexpr std::uint8_t kDearest =
    static_cast<std::uint8_t>((1.0F + price::kPoseNear) * static_cast<float>(price::kRateOfOpen));

}  // namespace

void PoseField::weigh(const PoseFieldRequest& request, const PoseGuide& guide, Memory& memory) const noexcept {
  for (std::size_t k = 0; k < memory.rate.size(); ++k) memory.rate[k] = kRateOfRoom[memory.room[k]];
  open_about(request.map_from_robot, guide, memory);
  for (const MoverDisc& mover : request.movers) {
    if (mover.lasting) weigh_standing(mover, guide, memory);
  }
}

/// A body that stands nearer to something than there is a way may leave: near it, what has no less room is open.
void PoseField::open_about(const Pose2& robot, const PoseGuide& guide, Memory& memory) const noexcept {
  const std::int32_t here =
      guide.pose_at(static_cast<float>(robot.x), static_cast<float>(robot.y), static_cast<float>(robot.heading));
  const std::int32_t ci = Lattice::i_of(here), cj = Lattice::j_of(here), ch = Lattice::heading_of(here);
  std::int32_t most = 0;
  const auto visit_near = [](std::int32_t middle, std::int32_t reach, const auto& visit) {
    for (std::int32_t k = std::max(middle - reach, 0); k <= std::min(middle + reach, Lattice::kSide - 1); ++k) visit(k);
  };
  const auto visit_poses = [&](std::int32_t cells, std::int32_t turns, const auto& visit) {
    visit_near(cj, cells, [&](std::int32_t j) {
      visit_near(ci, cells, [&](std::int32_t i) {
        for (std::int32_t turn = -turns; turn <= turns; ++turn)
          visit(static_cast<std::size_t>(Lattice::at(i, j, Lattice::wrapped(ch + turn))));
      });
    });
  };
  visit_poses(1, 1, [&](std::size_t pose) { most = std::max<std::int32_t>(most, memory.room[pose]); });
  if (kRateOfRoom[static_cast<std::size_t>(most)] != 0) return;
  visit_poses(kOpenCells, kOpenTurns, [&](std::size_t pose) {
    if (memory.rate[pose] == 0 && memory.room[pose] + kUneven >= most) memory.rate[pose] = kDearest;
  });
}

/// Ways past a pedestrian that stands are dear, not closed: it may leave.
void PoseField::weigh_standing(const MoverDisc& mover, const PoseGuide& guide, Memory& memory) const noexcept {
  const Place at = place_of(mover.centre_in_map);
  const double reach_m = body_.circumscribed_radius_m() + mover.radius_m + static_cast<double>(price::kPoliteCoat_m);
  const auto cells = static_cast<std::int32_t>(reach_m / static_cast<double>(Lattice::kCell_m)) + 1;
  const auto ci = static_cast<std::int32_t>((at.x - guide.low_x) / Lattice::kCell_m),
             cj = static_cast<std::int32_t>((at.y - guide.low_y) / Lattice::kCell_m);
  for (std::int32_t h = 0; h < Lattice::kHeadings; ++h) {
    const cell::Heading a = cell::heading_at(static_cast<float>(h) * Lattice::kStep_rad);
    for (std::int32_t j = std::max(cj - cells, 0); j <= std::min(cj + cells, Lattice::kSide - 1); ++j) {
      for (std::int32_t i = std::max(ci - cells, 0); i <= std::min(ci + cells, Lattice::kSide - 1); ++i) {
        const Place p = guide.middle_of(i, j);
        const float dx = at.x - p.x, dy = at.y - p.y;
        const Vec2 seen{static_cast<double>(dx * a.x + dy * a.y), static_cast<double>(dy * a.x - dx * a.y)};
        std::uint8_t& rate = memory.rate[static_cast<std::size_t>(Lattice::at(i, j, h))];
        const auto gap_m = static_cast<float>(body_.distance_to(seen) - mover.radius_m);
        if (rate == 0 || gap_m >= price::kPoliteCoat_m) continue;
        const float weight = gap_m < price::kPoseCoat_m ? price::kPoseStanding : price::kPolite;
        rate = static_cast<std::uint8_t>(
            std::min(255.0F, static_cast<float>(rate) + weight * static_cast<float>(price::kRateOfOpen)));
      }
    }
  }
}

}  // namespace jaywalk::field
