#include "planner/field/guide_field.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "planner/cell/clearance.h"
#include "planner/field/planning_rules.h"

namespace jaywalk::field {
namespace {

constexpr std::int16_t kNoRow = 0x7fff;
constexpr std::int32_t kReach = 20;  ///< cells that a surface is known to: Guide::kFar_m
constexpr Place kNowhere{1e9F, 1e9F};

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
constexpr float kLastingWeight = 8.0F;  ///< through somebody who has stood for long: he may go, a wall does not
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

Place place_of(Vec2 p) { return {static_cast<float>(p.x), static_cast<float>(p.y)}; }

/// Calls visit(c, i, j) for the cells inside `box` whose middle lies within a disc.
template <class Box, class Visit>
void for_each_in_disc(const Window& window, const Box& box, Vec2 centre, double radius_m, const Visit& visit) {
  const Vec2 half{radius_m, radius_m};
  const CellIndex low = window.cell_at(centre - half), high = window.cell_at(centre + half);
  for (std::int32_t j = std::max(low.j, box.j0); j <= std::min(high.j, box.j1); ++j) {
    for (std::int32_t i = std::max(low.i, box.i0); i <= std::min(high.i, box.i1); ++i) {
      if (distance(window.in_map({i + 0.5, j + 0.5}), centre) <= radius_m) visit(window.grid().at(i, j));
    }
  }
}

}  // namespace

GuideField::Memory::Memory(std::int32_t max_side)
    : surface(static_cast<std::size_t>(Grid{max_side}.cells()), kNowhere),
      unseen(static_cast<std::size_t>(Grid{max_side}.cells())),
      to_go_s(static_cast<std::size_t>(Grid{max_side}.cells()), Guide::kNoWay_s) {}

GuideField::GuideField(double inscribed_m, double circumscribed_m, std::int32_t max_side)
    : blocked_m_(static_cast<float>(inscribed_m) + kBlocked_m),
      tight_m_(static_cast<float>(circumscribed_m) + kTight_m),
      own_(static_cast<std::size_t>(Grid{max_side}.cells())),
      rows_(own_.size()),
      rate_(own_.size()),
      cost_(own_.size()),
      entries_(2 * own_.size()),
      heads_(kBuckets, -1) {}

Guide GuideField::settle(const GuideRequest& request, Memory& memory) noexcept {
  const Window& window = request.window;
  const auto cells = static_cast<std::size_t>(window.grid().cells());
  const Box box = box_of(request);
  std::fill_n(memory.surface.begin(), cells, kNowhere);
  std::fill_n(memory.to_go_s.begin(), cells, Guide::kNoWay_s);
  std::fill_n(memory.unseen.begin(), cells, std::uint8_t{0});
  fetch_cells(request, box, memory.unseen.data());
  spread_surfaces(window, box, memory.surface.data());
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
GuideField::Box GuideField::box_of(const GuideRequest& request) const noexcept {
  const Window& window = request.window;
  const std::int32_t last = window.side - 1, margin = static_cast<std::int32_t>(3.0 / window.cell_m);
  const CellIndex robot = window.cell_at(request.robot_in_map);
  const CellIndex goal = projected_goal(window, request.robot_in_map, request.goal_in_map);
  Box box{std::min(robot.i, goal.i), std::min(robot.j, goal.j), std::max(robot.i, goal.i), std::max(robot.j, goal.j)};
  for (std::int32_t j = 0; request.still != nullptr && j <= last; ++j) {
    for (std::int32_t i = 0; i <= last; ++i) {
      if (!request.still->occupied({window.low.i + i, window.low.j + j})) continue;
      box = {std::min(box.i0, i), std::min(box.j0, j), std::max(box.i1, i), std::max(box.j1, j)};
    }
  }
  return {std::clamp(box.i0 - margin, 0, last), std::clamp(box.j0 - margin, 0, last),
          std::clamp(box.i1 + margin, 0, last), std::clamp(box.j1 + margin, 0, last)};
}

void GuideField::fetch_cells(const GuideRequest& request, const Box& box, std::uint8_t* unseen) noexcept {
  const Window& window = request.window;
  for (std::int32_t j = box.j0; j <= box.j1; ++j) {
    for (std::int32_t i = box.i0; i <= box.i1; ++i) {
      const auto c = static_cast<std::size_t>(window.grid().at(i, j));
      const CellIndex cell{window.low.i + i, window.low.j + j};
      const bool wall = request.still != nullptr && request.still->occupied(cell);
      rows_[c] = wall ? std::int16_t{0} : kNoRow;
      unseen[c] = request.still != nullptr && request.still->evidence(cell) == 0 ? std::uint8_t{1} : std::uint8_t{0};
      if (wall) own_[c] = place_of(request.still->surface(cell));
    }
  }
  // A mover that stood was mapped: what lies within his body is no wall.
  for (const MoverDisc& mover : request.movers) {
    for_each_in_disc(window, box, mover.centre_in_map, mover.radius_m + kOwnBody_m,
                     [this](std::int32_t c) { rows_[static_cast<std::size_t>(c)] = kNoRow; });
  }
}

/// The nearest occupied cell up and down each column, then along each row by the lower envelope of its columns'
/// parabolas (planner/cell/clearance.h): what a cell keeps is that cell's own surface.
void GuideField::spread_surfaces(const Window& window, const Box& box, Place* surface) noexcept {
  const Grid grid = window.grid();
  const auto at = [&grid](std::int32_t i, std::int32_t j) { return static_cast<std::size_t>(grid.at(i, j)); };
  const auto size = [](std::int16_t row) { return std::abs(static_cast<std::int32_t>(row)); };
  for (std::int32_t j = box.j0 + 1; j <= box.j1; ++j) {
    for (std::int32_t i = box.i0; i <= box.i1; ++i) {
      const std::int16_t below = rows_[at(i, j - 1)];
      if (rows_[at(i, j)] == 0 || below == kNoRow || below <= -kReach) continue;
      rows_[at(i, j)] = static_cast<std::int16_t>(below - 1);
    }
  }
  for (std::int32_t j = box.j1 - 1; j >= box.j0; --j) {
    for (std::int32_t i = box.i0; i <= box.i1; ++i) {
      const std::int16_t above = rows_[at(i, j + 1)], here = rows_[at(i, j)];
      if (above == kNoRow || above < 0 || above >= kReach || size(here) <= above + 1) continue;
      rows_[at(i, j)] = static_cast<std::int16_t>(above + 1);
    }
  }
  std::array<std::int32_t, 4096> column, begin;  // of the widest window there is
  for (std::int32_t j = box.j0; j <= box.j1; ++j) {
    std::int32_t top = -1;
    for (std::int32_t u = box.i0; u <= box.i1; ++u) {
      const std::int16_t row = rows_[at(u, j)];
      if (row == kNoRow) continue;
      const auto height = [&](std::int32_t i) { return size(rows_[at(i, j)]); };
      const auto k = [](std::int32_t n) { return static_cast<std::size_t>(n); };
      while (top >= 0 && cell::squared_distance(begin[k(top)], column[k(top)], height(column[k(top)])) >
                             cell::squared_distance(begin[k(top)], u, height(u))) {
        --top;
      }
      const std::int32_t from =
          top < 0 ? box.i0 : 1 + cell::last_nearer(column[k(top)], height(column[k(top)]), u, height(u));
      if (from > box.i1) continue;
      ++top;
      column[k(top)] = u;
      begin[k(top)] = std::max(from, box.i0);
    }
    for (std::int32_t i = box.i1; i >= box.i0 && top >= 0; --i) {
      const std::int32_t u = column[static_cast<std::size_t>(top)];
      if (std::abs(u - i) <= kReach) surface[at(i, j)] = own_[at(u, j + rows_[at(u, j)])];
      if (i == begin[static_cast<std::size_t>(top)]) --top;
    }
  }
}

std::uint16_t GuideField::rate_at(float d) const noexcept {
  if (d < blocked_m_) return 0;
  const float near = d < kRoom_m ? kRoom_m - d : 0.0F;
  const float tight = d < tight_m_ ? (tight_m_ - d) / (tight_m_ - blocked_m_) : 0.0F;
  return static_cast<std::uint16_t>(kRates * (1.0F + kRoomWeight * near * near + kTightWeight * tight * tight));
}

/// Whether the shortest way from the robot, or from the nearest cell that has one, soon passes what was never seen.
bool GuideField::leads_through_unseen(const GuideRequest& request, const Box& box,
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

void GuideField::weigh(const GuideRequest& request, const Box& box, const Memory& memory) noexcept {
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
void GuideField::seed(const GuideRequest& request, const Box& box) noexcept {
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

void GuideField::relax_from(std::int32_t c, const Box& box, std::int32_t side) noexcept {
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
void GuideField::settle_costs(const GuideRequest& request, const Box& box) noexcept {
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
