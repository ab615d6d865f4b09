#include "planner/cost_to_go/pose_field.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "planner/cost_to_go/nearest_surfaces.h"

namespace jaywalk::field {
namespace {

using Lattice = PoseLattice;

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

constexpr std::size_t slot_of(std::int32_t pose) { return static_cast<std::size_t>(pose); }

constexpr std::size_t kRooms = 256;

/// Price of a second by the outline's room, in 1/kRateOfOpen; 0: the body cannot be there.
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

constexpr std::uint8_t kDearestPose =
    static_cast<std::uint8_t>((1.0F + price::kPoseNear) * static_cast<float>(price::kRateOfOpen));

/// Graph of poses, for Shortest: as the device has them.
struct PoseGraph {
  using Cost = std::uint16_t;
  static constexpr std::uint32_t kSpan = PoseSteps::kSpan;
  PoseCosts poses;

  [[nodiscard]] Cost& cost(std::int32_t pose) const noexcept { return poses.cost[pose]; }
  [[nodiscard]] std::uint32_t limit() const noexcept {
    return PoseSteps::end(poses.robot < 0 ? PoseSteps::kNone : cost(poses.robot), poses.beyond);
  }
  template <class May, class Visit>
  void for_each_step(std::int32_t pose, const May& may, const Visit& visit) const noexcept {
    const std::int32_t count = poses.steps.count(pose);
    const auto asked = [&](std::int32_t from, std::uint32_t least) { return may(cost(from), least); };
    for (std::int32_t k = 0; k < count; ++k) poses.steps.step(pose, k, asked, visit);
  }
};

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

PoseField::PoseField(const Footprint& body, CostSettler* settler, std::size_t entries)
    : body_(body),
      settler_(settler),
      room_(body),
      dearer_(Lattice::kPoses),
      seeds_(Lattice::kPoses),
      queue_(0, entries) {}

PoseGuide PoseField::settle(const PlanRequest& request, const Guide& places, Memory& memory) noexcept {
  const Pose2& robot = request.map_from_robot;
  const Place low = low_corner(places, robot);
  if (!(memory.speeds == request.poses.speeds)) memory.moves.draw(memory.speeds = request.poses.speeds);
  PoseGuide guide{.low_x = low.x,
                  .low_y = low.y,
                  .speed_mps = request.poses.speeds.forward,
                  .cost = memory.cost.data(),
                  .rate = memory.rate.data(),
                  .room = memory.room.data(),
                  .shift = memory.shift.data(),
                  .moves = &memory.moves};
  room_.take_surfaces(places, low, request.poses.unseen_walls);
  const Place here = place_of(robot.position());
  const auto heading = static_cast<float>(robot.heading);
  if (room_.find_unseen(places, low, memory.unseen.data())) guide.unseen = memory.unseen.data();
  moves_.turn_back(memory.moves);
  const std::int32_t robot_pose = guide.pose_at(here.x, here.y, heading);
  const bool anybody_stands = !request.standing.empty(), is_inside = sow_goal(request, guide, memory);
  const PoseCosts costs{room_.look(memory.room.data(), memory.shift.data()),
                        {kRateOfRoom.data(), kDearestPose, memory.room.data(),
                         anybody_stands ? dearer_.data() : nullptr, robot_pose, memory.rate.data()},
                        {&moves_, memory.rate.data(), guide.unseen},
                        robot_pose,
                        kBeyond,
                        memory.cost.data()};
  if (anybody_stands) std::fill(dearer_.begin(), dearer_.end(), std::uint8_t{0});
  for (const StandingPedestrian& pedestrian : request.standing) weigh_standing(pedestrian, guide);
  if (!is_inside) sow_rim(places, guide, memory);
  settle_costs(costs);
  const auto any_seed = [&](const auto& is_open) { return std::any_of(seeds_.begin(), seeds_.end(), is_open); };
  if (is_inside && !any_seed([&](std::int32_t pose) { return kRateOfRoom[memory.room[slot_of(pose)]] != 0; })) {
    guide.goal_closed = request.poses.wants_heading;
    if (!guide.goal_closed && !any_seed([&](std::int32_t pose) { return memory.rate[slot_of(pose)] != 0; })) {
      sow_rim(places, guide, memory);
      settle_costs(costs);
    }
  }
  guide.known = guide.time_to_go(places, here.x, here.y, heading) < Guide::kNoWay_s;
  if (guide.known && guide.unseen != nullptr) {
    guide.way_from(here.x, here.y, heading, way_);
    guide.through_unseen = turns_into_unseen(guide, way_);
  }
  return guide;
}

void PoseField::forget_seeds(Memory& memory) noexcept {
  std::fill(memory.cost.begin(), memory.cost.end(), PoseGuide::kNoWay);
  seeds_.clear();
}

void PoseField::sow(std::int32_t pose, float seconds, Memory& memory) noexcept {
  std::uint16_t& cost = memory.cost[slot_of(pose)];
  if (cost == PoseGuide::kNoWay) seeds_.push_back(pose);
  const auto given = static_cast<std::uint32_t>(seconds * kPoseCostsPerSecond);
  cost = static_cast<std::uint16_t>(std::min<std::uint32_t>(cost, given));
}

void PoseField::settle_costs(const PoseCosts& poses) noexcept {
  const bool is_settled = (settler_ != nullptr && settler_->settle(poses)) || settle_here(poses);
  const std::uint32_t end = is_settled ? PoseGraph{poses}.limit() : 0;
  for (std::uint16_t& cost : std::span(poses.cost, std::size_t{Lattice::kPoses}))
    cost = cost >= end ? PoseGuide::kNoWay : cost;
}

bool PoseField::settle_here(const PoseCosts& poses) noexcept {
  room_.find(poses.look);
  const PoseRates rates = poses.rates;  // a copy, which what is written cannot change
  for (std::int32_t pose = 0; pose < Lattice::kPoses; ++pose) rates(pose);
  PoseGraph graph{poses};
  queue_.clear();
  for (const std::int32_t pose : seeds_) {
    const std::uint32_t given = std::exchange(poses.cost[pose], PoseGuide::kNoWay);
    if (rates.rate[pose] != 0) queue_.offer(graph, pose, given);
  }
  return queue_.settle(graph);
}

/// Ways past a pedestrian that stands are dear, not closed: it may leave.
void PoseField::weigh_standing(const StandingPedestrian& pedestrian, const PoseGuide& guide) noexcept {
  const Place at = place_of(pedestrian.position_in_map);
  const double reach_m = body_.circumscribed_radius_m() + pedestrian.radius_m + static_cast<double>(price::kPolite_m);
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
        const auto gap_m = static_cast<float>(body_.distance_to(seen) - pedestrian.radius_m);
        if (gap_m >= price::kPolite_m) continue;
        const auto more = static_cast<std::uint32_t>(gap_m < price::kBeside_m ? price::kBeside : price::kPolite);
        std::uint8_t& dearer = dearer_[slot_of(Lattice::at(i, j, h))];
        dearer = static_cast<std::uint8_t>(std::min(255U, dearer + more * price::kRateOfOpen));
      }
    }
  }
}

