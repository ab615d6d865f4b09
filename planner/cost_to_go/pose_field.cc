#include "planner/cost_to_go/pose_field.h"

#include <algorithm>
#include <cmath>

#include "planner/cost_to_go/nearest_surfaces.h"
#include "planner/cost_to_go/pose_price.h"

namespace jaywalk::field {
namespace {

using Lattice = PoseLattice;

constexpr std::uint32_t kBucket = price::kLeastCost;  // no move costs less: what a bucket holds is settled in any order
constexpr std::size_t kBuckets = PoseGuide::kNoWay / kBucket + 1;
constexpr std::size_t kEntries = 1U << 20;  // five a pose; three were the most that any map took
constexpr std::uint32_t kBeyond = 4U * static_cast<std::uint32_t>(kPoseCostsPerSecond);
constexpr std::int32_t kSoon = 20;  // poses of the way

/// The square's low corner about the robot, on a corner of the guide's cells.
Place low_corner(const Guide& guide, const Pose2& robot) {
  constexpr float kHalf = 0.5F * static_cast<float>(Lattice::kSide);
  const auto snapped = [](float low, float at) {
    return low + (std::floor((at - low) / Lattice::kCell_m) - kHalf) * Lattice::kCell_m;
  };
  return {snapped(guide.low_x, static_cast<float>(robot.x)), snapped(guide.low_y, static_cast<float>(robot.y))};
}

bool turns_into_unseen(const PoseGuide& guide, const PoseWay& way) {
  for (std::int32_t k = 1; k < std::min(way.count, kSoon); ++k) {
    const WayPose& p = way.poses[static_cast<std::size_t>(k)];
    const std::int32_t pose = guide.pose_at(p.x, p.y, p.heading);
    if (p.gear != Gear::kForward && pose >= 0 && guide.unseen[pose] != 0) return true;
  }
  return false;
}

}  // namespace

PoseField::Memory::Memory()
    : cost(Lattice::kPoses, PoseGuide::kNoWay),
      rate(Lattice::kPoses),
      room(Lattice::kPoses),
      unseen(Lattice::kPoses),
      shift(Lattice::kPoses) {}

PoseField::PoseField(const Footprint& body, CostSettler* settler)
    : body_(body), settler_(settler), room_(body, settler), entries_(kEntries), buckets_(kBuckets, -1) {
  entries_.clear();
}

PoseGuide PoseField::settle(const PoseFieldRequest& request, Memory& memory) noexcept {
  const Pose2& robot = request.map_from_robot;
  const Place low = low_corner(request.guide, robot);
  if (!(memory.speeds == request.asked.speeds)) memory.moves.draw(memory.speeds = request.asked.speeds);
  turn_moves_back(memory.moves);
  PoseGuide guide{.low_x = low.x,
                  .low_y = low.y,
                  .speed_mps = request.asked.speeds.forward,
                  .cost = memory.cost.data(),
                  .rate = memory.rate.data(),
                  .room = memory.room.data(),
                  .shift = memory.shift.data(),
                  .moves = &memory.moves};
  room_.find(request.guide, low, request.asked.unseen_walls, memory.room.data(), memory.shift.data());
  const Place here = place_of(robot.position());
  if (room_.find_unseen(request.guide, low, memory.unseen.data())) guide.unseen = memory.unseen.data();
  weigh(request, guide, memory);
  std::fill(memory.cost.begin(), memory.cost.end(), PoseGuide::kNoWay);
  entries_.clear();
  sow_goal(request, guide, memory);
  if (entries_.empty()) sow_rim(request, guide, memory);
  settle_costs(
      guide.pose_at(static_cast<float>(robot.x), static_cast<float>(robot.y), static_cast<float>(robot.heading)), guide,
      memory);
  const auto heading = static_cast<float>(robot.heading);
  guide.known = guide.time_to_go(request.guide, here.x, here.y, heading) < Guide::kNoWay_s;
  if (guide.known && guide.unseen != nullptr) {
    guide.way_from(here.x, here.y, heading, way_);
    guide.through_unseen = turns_into_unseen(guide, way_);
  }
  return guide;
}

void PoseField::turn_moves_back(const PoseMoves& moves) noexcept {
  back_count_.fill(0);
  for (std::int32_t from = 0; from < Lattice::kHeadings; ++from) {
    for (std::int32_t m = 0; m < moves.count[static_cast<std::size_t>(from)]; ++m) {
      const PoseMove& move = moves.from[static_cast<std::size_t>(from)][static_cast<std::size_t>(m)];
      const auto to = static_cast<std::size_t>(Lattice::wrapped(from + move.turn));
      if (static_cast<std::size_t>(back_count_[to]) == back_[to].size()) continue;
      back_[to][static_cast<std::size_t>(back_count_[to]++)] = {
          (from - static_cast<std::int32_t>(to)) * Lattice::kPlane - move.dj * Lattice::kStride - move.di, move.cost,
          price::unseen_weight(move.gear, move.turn)};
    }
  }
}

void PoseField::offer(std::int32_t pose, std::uint32_t cost, std::uint16_t* costs) noexcept {
  if (cost >= costs[pose] || entries_.size() == kEntries) return;
  costs[pose] = static_cast<std::uint16_t>(cost);
  std::int32_t& first = buckets_[cost / kBucket];
  entries_.push_back({pose, first});
  first = static_cast<std::int32_t>(entries_.size()) - 1;
}

void PoseField::settle_costs(std::int32_t robot, const PoseGuide& guide, Memory& memory) noexcept {
  std::uint16_t* costs = memory.cost.data();
  std::uint32_t last = PoseGuide::kNoWay - 1U;
  if (settler_ != nullptr && settler_->settle({guide.rate, guide.unseen, memory.moves, robot, kBeyond, costs})) {
    std::fill(buckets_.begin(), buckets_.end(), -1);
    if (robot >= 0) last = std::min(last, costs[robot] + kBeyond);
  } else {
    last = spread(robot, guide, costs);
  }
  for (std::uint16_t& cost : memory.cost) cost = cost > last ? PoseGuide::kNoWay : cost;
}

std::uint32_t PoseField::spread(std::int32_t robot, const PoseGuide& guide, std::uint16_t* costs) noexcept {
  std::uint32_t last = PoseGuide::kNoWay - 1U;
  for (std::size_t b = 0; b < kBuckets; ++b) {
    while (buckets_[b] >= 0) {
      const Entry entry = entries_[static_cast<std::size_t>(buckets_[b])];
      buckets_[b] = entry.next;
      const std::uint32_t cost = costs[entry.pose];
      if (cost / kBucket != b || cost > last) continue;  // settled before, or of no concern
      if (entry.pose == robot) last = std::min(last, cost + kBeyond);
      relax(entry.pose, cost, guide, costs);
    }
  }
  return last;
}

void PoseField::relax(std::int32_t pose, std::uint32_t cost, const PoseGuide& guide, std::uint16_t* costs) noexcept {
  const auto to = static_cast<std::size_t>(Lattice::heading_of(pose));
  const std::uint32_t rate = guide.rate[pose], eighths = guide.unseen == nullptr ? 0U : guide.unseen[pose];
  for (std::int32_t k = 0; k < back_count_[to]; ++k) {
    const BackMove& move = back_[to][static_cast<std::size_t>(k)];
    const std::int32_t from = pose + move.offset;
    if (costs[from] <= cost + move.cost) continue;  // nowhere is less dear than the open
    const std::uint32_t other = guide.rate[from];
    if (other == 0) continue;
    offer(from, cost + price::cost_of(move.cost, rate, other, eighths, move.unseen_weight), costs);
  }
}

}  // namespace jaywalk::field
