#include "planner/motion/judge.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "planner/cell/exp_log.h"

namespace jaywalk::motion {
namespace {

// Seconds that a passenger would give not to have it; by trial on a prototype, maps 3 and 4, seeds 9001 to 9010.
constexpr float kConflict = 200.0F, kConflictFadesS = 4.0F;  ///< what is far ahead will be decided on again
constexpr float kWhoStands =
    0.1F;  ///< of it: who has stood for long and sets out is seen to before the robot drives on
constexpr float kTouch = 500.0F, kNearlyTouch = 1000.0F;
constexpr float kStopZone = 40.0F;  ///< all of the speed, at once; less by a factor e for each second until then
constexpr float kBlindRim = 10.0F;  ///< a m/s that the supervisor would take away, each step
constexpr float kNearWall = 4.0F, kNearWallM = 0.15F;  ///< a second, at the body's edge
constexpr float kByWall = 0.6F, kByWallM = 0.28F;
constexpr float kUnseen = 40.0F;                              ///< a second, with all of the rim
constexpr float kUnseenFadesM = 0.6F;                         ///< after driving on so far it has been seen, most likely
constexpr float kUnseenDared = 0.15F, kUnseenTurned = 10.0F;  ///< where the only way leads there; and a rad/s
constexpr float kNearMover = 0.15F;                           ///< a look, each
constexpr float kTooFast = 4.0F;    ///< a m/s, each look, faster beside who stands than the gap within a second,
constexpr float kPoliteMps = 0.2F;  ///< or than this: decision 15
constexpr float kAccel = 2.0F, kTurnAccel = 2.0F;     ///< a squared change of m/s, rad/s in a step
constexpr float kTurning = 0.01F, kSideways = 0.03F;  ///< a squared rad/s, m/s2, each step
constexpr float kBackward = 0.02F;                    ///< each step
constexpr float kReversal = 1.5F;                     ///< turning to the other side; maps 1 to 4, seeds 9001 to 9005
constexpr float kPricedAtMps =
    0.6F;  ///< changes of speed and side are worth so much way: a faster robot drives it sooner
constexpr float kImpatience = 0.25F, kMostStoodS = 4.0F;  ///< a second before it sets out, for each that it has stood
constexpr float kMostAloneS = 12.0F;  ///< the same with no pedestrian about (docs/decisions/0076: BARN, seed 706)
constexpr float kArrivedEarly = 0.5F;
constexpr float kFacingM = 0.35F;

constexpr float kTouchM = 0.03F;  ///< of a surface counts as touching: pose and map err
constexpr float kMoverMarginM = 0.035F;
constexpr float kZoneM = 0.5F + 0.1F;  ///< before a mover: where it would turn away, and a margin
constexpr float kZoneSideM = 0.013F;
constexpr float kMostTimeToGoS = 500.0F;

/// What a disc of the robot has to do with one mover, in all futures.
struct Meeting {
  std::uint32_t met = 0;  ///< in which it touches the mover, or stands in the quarter circle before it while it walks
  std::uint32_t touched = 0;  ///< of these: in which it touches the mover
  float nearness = 0.0F;      ///< a sum over futures
  float too_fast = 0.0F;      ///< beside it while it stands: m/s over what is polite, a sum over futures
};

Meeting meet(const MoverAt& at, float mover_m, bool is_surface, float x, float y, float disc_m, float speed,
             float berth_m) {
  const float touch = mover_m + disc_m + kMoverMarginM, touch2 = touch * touch;
  const float zone = mover_m + kZoneM, edge = disc_m + kZoneSideM;
  const float berth2 = berth_m * berth_m;
  const float reach2 = (zone + edge) * (zone + edge), edge2 = edge * edge;
  alignas(32) std::int32_t hit[kFutures], faced[kFutures];
  alignas(32) float near[kFutures], fast[kFutures];
  for (int k = 0; k < kFutures; ++k) {
    const float dx = x - at.x[k], dy = y - at.y[k], d2 = dx * dx + dy * dy;
    const float ahead = dx * at.along_x[k] + dy * at.along_y[k];
    const float left = dy * at.along_x[k] - dx * at.along_y[k], aside = left < 0.0F ? -left : left;
    // Along the quarter circle's side, and off it; beyond the side a disc still reaches in.
    const float along = (ahead + aside) * 0.70710678F, off = (aside - ahead) * 0.70710678F;
    const float over = edge2 - off * off;
    const float first = along - std::sqrt(over > 0.0F ? over : 0.0F);
    const std::int32_t inside = (aside <= ahead) & (d2 < reach2);
    const std::int32_t beside = (aside > ahead) & (along > 0.0F) & (over > 0.0F) & (first < zone);
    hit[k] = d2 < touch2 ? 1 : 0;
    faced[k] = inside | beside;
    near[k] = d2 < berth2 ? berth2 - d2 : 0.0F;
    const float gap = std::sqrt(d2) - mover_m - disc_m;  // it may set out, and be there within a second
    const float polite = gap < kPoliteMps ? kPoliteMps : gap;
    fast[k] = speed > polite ? speed - polite : 0.0F;
  }
  Meeting m;
  std::uint32_t touched = 0, in_zone = 0;
  for (int k = 0; k < kFutures; ++k) {
    touched |= static_cast<std::uint32_t>(hit[k]) << k;
    in_zone |= static_cast<std::uint32_t>(faced[k]) << k;
    m.nearness += near[k];
    m.too_fast += (at.walks >> k & 1U) != 0 ? 0.0F : fast[k];
  }
  m.touched = is_surface ? touched & at.walks : touched;
  m.met = m.touched | (in_zone & at.walks);
  return m;
}

/// A disc of the robot, and a mover, in all futures.
struct Pair {
  Place disc;
  const MoverAt& at;
  [[nodiscard]] float distance2(int future) const {
    const float dx = disc.x - at.x[future], dy = disc.y - at.y[future];
    return dx * dx + dy * dy;
  }
};

/// Those of `futures` in which the two are nearer than before.
std::uint32_t nearer(std::uint32_t futures, const Pair& now, const Pair& before) {
  std::uint32_t are = 0;
  for (int k = 0; k < kFutures; ++k)
    are |= static_cast<std::uint32_t>(now.distance2(k) < before.distance2(k) ? 1 : 0) << k;
  return futures & are;
}

class Judge {
 public:
  Judge(const Situation& s) : s_(s), along_(cell::heading_at(s.start.heading)), turned_(s.turned) {
    waits_ = s.guide.time_to_go(s.start.x, s.start.y) < Guide::kNoWay_s;
    change_price_ = std::min(1.0F, kPricedAtMps / s.body.bounds.speed);
    cost.time = kArrivedEarly;
  }