bool PoseField::sow_goal(const PlanRequest& request, const PoseGuide& guide, Memory& memory) noexcept {
  const Place goal = place_of(request.goal_in_map);
  constexpr float kMost = Lattice::kCell_m * static_cast<float>(Lattice::kSide) - kInside_m;
  forget_seeds(memory);
  const float gx = goal.x - guide.low_x, gy = goal.y - guide.low_y;
  if (!(gx > kInside_m && gy > kInside_m && gx < kMost && gy < kMost)) return false;
  const PoseRequest& asked = request.poses;
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
        if (asked.wants_heading && off >= Lattice::kStep_rad) continue;
        sow(pose, kOffGoal * away + (asked.wants_heading ? off / asked.speeds.spot : 0.0F), memory);
      }
    }
  }
  return true;
}

void PoseField::sow_rim(const Guide& places, PoseGuide& guide, Memory& memory) noexcept {
  forget_seeds(memory);
  float least = Guide::kNoWay_s;
  for_each_of_rim([&](std::int32_t i, std::int32_t j, std::int32_t out_x, std::int32_t out_y) {
    least = std::min(least, time_outward(places, guide.middle_of(i, j), out_x, out_y));
  });
  if (least >= Guide::kNoWay_s) return;
  guide.least_s = least;
  for_each_of_rim([&](std::int32_t i, std::int32_t j, std::int32_t out_x, std::int32_t out_y) {
    const Place p = guide.middle_of(i, j);
    if (time_outward(places, p, out_x, out_y) >= Guide::kNoWay_s) return;
    for (std::int32_t h = 0; h < Lattice::kHeadings; ++h) {
      const std::int32_t pose = Lattice::at(i, j, h);
      const cell::Heading along = cell::heading_at(static_cast<float>(h) * Lattice::kStep_rad);
      const float seconds = std::max(guide.time_beyond(places, p.x, p.y, along) - least, 0.0F);
      if (seconds < kMostRim_s) sow(pose, seconds, memory);
    }
  });
}

}  // namespace jaywalk::field
