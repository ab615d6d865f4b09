#include "planner/cost_to_go/pose_guide.h"

#include <algorithm>
#include <cmath>

#include "planner/cost_to_go/pose_field.h"

namespace jaywalk {
namespace {

using Lattice = PoseLattice;

constexpr float kLeastWeight = 0.05F;
constexpr std::int32_t kRim = 2;  // cells: beyond them the lattice has no neighbours to ask
constexpr float kAsideS = 8.0F, kAheadS = 2.0F,
                kTurnedS = 3.0F;  // what a pose beside the robot's costs, a metre or radian

}  // namespace

bool PoseGuide::covers(float x, float y) const noexcept {
  const float gx = (x - low_x) / Lattice::kCell_m - 0.5F, gy = (y - low_y) / Lattice::kCell_m - 0.5F;
  constexpr auto kLow = static_cast<float>(kRim), kHigh = static_cast<float>(Lattice::kSide - 1 - kRim);
  return gx > kLow && gy > kLow && gx < kHigh && gy < kHigh;
}

Place PoseGuide::middle_of(std::int32_t i, std::int32_t j) const noexcept {
  return {low_x + (static_cast<float>(i) + 0.5F) * Lattice::kCell_m,
          low_y + (static_cast<float>(j) + 0.5F) * Lattice::kCell_m};
}

std::int32_t PoseGuide::pose_at(float x, float y, float heading) const noexcept {
  const auto i = static_cast<std::int32_t>(std::floor((x - low_x) / Lattice::kCell_m)),
             j = static_cast<std::int32_t>(std::floor((y - low_y) / Lattice::kCell_m)),
             h = static_cast<std::int32_t>(std::lround(heading / Lattice::kStep_rad));
  const bool inside = i >= 0 && j >= 0 && i < Lattice::kSide && j < Lattice::kSide;
  return inside ? Lattice::at(i, j, Lattice::wrapped(h)) : -1;
}

float PoseGuide::time_beyond(const Guide& guide, float x, float y, const cell::Heading& along) const noexcept {
  const float there = guide.time_to_go(x, y);
  if (there >= Guide::kNoWay_s) return there;
  const float ahead = guide.time_to_go(x + price::kFacing_m * along.x, y + price::kFacing_m * along.y);
  const float gained = (there - std::min(ahead, there + 1.0F)) * speed_mps / price::kFacing_m;
  return there + price::kFacing_s * (1.0F - std::clamp(gained, -1.0F, 1.0F));
}

float PoseGuide::time_to_go(const Guide& guide, float x, float y, float heading) const noexcept {
  if (!covers(x, y)) return time_beyond(guide, x, y, cell::heading_at(heading));
  const float gx = (x - low_x) / Lattice::kCell_m - 0.5F, gy = (y - low_y) / Lattice::kCell_m - 0.5F;
  const auto i = static_cast<std::int32_t>(gx), j = static_cast<std::int32_t>(gy);
  const float fx = gx - static_cast<float>(i), fy = gy - static_cast<float>(j);
  const float turns = heading / Lattice::kStep_rad, whole = std::floor(turns), fh = turns - whole;
  const std::int32_t h0 = Lattice::wrapped(static_cast<std::int32_t>(whole)), h1 = Lattice::wrapped(h0 + 1);
  float sum = 0.0F, weights = 0.0F;
  const auto add = [&](std::int32_t pose, float weight) {
    if (cost[pose] == kNoWay) return;
    sum += weight * static_cast<float>(cost[pose]), weights += weight;
  };
  for (std::int32_t k = 0; k < 4; ++k) {
    const std::int32_t di = k & 1, dj = k >> 1;
    const float weight = (di != 0 ? fx : 1.0F - fx) * (dj != 0 ? fy : 1.0F - fy);
    add(Lattice::at(i + di, j + dj, h0), weight * (1.0F - fh));
    add(Lattice::at(i + di, j + dj, h1), weight * fh);
  }
  return weights > kLeastWeight ? least_s + sum / (weights * kPoseCostsPerSecond) : Guide::kNoWay_s;
}

PoseGuide::Step PoseGuide::step(std::int32_t pose, const PoseMove& move) const noexcept {
  const std::int32_t from = Lattice::heading_of(pose), heading = Lattice::wrapped(from + move.turn);
  const std::int32_t to = pose + Lattice::offset(move.di, move.dj, heading - from);
  if (rate[pose] == 0 || rate[to] == 0) return {to};
  const std::uint32_t eighths = unseen == nullptr ? 0U : unseen[to];
  return {to, price::cost_of(move.cost, rate[pose], rate[to], eighths, price::unseen_weight(move.gear, move.turn))};
}

/// The lattice's pose near to one from which the way is shortest, counting what it is off.
std::int32_t PoseGuide::nearest(float x, float y, float heading) const noexcept {
  if (!covers(x, y)) return -1;
  const auto ci = static_cast<std::int32_t>((x - low_x) / Lattice::kCell_m),
             cj = static_cast<std::int32_t>((y - low_y) / Lattice::kCell_m);
  const float turns = heading / Lattice::kStep_rad;
  const auto ch = static_cast<std::int32_t>(std::lround(turns));
  const cell::Heading a = cell::heading_at(heading);
  float least = 1e9F;
  std::int32_t best = -1;
  for (std::int32_t n = 0; n < 27; ++n) {
    const std::int32_t h = ch + n / 9 - 1;
    const std::int32_t pose = Lattice::at(ci + n % 3 - 1, cj + n / 3 % 3 - 1, Lattice::wrapped(h));
    if (cost[pose] == kNoWay) continue;
    const WayPose p = place_of(pose, Gear::kForward);
    const float dx = p.x - x, dy = p.y - y, off_rad = std::fabs(turns - static_cast<float>(h)) * Lattice::kStep_rad;
    const float total = static_cast<float>(cost[pose]) / kPoseCostsPerSecond +
                        kAsideS * std::fabs(dy * a.x - dx * a.y) + kAheadS * std::fabs(dx * a.x + dy * a.y) +
                        kTurnedS * off_rad;
    if (total < least) least = total, best = pose;
  }
  return best;
}

WayPose PoseGuide::place_of(std::int32_t pose, Gear gear) const noexcept {
  const float heading = static_cast<float>(Lattice::heading_of(pose)) * Lattice::kStep_rad;
  const cell::Heading along = cell::heading_at(heading);
  const float left = static_cast<float>(shift[pose]) * field::PoseRoom::kShift_m;
  return {low_x + (static_cast<float>(Lattice::i_of(pose)) + 0.5F) * Lattice::kCell_m - left * along.y,
          low_y + (static_cast<float>(Lattice::j_of(pose)) + 0.5F) * Lattice::kCell_m + left * along.x, heading, gear,
          static_cast<float>(room[pose]) * field::PoseRoom::kUnit_m};
}

void PoseGuide::way_from(float x, float y, float heading, PoseWay& out) const noexcept {
  out.count = 0;
  std::int32_t pose = nearest(x, y, heading);
  Gear gear = Gear::kForward;
  while (pose >= 0 && out.count < PoseWay::kMost) {
    out.poses[static_cast<std::size_t>(out.count++)] = place_of(pose, gear);
    const auto from = static_cast<std::size_t>(Lattice::heading_of(pose));
    std::uint32_t least = cost[pose];
    std::int32_t next = -1;
    for (std::int32_t m = 0; m < moves->count[from]; ++m) {
      const PoseMove& move = moves->from[from][static_cast<std::size_t>(m)];
      const Step step = this->step(pose, move);
      if (step.cost == kNoWay || cost[step.to] == kNoWay || cost[step.to] + step.cost > least) continue;
      if (next >= 0 && cost[step.to] + step.cost == least) continue;
      least = cost[step.to] + step.cost, next = step.to, gear = move.gear;
    }
    if (out.count == 1) out.poses[0].gear = gear;
    pose = next;
  }
}

}  // namespace jaywalk
