#include "planner/motion/way_pursuit.h"

#include <algorithm>
#include <cmath>

namespace jaywalk::motion {
namespace {

constexpr float kPursuitLookM = 0.35F;  // pure pursuit: of the way ahead
constexpr float kPassedM = 0.03F;       // ahead of the axle: a pose is passed
constexpr float kTurnedRad = 0.06F;     // off: turned
constexpr float kTurnsWithin = 0.9F;    // of where it arrives: it turns to the heading wanted there
constexpr float kPursuitGain = 2.0F;    // rad/s a radian off, on the spot
constexpr float kTurnShare = 0.8F;      // of the fastest turn
constexpr float kPursuitSlowing = 0.35F, kLeastMps = 0.03F;  // m/s2, towards a change of gear
constexpr float kCloseM = 0.2F;  // nearer than this the circle through a place says little: by heading
constexpr float kKeepM = 0.055F, kRoomGain = 10.0F, kCreepMps = 0.12F;  // of the outline's edge, by its room
constexpr std::int32_t kSmallTurn = 2;                                  // poses of a turn that an arc has, too

}  // namespace

WayPursuit::WayPursuit(const Situation& situation, const RobotState& from) noexcept : s_(situation) {
  s_.poses->way_from(from.x, from.y, from.heading, way_);
  join_small_turns();
}

/// A step or two of turning between two drives of one gear is a bend of the drive.
void WayPursuit::join_small_turns() noexcept {
  for (std::int32_t k = 0; k < way_.count;) {
    std::int32_t end = k;
    while (end < way_.count && pose(end).gear == Gear::kTurn) ++end;
    const bool is_last = end == way_.count, is_first = k <= 1;
    if (end > k && end - k <= kSmallTurn && !is_last && (is_first || pose(k - 1).gear == pose(end).gear)) {
      for (std::int32_t n = k; n < end; ++n) way_.poses[static_cast<std::size_t>(n)].gear = pose(end).gear;
    }
    k = std::max(end, k + 1);
  }
}

bool turns_at_goal(const Situation& s, const RobotState& r) noexcept {
  const float within = kTurnsWithin * s.arrives_within_m;
  return s.wants_heading && rests_near(r, s.goal.x, s.goal.y, within, within, s.body.bounds);
}

Command turn_to(float heading, const RobotState& r, const MotionBounds& bounds) noexcept {
  const float most = kTurnShare * bounds.turn;
  return {0.0F, std::clamp(kPursuitGain * cell::wrapped(heading - r.heading), -most, most)};
}

bool WayPursuit::has_more(const RobotState& r) noexcept {
  if (turns_at_goal(s_, r)) return true;
  while (way_.count > 1 && at_ < way_.count) {
    const Gear gear = pose(at_).gear;
    end_ = at_;
    while (end_ + 1 < way_.count && pose(end_ + 1).gear == gear) ++end_;
    if (gear == Gear::kTurn) {
      if (std::fabs(cell::wrapped(pose(end_).heading - r.heading)) >= kTurnedRad) return true;
      at_ = end_ + 1;
      continue;
    }
    while (at_ <= end_ && is_passed(r, pose(at_))) ++at_;
    if (at_ <= end_) return true;
  }
  return false;
}

bool WayPursuit::is_passed(const RobotState& r, const WayPose& p) const noexcept {
  const cell::Heading a = cell::heading_at(r.heading);
  const float ahead = (p.x - r.x) * a.x + (p.y - r.y) * a.y;
  return (p.gear == Gear::kBackward ? -ahead : ahead) < kPassedM;
}

/// Place at which the way leaves the circle of kPursuitLookM, or the last one of this gear.
Place WayPursuit::look_ahead(const RobotState& r) const noexcept {
  const auto distance_to = [&](const WayPose& p) {
    return std::sqrt((p.x - r.x) * (p.x - r.x) + (p.y - r.y) * (p.y - r.y));
  };
  float before = 0.0F;
  for (std::int32_t k = at_; k <= end_; before = distance_to(pose(k)), ++k) {
    const WayPose& p = pose(k);
    const float d = distance_to(p);
    if (d < kPursuitLookM) continue;
    if (k == at_) return {p.x, p.y};
    const WayPose& from = pose(k - 1);
    const float share = (kPursuitLookM - before) / std::max(d - before, 1e-3F);
    return {from.x + share * (p.x - from.x), from.y + share * (p.y - from.y)};
  }
  return {pose(end_).x, pose(end_).y};
}

/// Curvature of the circle through a place; near it, of what turns to the heading there.
float WayPursuit::bend_to(Place target, const RobotState& r) const noexcept {
  const cell::Heading a = cell::heading_at(r.heading);
  const float dx = target.x - r.x, dy = target.y - r.y, d2 = std::max(dx * dx + dy * dy, 1e-4F);
  if (d2 >= kCloseM * kCloseM) return 2.0F * (dy * a.x - dx * a.y) / d2;
  const float sign = pose(at_).gear == Gear::kForward ? 1.0F : -1.0F;
  return sign * cell::wrapped(pose(end_).heading - r.heading) / std::max(std::sqrt(d2), 0.5F * kCloseM);
}

float WayPursuit::room_m() const noexcept {
  float least = 1.0F;
  for (std::int32_t k = std::max(0, at_ - 1); k <= std::min(at_ + 1, end_); ++k)
    least = std::min(least, pose(k).room_m);
  return least;
}

Command WayPursuit::command(const RobotState& r, float speed) noexcept {
  if (turns_at_goal(s_, r)) return turn_to(s_.goal_heading, r, s_.body.bounds);
  const Gear gear = pose(at_).gear;
  if (gear == Gear::kTurn) return turn_to(pose(end_).heading, r, s_.body.bounds);
  const MotionBounds& b = s_.body.bounds;
  const float bend = bend_to(look_ahead(r), r), size = std::fabs(bend);
  float v = gear == Gear::kForward ? speed : std::min(b.back, std::max(speed, kLeastMps));
  if (end_ + 1 < way_.count) {
    const float dx = pose(end_).x - r.x, dy = pose(end_).y - r.y;
    v = std::min(v, std::sqrt(2.0F * kPursuitSlowing * std::sqrt(dx * dx + dy * dy)) + kLeastMps);
  }
  if (size > 1e-3F) v = std::min(v, b.turn / size);
  const float rim_mps = std::max((room_m() - kKeepM) * kRoomGain, kCreepMps);
  v = std::min(v, rim_mps / (1.0F + size * s_.body.rim_m));
  const float signed_v = gear == Gear::kForward ? v : -v;
  return {signed_v, std::clamp(signed_v * bend, -b.turn, b.turn)};
}

}  // namespace jaywalk::motion
