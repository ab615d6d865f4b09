#include "planner/cost_to_go/pose_moves.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace jaywalk {
namespace {

constexpr float kMostSlip_rad = 0.135F;     // between a move and its cells: a step of heading and rounding
constexpr float kExact_rad = 0.02F;         // a move that goes so straight needs no second one beside it
constexpr float kSlipPerMetre_rad = 0.14F;  // a metre shorter is worth so much slip
constexpr float kTurnShare = 0.8F;          // of the fastest turn, in an arc
constexpr float kBend_s = 0.02F;            // a step of heading, in an arc
constexpr float kStop_s = 0.03F;            // the same, on the spot
constexpr float kBackward = 1.2F;           // a second backward: the passenger looks ahead
constexpr float kSlip = 0.2F;               // of the time, at the most slip

constexpr std::array<float, 4> kShortest_m{0.09F, 0.09F, 0.13F, 0.19F};  // by steps of heading: arcs of 0.7 m and more

/// A move's cells as a vector, and how far its direction is off what the heading has, left positive; in radians nearly.
struct Way {
  float length_m, slip_rad;
};

Way way_of(std::int32_t di, std::int32_t dj, const cell::Heading& wanted) {
  const auto x = static_cast<float>(di), y = static_cast<float>(dj);
  const float cells = std::sqrt(x * x + y * y);
  const float ahead = (x * wanted.x + y * wanted.y) / cells, left = (y * wanted.x - x * wanted.y) / cells;
  return {cells * PoseLattice::kCell_m, ahead > 0.0F ? left : 1.0F};
}

std::uint16_t cost_of(const Way& way, std::int32_t turn, Gear gear, const PoseSpeeds& speeds) {
  const auto steps = static_cast<float>(std::abs(turn));
  float v = gear == Gear::kForward ? speeds.forward : speeds.back;
  if (turn != 0) v = std::min(v, kTurnShare * speeds.turn * way.length_m / (steps * PoseLattice::kStep_rad));
  const float slip = way.slip_rad / kMostSlip_rad;
  const float seconds = way.length_m / v * (1.0F + kSlip * slip * slip) * (gear == Gear::kBackward ? kBackward : 1.0F);
  return static_cast<std::uint16_t>((seconds + kBend_s * steps) * kPoseCostsPerSecond + 0.5F);
}

/// Unless it is there already.
void add(PoseMoves& moves, std::int32_t heading, const PoseMove& move) {
  const auto h = static_cast<std::size_t>(heading);
  auto& from = moves.from[h];
  const auto end = from.begin() + moves.count[h];
  if (std::find(from.begin(), end, move) == end) from[static_cast<std::size_t>(moves.count[h]++)] = move;
}

/// The shortest and straightest of the moves whose slip is to one side: 1 left, -1 right, 0 either.
void add_best(PoseMoves& moves, std::int32_t heading, std::int32_t turn, Gear gear, float side,
              const PoseSpeeds& speeds) {
  constexpr std::int32_t kReach = PoseLattice::kReach;
  const float sign = gear == Gear::kForward ? 1.0F : -1.0F;
  const float middle_rad = (static_cast<float>(heading) + 0.5F * static_cast<float>(turn)) * PoseLattice::kStep_rad;
  const cell::Heading along = cell::heading_at(middle_rad), wanted{sign * along.x, sign * along.y};
  float least = 1e9F;
  PoseMove best;
  for (std::int32_t dj = -kReach; dj <= kReach; ++dj) {
    for (std::int32_t di = -kReach; di <= kReach; ++di) {
      if (di == 0 && dj == 0) continue;
      const Way way = way_of(di, dj, wanted);
      const float slip = std::fabs(way.slip_rad), worth = slip + kSlipPerMetre_rad * way.length_m;
      const bool is_beside = side == 0.0F || side * way.slip_rad > kExact_rad;
      if (slip > kMostSlip_rad || !is_beside || worth >= least) continue;
      if (way.length_m < kShortest_m[static_cast<std::size_t>(std::abs(turn))]) continue;
      least = worth;
      best = {static_cast<std::int8_t>(di), static_cast<std::int8_t>(dj), static_cast<std::int8_t>(turn), gear,
              cost_of(way, turn, gear, speeds)};
    }
  }
  if (least < 1e9F) add(moves, heading, best);
}

}  // namespace

void PoseMoves::draw(const PoseSpeeds& speeds) noexcept {
  count.fill(0);
  const float step_s = PoseLattice::kStep_rad / std::max(speeds.spot, 0.05F) + kStop_s;
  const auto on_spot = static_cast<std::uint16_t>(step_s * kPoseCostsPerSecond + 0.5F);
  for (std::int32_t h = 0; h < PoseLattice::kHeadings; ++h) {
    for (const Gear gear : {Gear::kForward, Gear::kBackward}) {
      const std::int32_t most = gear == Gear::kForward ? 3 : 2;
      for (const float side : {0.0F, 1.0F, -1.0F}) add_best(*this, h, 0, gear, side, speeds);
      for (std::int32_t turn = 1; turn <= most; ++turn) {
        add_best(*this, h, turn, gear, 0.0F, speeds);
        add_best(*this, h, -turn, gear, 0.0F, speeds);
      }
    }
    for (const std::int8_t turn : {std::int8_t{1}, std::int8_t{-1}}) add(*this, h, {0, 0, turn, Gear::kTurn, on_spot});
  }
}

}  // namespace jaywalk