  /// A step's own price, wherever it is.
  void drive(const RobotState& before, const RobotState& now) {
    if (s_.wish == nullptr) comfort(before, now);  // a person who steers turns and speeds up at will
    wait(now);
    cost.time += kStepS;
  }

  /// Before the first look().
  void stand_at_start() { clearance_ = at_start_ = clearance_at(s_.start); }

  /// After a step: what the robot is near. `t`: seconds from now.
  void look(const RobotState& now, int step) {
    const float t = static_cast<float>(step + 1) * kStepS;
    along_ = cell::heading_at(now.heading);
    walls(now, t);
    cost.stop_zone += kBlindRim * s_.body.blind.too_fast(now.v, now.w);
    unseen(now);
    if ((step & 1) != 0) movers(now, (step + 1) / 2, t);
  }

  Cost cost;

 private:
  [[nodiscard]] float clearance_at(const RobotState& r) const {
    const float least = s_.body.to_walls.clearance(s_.guide, r.x, r.y, along_);
    const bool coarse = s_.wish == nullptr || least >= kByWallM;
    return std::min(coarse ? least : s_.body.outline.clearance(s_.guide, r.x, r.y, along_), clearance_to_standing(r));
  }

  /// Who has stood for long is a surface as wide as he is, though the map has his shins alone.
  [[nodiscard]] float clearance_to_standing(const RobotState& r) const {
    float least = Guide::kFar_m;
    for (const StandingDisc& disc : s_.futures.standing()) {
      const float dx = disc.x - r.x, dy = disc.y - r.y;
      const float ahead = dx * along_.x + dy * along_.y, left = dy * along_.x - dx * along_.y;
      least = std::min(least, s_.body.gap(ahead, left) - disc.radius);
    }
    return least;
  }

