#include "planner/field/guide_field.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "planner/field/planning_rules.h"

namespace jaywalk::field {
namespace {

constexpr std::uint32_t kNoWay = 0xffffffffU;
constexpr float kRates = 16.0F;  ///< rate units of a cell that costs what it is long
/// A step costs half the sum of both cells' rates times its length; 64 units are half a cell.
constexpr std::uint32_t kStraight = 64, kDiagonal = 91, kKnight = 143;
constexpr std::uint32_t kCostsPerCell = 2U * 16U * kStraight;
constexpr std::uint32_t kBucketShift =
    9;                             ///< 512 costs: less than any step, so that a bucket is final when it is taken
constexpr float kDearest = 60.0F;  ///< of a cell, in cells of open ground
/// Eight million costs: more than seeds on the border of the widest window, and a step, differ by.
constexpr std::size_t kBuckets = 16384;
static_assert(2.0F * kRates * kDearest * static_cast<float>(kKnight) < static_cast<float>(kBuckets << kBucketShift));

/// Ways are sought until they are this much longer than the robot's own, cells of open ground: it will not drive
/// farther off than that before it is asked again.
constexpr std::uint32_t kBeyondRobot = 120U * kCostsPerCell;

constexpr float kRoom_m = 1.0F;         ///< more than that between body's middle and surfaces is worth no detour
constexpr float kRoomWeight = 2.5F;     ///< by trial: a prototype's, on two maps
constexpr float kTightWeight = 30.0F;   ///< where a body's corners would touch if it turned
constexpr float kTight_m = 0.03F;       ///< beyond the corners' circle
constexpr float kBlocked_m = 0.01F;     ///< beyond the inscribed circle
constexpr float kLastingWeight = 8.0F;  ///< where a body has stood for long: it may leave, a wall does not
constexpr float kUnseenWeight = 8.0F;   ///< near the robot, what it has not seen yet
constexpr double kBesideLasting_m = 0.4;

struct Neighbour {
  std::int32_t di, dj;
  std::uint32_t length;
};
constexpr std::array<Neighbour, 16> kNeighbours{{{1, 0, kStraight},
                                                 {-1, 0, kStraight},
                                                 {0, 1, kStraight},
                                                 {0, -1, kStraight},
                                                 {1, 1, kDiagonal},
                                                 {1, -1, kDiagonal},
                                                 {-1, 1, kDiagonal},
                                                 {-1, -1, kDiagonal},
                                                 {2, 1, kKnight},
                                                 {2, -1, kKnight},
                                                 {-2, 1, kKnight},
                                                 {-2, -1, kKnight},
                                                 {1, 2, kKnight},
                                                 {1, -2, kKnight},
                                                 {-1, 2, kKnight},
                                                 {-1, -2, kKnight}}};

}  // namespace

GuideField::Memory::Memory(std::int32_t max_side)
    : surface(static_cast<std::size_t>(Grid{max_side}.cells()), kNowhere),
      unseen(static_cast<std::size_t>(Grid{max_side}.cells())),
      to_go_s(static_cast<std::size_t>(Grid{max_side}.cells()), Guide::kNoWay_s) {}

GuideField::GuideField(double inscribed_m, double circumscribed_m, std::int32_t max_side)
    : blocked_m_(static_cast<float>(inscribed_m) + kBlocked_m),
      tight_m_(static_cast<float>(circumscribed_m) + kTight_m),
      surfaces_(max_side),
      rate_(static_cast<std::size_t>(Grid{max_side}.cells())),
      cost_(rate_.size()),
      entries_(2 * rate_.size()),
      heads_(kBuckets, -1) {}

Guide GuideField::settle(const GuideRequest& request, Memory& memory) noexcept {
  const Window& window = request.window;
  const auto cells = static_cast<std::size_t>(window.grid().cells());
  const CellBox box = box_of(request);
  std::fill_n(memory.surface.begin(), cells, kNowhere);
  std::fill_n(memory.to_go_s.begin(), cells, Guide::kNoWay_s);
  std::fill_n(memory.unseen.begin(), cells, std::uint8_t{0});
  surfaces_.find(window, box, request.still, request.movers, memory.unseen.data(), memory.surface.data());
  weigh(request, box, memory);
  settle_costs(request, box);
  const double seconds = window.cell_m / (std::max(request.speed_mps, 0.05) * kCostsPerCell);
  for (std::int32_t j = box.j0; j <= box.j1; ++j) {
    for (std::int32_t c = window.grid().at(box.i0, j); c <= window.grid().at(box.i1, j); ++c) {
      const auto k = static_cast<std::size_t>(c);
      if (cost_[k] != kNoWay) memory.to_go_s[k] = static_cast<float>(static_cast<double>(cost_[k]) * seconds);
    }
  }
  const Place low = place_of(window.in_map({0.0, 0.0}));
  return {low.x,
          low.y,
          static_cast<float>(window.cell_m),
          window.side,
          leads_through_unseen(request, box, memory),
          memory.surface.data(),
          memory.unseen.data(),
          memory.to_go_s.data()};
}

/// Everything that is known, robot and goal, and three metres about them: room enough to walk round.
CellBox GuideField::box_of(const GuideRequest& request) const noexcept {
  const Window& window = request.window;
  const std::int32_t last = window.side - 1, margin = static_cast<std::int32_t>(3.0 / window.cell_m);
  const CellIndex robot = window.cell_at(request.robot_in_map);
  const CellIndex goal = projected_goal(window, request.robot_in_map, request.goal_in_map);
  CellBox box{std::min(robot.i, goal.i), std::min(robot.j, goal.j), std::max(robot.i, goal.i),
              std::max(robot.j, goal.j)};
  for (std::int32_t j = 0; request.still != nullptr && j <= last; ++j) {
    for (std::int32_t i = 0; i <= last; ++i) {
      if (!request.still->occupied({window.low.i + i, window.low.j + j})) continue;
      box = {std::min(box.i0, i), std::min(box.j0, j), std::max(box.i1, i), std::max(box.j1, j)};
    }
  }
  return {std::clamp(box.i0 - margin, 0, last), std::clamp(box.j0 - margin, 0, last),
          std::clamp(box.i1 + margin, 0, last), std::clamp(box.j1 + margin, 0, last)};
}

std::uint16_t GuideField::rate_at(float d) const noexcept {
  if (d < blocked_m_) return 0;
  const float near = d < kRoom_m ? kRoom_m - d : 0.0F;
  const float tight = d < tight_m_ ? (tight_m_ - d) / (tight_m_ - blocked_m_) : 0.0F;
  return static_cast<std::uint16_t>(kRates * (1.0F + kRoomWeight * near * near + kTightWeight * tight * tight));
}

/// Whether the shortest way from the robot, or from the nearest cell that has one, soon passes what was never seen.
bool GuideField::leads_through_unseen(const GuideRequest& request, const CellBox& box,
                                      const Memory& memory) const noexcept {
  const CellIndex robot = request.window.cell_at(request.robot_in_map);
  std::int32_t i = robot.i, j = robot.j;
  for (double gone = 0.0; gone < kUnseenRadius_m;) {
    std::uint32_t least = kNoWay;
    Neighbour best{};
    for (const Neighbour& n : kNeighbours) {
      const std::int32_t x = i + n.di, y = j + n.dj;
      if (x < box.i0 || y < box.j0 || x > box.i1 || y > box.j1) continue;
      const std::uint32_t cost = cost_[static_cast<std::size_t>(request.window.grid().at(x, y))];
      if (cost < least) least = cost, best = n;
    }
    if (least == kNoWay) return false;
    i += best.di, j += best.dj;
    if (memory.unseen[static_cast<std::size_t>(request.window.grid().at(i, j))] != 0) return true;
    if (least == 0) return false;
    gone += request.window.cell_m * best.length / kStraight;
  }
  return false;
}

void GuideField::weigh(const GuideRequest& request, const CellBox& box, const Memory& memory) noexcept {
  const Window& window = request.window;
  const Place* surface = memory.surface.data();
  for (std::int32_t j = box.j0; j <= box.j1; ++j) {
    for (std::int32_t i = box.i0; i <= box.i1; ++i) {
      const auto c = static_cast<std::size_t>(window.grid().at(i, j));
      const Place middle = place_of(window.in_map({i + 0.5, j + 0.5}));
      const float dx = surface[c].x - middle.x, dy = surface[c].y - middle.y;
      rate_[c] = rate_at(std::sqrt(dx * dx + dy * dy));
    }
  }
  const auto add = [this](std::int32_t c, float weight) {
    std::uint16_t& rate = rate_[static_cast<std::size_t>(c)];
    if (rate == 0) return;
    rate = static_cast<std::uint16_t>(std::min(static_cast<float>(rate) + kRates * weight, kRates * kDearest));
  };
  for_each_in_disc(window, box, request.robot_in_map, kUnseenRadius_m, [&](std::int32_t c) {
    if (memory.unseen[static_cast<std::size_t>(c)] != 0) add(c, kUnseenWeight);
  });
  for (const MoverDisc& mover : request.movers) {
    if (!mover.lasting) continue;
    for_each_in_disc(window, box, mover.centre_in_map, mover.radius_m + kBesideLasting_m,
                     [&](std::int32_t c) { add(c, kLastingWeight); });
  }
}

void GuideField::push(std::int32_t c, std::uint32_t cost) noexcept {
  std::int32_t entry = spare_;
  if (entry >= 0) {
    spare_ = entries_[static_cast<std::size_t>(entry)].next;
  } else {
    if (used_ == entries_.size()) return;  // never seen: a cell would be queued twice on average, all at a time
    entry = static_cast<std::int32_t>(used_++);
  }
  const std::size_t bucket = (cost >> kBucketShift) % kBuckets;
  entries_[static_cast<std::size_t>(entry)] = {c, heads_[bucket]};
  heads_[bucket] = entry;
  cost_[static_cast<std::size_t>(c)] = cost;
  ++queued_;
}

/// The goal's cell, or the nearest that is a way; every cell of the border for a goal outside, with what is left
/// beyond.
void GuideField::seed(const GuideRequest& request, const CellBox& box) noexcept {
  const Window& window = request.window;
  const Grid grid = window.grid();
  const Vec2 goal = request.goal_in_map;
  if (window.holds(goal, 0)) {
    std::int32_t best = -1;
    double least = kGoalRadius_m;
    for_each_in_disc(window, box, goal, kGoalRadius_m, [&](std::int32_t c) {
      if (rate_[static_cast<std::size_t>(c)] == 0) return;
      const double away = distance(window.in_map({c % grid.side + 0.5, c / grid.side + 0.5}), goal);
      if (away < least) least = away, best = c;
    });
    if (best >= 0) push(best, 0);
    return;
  }
  const Vec2 robot = request.robot_in_map;
  const double through = distance(robot, goal);
  const auto add = [&](std::int32_t i, std::int32_t j) {
    const std::int32_t c = grid.at(i, j);
    if (rate_[static_cast<std::size_t>(c)] == 0 || cost_[static_cast<std::size_t>(c)] != kNoWay) return;
    // Relative to the straight way, so that a goal far off costs no more than numbers hold.
    const double more = distance(window.in_map({i + 0.5, j + 0.5}), goal) - through + window.side * window.cell_m * 1.5;
    push(c, static_cast<std::uint32_t>(std::max(0.0, more) / window.cell_m * kCostsPerCell));
  };
  for (std::int32_t i = box.i0; i <= box.i1; ++i) add(i, box.j0), add(i, box.j1);
  for (std::int32_t j = box.j0; j <= box.j1; ++j) add(box.i0, j), add(box.i1, j);
}

void GuideField::relax_from(std::int32_t c, const CellBox& box, std::int32_t side) noexcept {
  const std::int32_t i = c % side, j = c / side;
  const std::uint32_t here = cost_[static_cast<std::size_t>(c)], own = rate_[static_cast<std::size_t>(c)];
  for (const Neighbour& n : kNeighbours) {
    const std::int32_t x = i + n.di, y = j + n.dj;
    if (x < box.i0 || y < box.j0 || x > box.i1 || y > box.j1) continue;
    const std::int32_t to = y * side + x;
    const std::uint32_t theirs = rate_[static_cast<std::size_t>(to)];
    if (theirs == 0) continue;
    if (n.length == kKnight) {  // passes between two cells
      const std::int32_t a = (j + n.dj / 2) * side + i + n.di / 2, b = (y - n.dj / 2) * side + x - n.di / 2;
      if (rate_[static_cast<std::size_t>(a)] == 0 || rate_[static_cast<std::size_t>(b)] == 0) continue;
    }
    const std::uint32_t through = here + (own + theirs) * n.length;
    if (through < cost_[static_cast<std::size_t>(to)]) push(to, through);
  }
}

/// Dial's buckets in a ring.
void GuideField::settle_costs(const GuideRequest& request, const CellBox& box) noexcept {
  const Grid grid = request.window.grid();
  for (std::int32_t j = box.j0; j <= box.j1; ++j)
    std::fill_n(cost_.begin() + grid.at(box.i0, j), box.i1 - box.i0 + 1, kNoWay);
  std::fill(heads_.begin(), heads_.end(), -1);
  spare_ = -1;
  used_ = queued_ = 0;
  seed(request, box);
  const CellIndex robot = request.window.cell_at(request.robot_in_map);
  const auto here = static_cast<std::size_t>(grid.at(robot.i, robot.j));
  for (std::uint32_t bucket = 0; queued_ > 0; ++bucket) {
    const std::uint32_t cost = bucket << kBucketShift;
    if (cost_[here] != kNoWay && cost > cost_[here] && cost - cost_[here] > kBeyondRobot) break;
    std::int32_t& head = heads_[bucket % kBuckets];
    while (head >= 0) {
      const std::int32_t entry = head, c = entries_[static_cast<std::size_t>(entry)].cell;
      head = entries_[static_cast<std::size_t>(entry)].next;
      entries_[static_cast<std::size_t>(entry)].next = spare_;
      spare_ = entry;
      --queued_;
      if (cost_[static_cast<std::size_t>(c)] >> kBucketShift == bucket) relax_from(c, box, grid.side);
    }
  }
}

}  // namespace jaywalk::field
