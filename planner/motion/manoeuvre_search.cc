#include "planner/motion/manoeuvre_search.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <utility>

#include "planner/motion/least_clearance.h"

namespace jaywalk {
namespace {

constexpr std::int32_t kHalfSteps = 96;  // 3.75 degrees
constexpr double kHalfStep_rad = 2.0 * kPi / kHalfSteps;
constexpr double kCell_m = 0.05;
constexpr std::int32_t kSide = 128, kHeadings = 48;
constexpr std::size_t kMostNodes = 131072;
constexpr int kMostLooks = 24000;  // poses whose outline is looked at
constexpr float kGreed = 2.0F;     // the way left counts double: not the cheapest manoeuvre, but found ten times sooner

// What things cost, in metres driven forward.
constexpr float kBackward = 2.0F;    // a metre backward
constexpr float kGearChange = 0.4F;  // stopping and going again
constexpr float kBend = 0.015F;  // a curve that begins or ends, by 3.75 degrees a move: wheels cannot follow at once
constexpr float kTurn = 0.6F;    // a radian on the spot
constexpr float kRoomWanted_m = 0.2F;  // less costs more:
constexpr float kTightness = 2.0F;     // this share at no room at all

/// An arc of about 0.1 m, or a turn on the spot.
struct Move {
  Gear gear;
  std::int32_t turn;  ///< half steps, to the left positive
  double length_m;    ///< along the heading: backward negative
};
// 3.75 degrees on 0.1 m: a radius of 1.5 m; 7.5 degrees on 0.105 m: 0.8 m; 15 degrees: 0.4 m.
constexpr std::array<Move, 16> kMoves{{{Gear::kForward, 0, 0.1},
                                       {Gear::kForward, 1, 0.1},
                                       {Gear::kForward, -1, 0.1},
                                       {Gear::kForward, 2, 0.105},
                                       {Gear::kForward, -2, 0.105},
                                       {Gear::kForward, 4, 0.105},
                                       {Gear::kForward, -4, 0.105},
                                       {Gear::kBackward, 0, -0.1},
                                       {Gear::kBackward, 1, -0.1},
                                       {Gear::kBackward, -1, -0.1},
                                       {Gear::kBackward, 2, -0.105},
                                       {Gear::kBackward, -2, -0.105},
                                       {Gear::kBackward, 4, -0.105},
                                       {Gear::kBackward, -4, -0.105},
                                       {Gear::kTurn, 2, 0.0},
                                       {Gear::kTurn, -2, 0.0}}};
constexpr std::uint8_t kNoMove = 255;

std::int32_t turned(std::int32_t heading, std::int32_t by) { return (heading + by + kHalfSteps) % kHalfSteps; }

double curvature_of(const Move& move) {
  return move.length_m == 0.0 ? 0.0 : move.turn * kHalfStep_rad / std::fabs(move.length_m);
}

}  // namespace

ManoeuvreSearch::ManoeuvreSearch(const Footprint& footprint)
    : way_(footprint.inscribed_radius_m()), closed_(static_cast<std::size_t>(kSide * kSide * kHeadings)) {
  nodes_.reserve(kMostNodes);
  open_.reserve(kMostNodes);
  axes_.resize(kHalfSteps);
}

void ManoeuvreSearch::begin(const BodyMap& map, const Pose2& start, const ManoeuvreGoal& goal,
                            double margin_m) noexcept {
  map_ = &map;
  start_ = start;
  goal_ = goal;
  found_.clear();
  nodes_.clear();
  open_.clear();
  if (++search_ == 0) std::fill(closed_.begin(), closed_.end(), 0U), search_ = 1;
  for (std::int32_t k = 0; k < kHalfSteps; ++k) {
    axes_[static_cast<std::size_t>(k)] = direction(start.heading + k * kHalfStep_rad);
  }
  way_.settle(map, goal.position_in_map);
  margin_m_ = margin_m;
  at_start_m_ = map.clearance(start);
}

/// What is still to pay at least: the circle's way, and the turn to the heading wished for.
float ManoeuvreSearch::rest(const Node& node) const noexcept {
  const float way = way_.from(node.position);
  if (goal_.any_heading) return way;
  return way + kTurn * static_cast<float>(heading_error(node));
}

double ManoeuvreSearch::heading_error(const Node& node) const noexcept {
  const double heading = start_.heading + node.heading * kHalfStep_rad;
  return std::fabs(wrap_angle(heading - goal_.heading));
}

bool ManoeuvreSearch::has_arrived(const Node& node) const noexcept {
  return distance(node.position, goal_.position_in_map) < goal_.within_m && heading_error(node) <= goal_.within_rad;
}

double ManoeuvreSearch::clearance(Vec2 position, std::int32_t heading, double least_m) const noexcept {
  return map_->clearance(position, axes_[static_cast<std::size_t>(heading)], least_m);
}

/// Number of the node's state; -1 outside the square.
std::int32_t ManoeuvreSearch::state_of(const Node& node) const noexcept {
  if (!map_->covers(node.position)) return -1;
  const Vec2 at = (node.position - map_->low()) * (1.0 / kCell_m);
  const std::int32_t cell = static_cast<std::int32_t>(at.y) * kSide + static_cast<std::int32_t>(at.x);
  return cell * kHeadings + node.heading / 2;
}

/// Looks at the outline half-way from the parent and at the end; no part of it goes further than 0.16 m between two
/// looks. Keeps the lesser clearance.
bool ManoeuvreSearch::fits_on_the_way(Node& node) const noexcept {
  const Move& move = kMoves[node.move];
  const Node& from = nodes_[static_cast<std::size_t>(node.parent)];
  const double least = least_clearance_m(margin_m_, at_start_m_, static_cast<double>(from.clearance));
  double nearest = clearance(node.position, node.heading, least);
  if (nearest < least) return false;
  if (move.turn != 0 && move.gear != Gear::kTurn) {
    const Vec2 halfway = (from.position + node.position) * 0.5;  // off the arc by less than 4 mm
    nearest = std::min(nearest, clearance(halfway, turned(from.heading, move.turn / 2), least));
  }
  node.clearance = static_cast<float>(nearest);
  if (nearest < least) return false;
  return move.gear == Gear::kForward ||
         !map_->goes_unseen(node.position, axes_[static_cast<std::size_t>(node.heading)]);
}

void ManoeuvreSearch::push(const Node& node) noexcept {
  const std::int32_t state = state_of(node);
  if (state < 0 || closed_[static_cast<std::size_t>(state)] == search_) return;
  const float rest_cost = rest(node);
  if (!(rest_cost < std::numeric_limits<float>::infinity()) || nodes_.size() == kMostNodes) return;
  nodes_.push_back(node);
  open_.push_back({node.cost + kGreed * rest_cost, static_cast<std::int32_t>(nodes_.size()) - 1});
  std::push_heap(open_.begin(), open_.end());
}

void ManoeuvreSearch::open(const Node& from, std::int32_t index) noexcept {
  const float tight = 1.0F + kTightness * std::max(0.0F, 1.0F - from.clearance / kRoomWanted_m);
  for (std::size_t m = 0; m < kMoves.size(); ++m) {
    const Move& move = kMoves[m];
    // The chord of an arc: along the mean heading, shorter by less than a third of a percent.
    const Vec2 along = axes_[static_cast<std::size_t>(turned(from.heading, move.turn / 2))];
    const auto length = static_cast<float>(std::fabs(move.length_m));
    float cost = length * (move.gear == Gear::kBackward ? kBackward : 1.0F);
    if (move.gear == Gear::kTurn) cost = kTurn * 2.0F * static_cast<float>(kHalfStep_rad);
    const bool change = from.move != kNoMove && kMoves[from.move].gear != move.gear;
    const std::int32_t bend = from.move == kNoMove ? 0 : std::abs(kMoves[from.move].turn - move.turn);
    push({.position = from.position + along * move.length_m,
          .cost = from.cost + cost * tight + (change ? kGearChange : kBend * static_cast<float>(bend)),
          .clearance = 0.0F,
          .parent = index,
          .heading = static_cast<std::int16_t>(turned(from.heading, move.turn)),
          .move = static_cast<std::uint8_t>(m)});
  }
}

/// The poses from the start to node `last`; the first ones where it would not fit.
void ManoeuvreSearch::draw(std::int32_t last) noexcept {
  std::size_t length = 0;
  for (std::int32_t n = last; n >= 0; n = nodes_[static_cast<std::size_t>(n)].parent) ++length;
  for (; length > found_.capacity(); --length) last = nodes_[static_cast<std::size_t>(last)].parent;
  for (std::size_t k = 0; k < length; ++k) (void)found_.push_back({});
  for (std::size_t k = length; k-- > 0;) {
    const Node& node = nodes_[static_cast<std::size_t>(last)];
    const double heading = wrap_angle(start_.heading + node.heading * kHalfStep_rad);
    found_[k].map_from_robot = {node.position.x, node.position.y, heading};
    found_[k].clearance_m = static_cast<double>(node.clearance);
    if (node.move != kNoMove) found_[k].gear = kMoves[node.move].gear;
    if (node.move != kNoMove) found_[k].curvature_per_m = curvature_of(kMoves[node.move]);
    last = node.parent;
  }
  if (length > 1) found_[0].gear = found_[1].gear;
}

const Manoeuvre& ManoeuvreSearch::find(const BodyMap& map, const Pose2& start, const ManoeuvreGoal& goal,
                                       double margin_m) noexcept {
  begin(map, start, goal, margin_m);
  push({.position = start.position(),
        .cost = 0.0F,
        .clearance = static_cast<float>(at_start_m_),
        .parent = -1,
        .heading = 0,
        .move = kNoMove});
  if (nodes_.empty()) return found_;
  for (int looks = 0; !open_.empty() && looks < kMostLooks; ++looks) {
    std::pop_heap(open_.begin(), open_.end());
    const std::int32_t index = open_.back().node;
    open_.pop_back();
    Node& node = nodes_[static_cast<std::size_t>(index)];
    std::uint32_t& closed = closed_[static_cast<std::size_t>(state_of(node))];
    if (closed == search_ || (node.move != kNoMove && !fits_on_the_way(node))) continue;
    closed = search_;
    if (has_arrived(node)) {
      draw(index);
      break;
    }
    open(Node(node), index);
  }
  return found_;
}

}  // namespace jaywalk