  void walls(const RobotState& r, float t) {
    const float c = clearance_at(r);
    const bool nears = c < clearance_ - 1e-4F && c < at_start_ - 0.003F;  // it may always leave what it stands beside
    clearance_ = c;
    if (c < kTouchM && nears) {
      const float deep = (kTouchM - c) * 20.0F;
      cost.touch += kNearlyTouch * cell::exp(-0.2F * t) * (deep < 1.0F ? deep : 1.0F) + (c < 0.0F ? kTouch : 0.0F);
    }
    if (c >= kByWallM) return;
    if (t < NearReturns::kForS) brake(kStopZone * cell::exp(-t) * s_.returns.braked_share(r, s_.body));
    const float close = c < kNearWallM ? (kNearWallM - c) / kNearWallM : 0.0F;
    // Steered, it passes and stands as near as is wished: the price is for the way very near, not for the time.
    const bool steered = s_.wish != nullptr;
    const float rim = std::fabs(r.v) + std::fabs(r.w) * s_.body.rim_m;
    const float paid = steered ? std::min(1.0F, rim / s_.body.bounds.speed) : 1.0F;
    const float by_wall = steered ? 0.0F : kByWall * (kByWallM - c) / kByWallM;
    cost.clearance += kStepS * paid * (kNearWall * close * close + by_wall);
  }

  /// The dearest braking counts.
  void brake(float price) {
    if (price <= braked_) return;
    cost.stop_zone += price - braked_;
    braked_ = price;
  }

  void unseen(const RobotState& r) {
    if (r.v > 0.0F) gone_ += r.v * kStepS;
    int parts = 0;
    for (const Place& p : s_.body.rim) {
      const float x = r.x + p.x * along_.x - p.y * along_.y, y = r.y + p.x * along_.y + p.y * along_.x;
      parts += s_.guide.is_unseen(x, y) ? 1 : 0;
    }
    if (parts == 0) return;
    const float price = s_.guide.through_unseen ? kUnseenDared + kUnseenTurned * std::fabs(r.w)
                                                : kUnseen * cell::exp(-gone_ / kUnseenFadesM);
    cost.unseen += price * kStepS * static_cast<float>(parts) * 0.125F;
  }

  void comfort(const RobotState& before, const RobotState& now) {
    const float dv = now.v - before.v, dw = now.w - before.w, side = now.v * now.w;
    cost.comfort +=
        change_price_ * (kAccel * dv * dv + kTurnAccel * dw * dw) + kTurning * now.w * now.w + kSideways * side * side;
    if (now.v < -0.01F) cost.comfort += kBackward;
    const float turns = turned_side(now.w, turned_);
    if (turns * turned_ < 0.0F) cost.comfort += change_price_ * kReversal;
    turned_ = turns;
  }

  /// Waiting for a while may look best again and again: the longer it has not got on, the dearer is to stay on. With
  /// no pedestrian about, backing off and returning counts as waiting, too (docs/decisions/0076).
  void wait(const RobotState& now) {
    if (!waits_) return;
    const float least = s_.stay.least_to_go_s;
    waits_ = least > 0.0F ? s_.guide.time_to_go(now.x, now.y) > least - kGetsOnS : s_.stay.holds(now);
    if (waits_) cost.time += kStepS * kImpatience * std::min(s_.stay.for_s, least > 0.0F ? kMostAloneS : kMostStoodS);
  }

  void movers(const RobotState& r, int step, float t) {
    Meeting all;
    std::uint32_t stood = 0;
    const float speed = std::fabs(r.v);
    const BodyDiscs& discs = s_.body.to_movers;
    const int at_step = step < kFutureSteps ? step : kFutureSteps - 1;
    for (std::size_t m = 0; m < s_.futures.movers(); ++m) {
      const MoverAt& at = s_.futures.at(at_step, m);
      const bool surface = s_.futures.is_surface(m);
      const float radius = s_.futures.radius(m);
      const float most = std::max(at.spread + radius + kZoneM + discs.radius + 0.1F, at.spread + s_.body.berth_m);
      for (int k = 0; k < discs.count; ++k) {
        const float x = r.x + discs.ahead[static_cast<std::size_t>(k)] * along_.x;
        const float y = r.y + discs.ahead[static_cast<std::size_t>(k)] * along_.y;
        const float dx = x - at.mid_x, dy = y - at.mid_y;
        if (dx * dx + dy * dy >= most * most) continue;
        const Meeting meeting = meet(at, radius, surface, x, y, discs.radius, speed, s_.body.berth_m);
        const bool has_stood = s_.futures.has_stood(m);  // a surface until it sets out: standing()
        (has_stood ? stood : all.met) |= meeting.met;
        if (meeting.touched != 0 && !has_stood && moves(r))
          all.touched |= nearer(meeting.touched, {{x, y}, at}, {disc_at(s_.start, k), s_.futures.at(0, m)});
        all.nearness += meeting.nearness;
        if (!s_.futures.is_newcomer(m)) all.too_fast += meeting.too_fast;
      }
    }
    cost.nearness += (kNearMover * all.nearness + kTooFast * all.too_fast) / static_cast<float>(kFutures * discs.count);
    count_first(all.met, met_, 1.0F, t);
    count_first(stood, met_, kWhoStands, t);
    count_first(all.touched, touched_, 1.0F, t);
  }

