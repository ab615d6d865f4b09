#include "planner/cost_to_go/guide_field.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <iterator>
#include <utility>

namespace jaywalk::field {
namespace {

constexpr float kRates = static_cast<float>(kRateOfOpenGround);  ///< of a cell that costs what it is long
constexpr float kDearest = 60.0F;                                ///< of a cell, in cells of open ground

/// Ways are known until they are this much longer than the robot's own, cells of open ground: it will not drive
/// farther off than that before it is asked again.
constexpr std::uint32_t kBeyondRobot = 120U * kCostsPerCell;
/// And kept until they are this much longer: the robot may be driven off its way without all being settled anew.
constexpr std::uint32_t kKeptBeyondRobot = 160U * kCostsPerCell;
/// Cells that have changed, as a share of all, from which on all is settled anew.
constexpr std::size_t kFewOf = 16;

constexpr float kRoom_m = 1.0F;             ///< more than that between body's middle and surfaces is worth no detour
constexpr float kRoomWeight = 2.5F;         ///< by trial: a prototype's, on two maps
constexpr float kTightWeight = 30.0F;       ///< where a body's corners would touch if it turned:
constexpr float kTightWeightOfLong = 3.0F;  ///< a long one drives through lengthwise
constexpr float kLong_m = 0.3F;             ///< from the inscribed circle to the corners'
constexpr float kTight_m = 0.03F;           ///< beyond the corners' circle
constexpr float kBlocked_m = 0.01F;         ///< beyond the inscribed circle
constexpr float kUnseenWeight = 8.0F;       ///< near the robot, what it has not seen yet:
constexpr double kUnseenRadius_m = 2.0;     ///< a body must not back into it

}  // namespace

TimeToGoField::Memory::Memory(std::int32_t max_side)
    : surface(static_cast<std::size_t>(Grid{max_side}.cells()), kNowhere),
      unseen(static_cast<std::size_t>(Grid{max_side}.cells())),
      to_go_s(static_cast<std::size_t>(Grid{max_side}.cells()), Guide::kNoWay_s) {}

TimeToGoField::TimeToGoField(double inscribed_m, double circumscribed_m, std::int32_t max_side,
                             std::shared_ptr<const KeepOutField> keep_out, CostSettler* settler, const FarGuide* far)
    : blocked_m_(static_cast<float>(inscribed_m) + kBlocked_m),
      tight_m_(static_cast<float>(circumscribed_m) + kTight_m),
      tight_weight_(tight_m_ - blocked_m_ > kLong_m ? kTightWeightOfLong : kTightWeight),
      keep_out_field_(std::move(keep_out)),
      keep_out_(keep_out_field_ ? keep_out_field_->view() : KeepOut{}),
      surfaces_(max_side),
      row_round_(static_cast<std::size_t>(max_side)),
      ground_rate_(static_cast<std::size_t>(Grid{max_side}.cells())),
      rate_(ground_rate_.size()),
      last_rate_(rate_.size()),
      middle_x_m_(row_round_.size()),
      evidence_(row_round_.size()),
      graph_(max_side),
      repair_(CellGraph::size_for(max_side), 2 * CellGraph::size_for(max_side)),
      settler_(settler),
      far_(far) {
  changed_.resize(rate_.size());  // touched, not only reserved: no page is to be fetched later
  changed_.clear();
}

Guide TimeToGoField::settle(const PlanRequest& request, const Window& window, Memory& memory) noexcept {
  const Window last_window = std::exchange(window_, window);
  const CellBox last_box = std::exchange(box_, box_of(request));
  const bool same_ground = window_ == last_window && box_ == last_box;
  ++round_;
  std::fill_n(memory.unseen.begin(), window_.grid().cells(), std::uint8_t{0});
  surfaces_.find(window_, box_, request.still, request.masked, memory.unseen.data());
  weigh(request, same_ground, memory.unseen.data());
  settle_costs(request, same_ground);
  write(request, memory);
  const Place low = place_of(window_.in_map({0.0, 0.0}));
  return {low.x,
          low.y,
          static_cast<float>(window_.cell_m),
          window_.side,
          leads_through_unseen(request, memory.unseen.data()),
          memory.surface.data(),
          memory.unseen.data(),
          memory.to_go_s.data(),
          leaves_zone_ ? KeepOut{} : keep_out_};
}

void TimeToGoField::draw(const Guide& guide, float* seconds) const noexcept {
  for (std::int32_t c = 0; c < guide.side * guide.side; ++c) {
    const float x = guide.low_x + (static_cast<float>(c % guide.side) + 0.5F) * guide.cell_m;
    const float y = guide.low_y + (static_cast<float>(c / guide.side) + 0.5F) * guide.cell_m;
    const bool has_way = guide.to_go_s[c] < Guide::kNoWay_s, has_room = guide.room(x, y) >= blocked_m_;
    seconds[c] = has_way ? guide.to_go_s[c] : has_room ? cell::kUnreachable : cell::kNotFree;
  }
}

/// Everything that is known, keep-out zones, robot and goal, and three metres about them: room enough to walk round.
CellBox TimeToGoField::box_of(const PlanRequest& request) noexcept {
  const std::int32_t last = window_.side - 1, margin = static_cast<std::int32_t>(3.0 / window_.cell_m);
  const CellIndex robot = window_.cell_at(request.map_from_robot.position());
  const CellIndex goal = projected_goal(window_, request.map_from_robot.position(), request.goal_in_map);
  CellBox box{std::min(robot.i, goal.i), std::min(robot.j, goal.j), std::max(robot.i, goal.i),
              std::max(robot.j, goal.j)};
  const auto row_end = evidence_.begin() + window_.side;
  const auto is_wall = [](std::int8_t evidence) { return evidence > EvidenceMap::kOccupied; };
  for (std::int32_t j = 0; request.still != nullptr && j <= last; ++j) {
    request.still->copy_row({window_.low.i, window_.low.j + j}, window_.side, evidence_.data());
    const auto first = std::find_if(evidence_.begin(), row_end, is_wall);
    if (first == row_end) continue;
    const auto after = std::find_if(std::make_reverse_iterator(row_end), evidence_.rend(), is_wall).base();
    box = {std::min(box.i0, static_cast<std::int32_t>(first - evidence_.begin())), std::min(box.j0, j),
           std::max(box.i1, static_cast<std::int32_t>(after - evidence_.begin()) - 1), std::max(box.j1, j)};
  }
  if (keep_out_.known()) {
    const CellIndex low = window_.cell_at({static_cast<double>(keep_out_.low_x), static_cast<double>(keep_out_.low_y)});
    const auto cells = [&](std::int32_t nodes) {
      return static_cast<std::int32_t>(static_cast<double>(keep_out_.node_m) * nodes / window_.cell_m);
    };
    box = {std::min(box.i0, low.i), std::min(box.j0, low.j), std::max(box.i1, low.i + cells(keep_out_.width)),
           std::max(box.j1, low.j + cells(keep_out_.height))};
  }
  return {std::clamp(box.i0 - margin, 0, last), std::clamp(box.j0 - margin, 0, last),
          std::clamp(box.i1 + margin, 0, last), std::clamp(box.j1 + margin, 0, last)};
}

std::uint16_t TimeToGoField::rate_at(float d) const noexcept {
  if (d < blocked_m_) return 0;
  const float near = d < kRoom_m ? kRoom_m - d : 0.0F;
  const float tight = d < tight_m_ ? (tight_m_ - d) / (tight_m_ - blocked_m_) : 0.0F;
  return static_cast<std::uint16_t>(kRates * (1.0F + kRoomWeight * near * near + tight_weight_ * tight * tight));
}

/// Whether the shortest way from the robot, or from the nearest cell that has one, soon passes what was never seen.
bool TimeToGoField::leads_through_unseen(const PlanRequest& request, const std::uint8_t* unseen) const noexcept {
  const CellIndex robot = window_.cell_at(request.map_from_robot.position());
  std::int32_t i = robot.i, j = robot.j;
  for (double gone = 0.0; gone < kUnseenRadius_m;) {
    std::uint32_t least = kNoWay;
    CellStep best{};
    for (const CellStep& n : CellGraph::kSteps) {
      const std::int32_t x = i + n.di, y = j + n.dj;
      if (x < box_.i0 || y < box_.j0 || x > box_.i1 || y > box_.j1) continue;
      const std::uint32_t cost = graph_.cost(graph_.at(x, y));
      if (cost < least) least = cost, best = n;
    }
    if (least == kNoWay) return false;
    i += best.di, j += best.dj;
    if (unseen[window_.grid().at(i, j)] != 0) return true;
    if (least == 0) return false;
    gone += window_.cell_m * best.length / kStraightLength;
  }
  return false;
}

void TimeToGoField::weigh(const PlanRequest& request, bool same_ground, const std::uint8_t* unseen) noexcept {
  const auto cells = window_.grid().cells();
  const Place robot = place_of(request.map_from_robot.position());
  const bool leaves_zone = keep_out_.distance(robot.x, robot.y) < 0.0F;  // then no zone counts: the robot may leave
  const bool anew = std::exchange(leaves_zone_, leaves_zone) != leaves_zone;
  if (!same_ground) std::fill_n(ground_rate_.begin(), cells, std::uint16_t{0});
  for (std::int32_t i = box_.i0; i <= box_.i1; ++i) {
    middle_x_m_[static_cast<std::size_t>(i)] = place_of(window_.in_map({i + 0.5, 0.0})).x;
  }
  for (std::int32_t j = 0; j < window_.side; ++j) {
    if (surfaces_.is_new(j)) row_round_[static_cast<std::size_t>(j)] = round_;
    if ((anew || surfaces_.is_new(j)) && j >= box_.j0 && j <= box_.j1) weigh_ground(j);
  }
  rate_.swap(last_rate_);
  std::copy_n(ground_rate_.begin(), cells, rate_.begin());
  for_each_in_disc(window_, box_, request.map_from_robot.position(), kUnseenRadius_m, [&](std::int32_t c) {
    if (unseen[c] != 0) add_weight(c, kUnseenWeight);
  });
  for (const StandingPedestrian& pedestrian : request.standing) {
    const auto beside = [&](float gap_m, float weight) {
      for_each_in_disc(window_, box_, pedestrian.position_in_map,
                       pedestrian.radius_m + static_cast<double>(blocked_m_ + gap_m),
                       [&](std::int32_t c) { add_weight(c, weight); });
    };
    beside(price::kPolite_m, price::kPolite);
    beside(price::kBeside_m, price::kBeside - price::kPolite);
  }
}

/// Weights by the nearer of surface and keep-out zone. A robot in a zone has none closed, or it would have no way out.
void TimeToGoField::weigh_ground(std::int32_t j) noexcept {
  constexpr auto kInZone = static_cast<std::uint16_t>(kRates * kDearest);
  const float y = place_of(window_.in_map({0.0, j + 0.5})).y;
  for (std::int32_t i = box_.i0; i <= box_.i1; ++i) {
    const auto c = static_cast<std::size_t>(window_.grid().at(i, j));
    const Place& surface = surfaces_.surface()[c];
    const float x = middle_x_m_[static_cast<std::size_t>(i)], dx = surface.x - x, dy = surface.y - y;
    std::uint16_t& rate = ground_rate_[c] = rate_at(std::sqrt(dx * dx + dy * dy));
    if (!keep_out_.known() || rate == 0) continue;
    const std::uint16_t zone = rate_at(keep_out_.distance(x, y));
    rate = zone == 0 && !leaves_zone_ ? std::uint16_t{0} : std::max(rate, zone == 0 ? kInZone : zone);
  }
}

void TimeToGoField::add_weight(std::int32_t c, float weight) noexcept {
  std::uint16_t& rate = rate_[static_cast<std::size_t>(c)];
  if (rate == 0) return;
  rate = static_cast<std::uint16_t>(std::min(static_cast<float>(rate) + kRates * weight, kRates * kDearest));
}

/// The goal's cell, or the nearest free one; kNone where there is none near or the goal is outside.
std::int32_t TimeToGoField::goal_cell(const PlanRequest& request) const noexcept {
  const Grid grid = window_.grid();
  if (!window_.holds(request.goal_in_map, 0)) return CellGraph::kNone;
  std::int32_t best = -1;
  double least = kGoalRadius_m;
  for_each_in_disc(window_, box_, request.goal_in_map, kGoalRadius_m, [&](std::int32_t c) {
    if (rate_[static_cast<std::size_t>(c)] == 0) return;
    const double away = distance(window_.in_map({c % grid.side + 0.5, c / grid.side + 0.5}), request.goal_in_map);
    if (away < least) least = away, best = c;
  });
  return best < 0 ? CellGraph::kNone : graph_.at(best % grid.side, best / grid.side);
}

/// For a goal outside every cell of the border, with what is left beyond.
void TimeToGoField::seed_border(const PlanRequest& request) noexcept {
  const Vec2 robot = request.map_from_robot.position();
  const bool knows_far = far_ != nullptr && far_->has_way_near(robot);
  const double through = distance(robot, request.goal_in_map);
  const auto add = [&](std::int32_t i, std::int32_t j) {
    const std::int32_t n = graph_.at(i, j);
    if (rate_[static_cast<std::size_t>(window_.grid().at(i, j))] == 0 || graph_.cost(n) != kNoWay) return;
    const Vec2 here = window_.in_map({i + 0.5, j + 0.5});
    // Straight on, relative to the straight way, so that a goal far off costs no more than numbers hold.
    const double more = knows_far ? far_->to_go_m(here)
                                  : distance(here, request.goal_in_map) - through + window_.side * window_.cell_m * 1.5;
    if (std::isinf(more)) return;
    repair_.offer(graph_, n, static_cast<std::uint32_t>(std::max(0.0, more) / window_.cell_m * kCostsPerCell));
  };
  for (std::int32_t i = box_.i0; i <= box_.i1; ++i) add(i, box_.j0), add(i, box_.j1);
  for (std::int32_t j = box_.j0; j <= box_.j1; ++j) add(box_.i0, j), add(box_.i1, j);
}

void TimeToGoField::settle_costs(const PlanRequest& request, bool same_ground) noexcept {
  graph_.take_grid(window_.grid());
  const std::int32_t robot = graph_.at(window_.cell_at(request.map_from_robot.position()));
  const std::int32_t goal = goal_cell(request), last = std::exchange(goal_, goal);
  if (certified_ && same_ground && goal != CellGraph::kNone && goal == last && repair_costs(window_.grid(), robot))
    return;
  settle_anew(request, robot);
}

/// False where all is to be settled anew.
bool TimeToGoField::repair_costs(Grid grid, std::int32_t robot) noexcept {
  const auto cells = static_cast<std::size_t>(grid.cells());
  const auto side = static_cast<std::size_t>(grid.side);
  changed_.clear();
  for (std::size_t j = 0; j < side; ++j) {
    const std::uint16_t *now = &rate_[j * side], *before = &last_rate_[j * side];
    if (std::memcmp(now, before, side * sizeof *now) == 0) continue;
    for (std::size_t i = 0; i < side; ++i) {
      if (now[i] == before[i]) continue;
      changed_.push_back(graph_.at(static_cast<std::int32_t>(i), static_cast<std::int32_t>(j)));
      graph_.set_rate(changed_.back(), now[i]);
    }
  }
  return changed_.size() <= cells / kFewOf && repair_.repair(graph_, changed_) && graph_.reaches(robot, kBeyondRobot);
}

void TimeToGoField::settle_anew(const PlanRequest& request, std::int32_t robot) noexcept {
  const Grid grid = window_.grid();
  graph_.clear();
  for (std::int32_t j = box_.j0; j <= box_.j1; ++j) {
    for (std::int32_t i = box_.i0; i <= box_.i1; ++i) {
      graph_.set_rate(graph_.at(i, j), rate_[static_cast<std::size_t>(grid.at(i, j))]);
    }
  }
  graph_.seed(goal_);
  graph_.end_beyond(robot, kKeptBeyondRobot);
  repair_.clear();
  if (goal_ != CellGraph::kNone) repair_.offer(graph_, goal_, 0);
  if (!window_.holds(request.goal_in_map, 0)) seed_border(request);
  // Room for two entries a cell has always done.
  certified_ = (settler_ != nullptr && settler_->settle({grid.side, robot, kKeptBeyondRobot, graph_.nodes()})) ||
               repair_.settle(graph_);
  graph_.keep_end();
}

void TimeToGoField::write(const PlanRequest& request, Memory& memory) noexcept {
  const Grid grid = window_.grid();
  const std::uint32_t last = graph_.beyond(graph_.at(window_.cell_at(request.map_from_robot.position())), kBeyondRobot);
  const double seconds = window_.cell_m / (std::max(request.speed_mps, 0.05) * kCostsPerCell);
  std::fill_n(memory.to_go_s.begin(), grid.cells(), Guide::kNoWay_s);
  for (std::int32_t j = box_.j0; j <= box_.j1; ++j) {
    float* to_go_s = &memory.to_go_s[static_cast<std::size_t>(grid.at(0, j))];
    for (std::int32_t i = box_.i0; i <= box_.i1; ++i) {
      const std::uint32_t cost = graph_.cost(graph_.at(i, j));
      to_go_s[i] = cost <= last ? static_cast<float>(static_cast<double>(cost) * seconds) : Guide::kNoWay_s;
    }
  }
  for (std::int32_t j = 0; j < grid.side; ++j) {
    if (row_round_[static_cast<std::size_t>(j)] <= memory.round) continue;
    std::copy_n(surfaces_.surface() + grid.at(0, j), grid.side, memory.surface.begin() + grid.at(0, j));
  }
  memory.round = round_;
}

}  // namespace jaywalk::field