  [[nodiscard]] bool moves(const RobotState& r) const {
    return std::fabs(r.v) + std::fabs(r.w) * s_.body.rim_m > kRestsMps;
  }

  [[nodiscard]] Place disc_at(const RobotState& r, int k) const {
    const cell::Heading along = cell::heading_at(r.heading);
    const float ahead = s_.body.to_movers.ahead[static_cast<std::size_t>(k)];
    return {r.x + ahead * along.x, r.y + ahead * along.y};
  }

  /// For the first time in these futures.
  void count_first(std::uint32_t met, std::uint32_t& before, float weight, float t) {
    const std::uint32_t first = met & ~before;
    before |= met;
    if (first != 0) {
      const float share = static_cast<float>(std::popcount(first)) / kFutures;
      cost.conflict += kConflict * weight * share * cell::exp(-t / kConflictFadesS);
    }
  }

  const Situation& s_;
  cell::Heading along_;
  float clearance_ = 0.0F, at_start_ = 0.0F;
  float turned_ = 0.0F;  ///< to this side it turned last
  float change_price_ = 1.0F;
  bool waits_ = false;     ///< it has not set out yet, though there is a way
  float gone_ = 0.0F;      ///< forward, m
  float braked_ = 0.0F;    ///< paid for it so far
  std::uint32_t met_ = 0;  ///< futures in which somebody was met: a bit each
  /// Futures in which the moving robot touched a mover: a bit each. Priced apart from being in the mover's way.
  std::uint32_t touched_ = 0;
};

/// Seconds from where a trajectory ends, and a second for facing across the way there, two for facing back.
float to_go(const Situation& s, const RobotState& end) {
  const float there = s.guide.time_to_go(end.x, end.y);
  if (there >= Guide::kNoWay_s) return kMostTimeToGoS;
  const cell::Heading along = cell::heading_at(end.heading);
  const float ahead = s.guide.time_to_go(end.x + kFacingM * along.x, end.y + kFacingM * along.y);
  const float gained = there - (ahead < there + 1.0F ? ahead : there + 1.0F);
  const float facing = gained * s.body.bounds.speed / kFacingM;
  return there + (1.0F - facing);
}

/// Rolls a trajectory out until it arrives or ends; returns how many states that are.
int drive(const Situation& s, const Trajectory& trajectory, Judge& judge, RobotState* states) {
  RobotState robot = s.start;
  const int last = s.wish != nullptr ? kWishedSteps : kSteps;
  for (int step = 0; step < last; ++step) {
    const RobotState before = robot;
    states[step] = robot = moved(before, trajectory.commands[static_cast<std::size_t>(step)], s.body.bounds, kStepS);
    judge.drive(before, robot);
    const float dx = robot.x - s.goal.x, dy = robot.y - s.goal.y;
    if (dx * dx + dy * dy < s.arrives_within_m * s.arrives_within_m) {
      judge.cost.time -= kArrivedEarly;
      return step + 1;
    }
  }
  judge.cost.time += s.wish != nullptr ? seconds_off(*s.wish, states, s.body.bounds) : to_go(s, robot);
  return last;
}

}  // namespace

Cost judge(const Situation& s, const Trajectory& trajectory, float bound, RobotState* driven) noexcept {
  Judge judge(s);
  RobotState states[kSteps];
  const int steps = drive(s, trajectory, judge, states);
  if (driven != nullptr) {
    std::copy_n(states, steps, driven);
    std::fill(driven + steps, driven + kSteps, states[steps - 1]);
  }
  if (judge.cost.total() > bound) return judge.cost;  // what it meets can only add
  judge.stand_at_start();
  for (int step = 0; step < steps; ++step) {
    judge.look(states[step], step);
    if ((step & 1) != 0 && judge.cost.total() > bound) return judge.cost;
  }
  return judge.cost;
}

}  // namespace jaywalk::motion
