#pragma once
// Pedestrian model and the futures that it predicts for tracks.
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "hal/types/fixed_vector.h"
#include "planner/cell/cell.h"
#include "planner/cell/draws.h"
#include "planner/cost_to_go/guide.h"
#include "planner/tracking/tuning.h"

namespace jaywalk::motion {
/// Rates at which walkers turn or stop where nothing makes them and standing newcomers walk off, learned while driving.
/// The prior is worth half a minute of looking at one walker: cautious until something else is seen.
struct TurningModel {
  static constexpr float kPriorS = 30.0F, kPriorTurnsHz = 0.01F, kPriorStopsHz = 0.03F;
  float watched_s = 0.0F, turns = 0.0F, stops = 0.0F;
  float usual_mps = 0.6F;  ///< of walkers; the mean of those watched

  /// What is new, stands and is as wide as a body: a prior worth five of them. Among posts it is soon known for posts.
  static constexpr float kPriorNewcomers = 5.0F, kPriorWalkOff = 0.2F, kNewForS = 4.0F;
  float newcomers = 0.0F, walked_off = 0.0F;

  [[nodiscard]] float turns_hz() const { return (turns + kPriorTurnsHz * kPriorS) / (watched_s + kPriorS); }
  [[nodiscard]] float stops_hz() const { return (stops + kPriorStopsHz * kPriorS) / (watched_s + kPriorS); }
  /// Of one newcomer, within kNewForS.
  [[nodiscard]] float walks_off_hz() const {
    return (walked_off + kPriorWalkOff * kPriorNewcomers) / ((newcomers + kPriorNewcomers) * kNewForS);
  }
};

/// What is believed of one mover, when the decision is made. Each estimate is a field: more than a struct has
/// elsewhere.
struct MoverBelief {
  std::uint32_t id = 0;
  float x = 0.0F, y = 0.0F, vx = 0.0F, vy = 0.0F;  ///< at its last sight
  float position_std = 0.0F, velocity_std = 0.0F;
  float correlation = 0.0F;  ///< of position and velocity along an axis
  float late_s = 0.0F;       ///< since that sight
  float radius_m = 0.0F;
  float usual_mps = 0.0F;  ///< its own when it walks, or that of others
  bool is_pedestrian = false;
  bool newcomer = false;                      ///< neither seen to walk nor to have legs: furniture, most likely
  float stood_s = 0.0F;                       ///< in one place
  static constexpr float kLongPauseS = 4.0F;  ///< one that has stood for longer may stand for any time
  [[nodiscard]] bool has_stood() const { return stood_s > kLongPauseS; }
  /// A pedestrian that has stood for long: a body to go round.
  [[nodiscard]] bool stands() const { return is_pedestrian && has_stood(); }
};

/// A drawn speed below half the usual one, or this if that is less, is no walking speed: it walks at its usual one.
inline constexpr float kLeastWalkMps = static_cast<float>(kWalksMps);
/// No faster than this it stands; faster, it is starting to walk.
inline constexpr float kStandsMps = static_cast<float>(kStartsMps);
inline constexpr float kTurnsAtRadps = 1.5F;  ///< before it goes on in another direction
inline constexpr float kLookAheadM = 0.5F;    ///< what lies nearer than this before a mover makes it turn
inline constexpr float kPausesForS = 2.0F;    ///< at most, a pedestrian that walked and stands now
inline constexpr float kStandsForS = 6.0F;    ///< on average, one that has stood for long; or as long as it has stood

/// Whether a surface lies in the quarter circle of `reach` m ahead of a place: looked for in four discs that fill it.
JAYWALK_ANYWHERE bool faces_surface(const Guide& guide, float x, float y, const cell::Heading& along, float reach) {
  if (guide.distance(x, y) > reach) return false;
  const auto near = [&](float ahead, float left, float radius) {
    const float px = x + reach * (ahead * along.x - left * along.y);
    const float py = y + reach * (ahead * along.y + left * along.x);
    return guide.distance(px, py) < reach * radius;
  };
  return near(0.35F, 0.0F, 0.25F) || near(0.7F, 0.0F, 0.3F) || near(0.64F, 0.32F, 0.25F) || near(0.64F, -0.32F, 0.25F);
}

/// A mover in one future. Each drawn quantity is a field: more than a struct has elsewhere.
struct PedestrianSample {
  float x = 0.0F, y = 0.0F, heading = 0.0F;
  cell::Heading along;
  bool walks = false;
  float wait_s = 0.0F, next_heading = 0.0F;  ///< until it sets out, and where to, when it does not walk
  float speed = 0.0F, radius = 0.0F;
  float react_m = 0.0F;  ///< from its middle: what it turns away from
  float until_turn_s = 0.0F, until_stop_s = 0.0F;
  cell::Draws draws{{}};

  JAYWALK_ANYWHERE void face(float rad) {
    heading = rad;
    along = cell::heading_at(rad);
  }

  /// A direction free of walls, if three draws find one; returns how far it has turned by then.
  JAYWALK_ANYWHERE float look_for_way(const Guide& guide) {
    float turned = 0.0F, from = heading;
    for (int trial = 0; trial < 4; ++trial) {
      next_heading = cell::kPiF * draws.either_way();
      turned += std::fabs(cell::wrapped(next_heading - from));
      from = next_heading;
      if (!faces_surface(guide, x, y, cell::heading_at(next_heading), react_m)) break;
    }
    return turned;
  }

  JAYWALK_ANYWHERE void turn_away(const Guide& guide) {
    walks = false;
    wait_s = look_for_way(guide) / kTurnsAtRadps;
  }

  JAYWALK_ANYWHERE static PedestrianSample drawn(const MoverBelief& b, const TurningModel& turning, const Guide& guide,
                                                 const cell::Draws& draws) {
    PedestrianSample w;
    w.draws = draws;
    const float rest = std::sqrt(1.0F - b.correlation * b.correlation);
    const float ex = w.draws.normal(), ey = w.draws.normal();
    const float vx = b.vx + b.velocity_std * (b.correlation * ex + rest * w.draws.normal());
    const float vy = b.vy + b.velocity_std * (b.correlation * ey + rest * w.draws.normal());
    w.x = b.x + b.position_std * ex + vx * b.late_s;
    w.y = b.y + b.position_std * ey + vy * b.late_s;
    w.radius = b.radius_m;
    w.react_m = b.radius_m + kLookAheadM * (0.3F + 0.7F * w.draws.uniform());
    w.until_turn_s = w.draws.waiting_s(turning.turns_hz());
    w.until_stop_s = w.draws.waiting_s(turning.stops_hz());
    w.face(cell::angle_of(vx, vy));
    const float speed = std::sqrt(vx * vx + vy * vy), half = 0.5F * b.usual_mps;
    w.walks = speed > kStandsMps && (b.is_pedestrian || speed > 2.0F * b.velocity_std);
    w.speed = speed > (half < kLeastWalkMps ? half : kLeastWalkMps) ? speed : b.usual_mps;
    if (w.walks) return w;
    w.face(cell::kPiF * w.draws.either_way());
    (void)w.look_for_way(guide);
    const bool for_long = !b.is_pedestrian || b.has_stood();
    const float least = b.is_pedestrian ? kStandsForS : 1.0F / turning.walks_off_hz();
    const float expected = b.stood_s > least ? b.stood_s : least;
    w.wait_s = for_long ? w.draws.waiting_s(1.0F / expected) : kPausesForS * w.draws.uniform();
    return w;
  }

  /// `dt` seconds on; `blocked`: another mover stands in its way.
  JAYWALK_ANYWHERE void step(const Guide& guide, const TurningModel& turning, bool blocked, float dt) {
    if (!walks) {
      wait_s -= dt;
      if (wait_s > 0.0F) return;
      walks = true;
      face(next_heading);
      return;
    }
    until_turn_s -= dt, until_stop_s -= dt;
    if (blocked || until_stop_s <= 0.0F || faces_surface(guide, x, y, along, react_m)) {
      if (until_stop_s <= 0.0F) until_stop_s = draws.waiting_s(turning.stops_hz());
      return turn_away(guide);
    }
    if (until_turn_s <= 0.0F) {
      until_turn_s = draws.waiting_s(turning.turns_hz());
      face(cell::kPiF * draws.either_way());
    }
    x += along.x * speed * dt;
    y += along.y * speed * dt;
  }
};

inline constexpr int kFutures = 32;             ///< a bit of a word each
inline constexpr std::size_t kMostMovers = 64;  ///< nearest first
inline constexpr float kFutureStepS = 0.2F;
inline constexpr int kFutureSteps = 31;  ///< 0 to 6 s

/// A mover in each future.
using Walkers = std::array<PedestrianSample, kFutures>;

/// A mover out of sight, as it may be by now.
struct OccludedMover {
  std::uint32_t id = 0;
  float age_s = 0.0F, usual_mps = 0.0F;  ///< out of sight for so long; its speed when it walks
  Walkers walkers{};
};

/// Where every mover is in each of the futures, at one time.
struct MoverAt {
  float x[kFutures], y[kFutures];
  float along_x[kFutures], along_y[kFutures];
  std::uint32_t walks;         ///< a bit a future
  float mid_x, mid_y, spread;  ///< a circle that holds the places in all futures
};

/// A pedestrian that has stood for long.
struct StandingDisc {
  float x, y, radius;
};

/// Joint futures of all movers: in each they walk, stop, turn away from walls and from each other, and set out.
/// History in the constructor. Thread: the loop's.
class Futures {
 public:
  Futures() : at_(static_cast<std::size_t>(kFutureSteps) * kMostMovers), walkers_(kMostMovers) {}

  /// Those seen are drawn from what is believed of them; those out of sight are given as they may be.
  void draw(std::span<const MoverBelief> seen, std::span<const OccludedMover> hidden, const TurningModel& turning,
            const Guide& guide, std::uint32_t decision) noexcept;

  /// Properties of a mover that are the same in all futures.
  struct Mover {
    float radius_m = 0.0F;
    bool is_surface = false;   ///< while it stands: the map's, if it was never seen to walk, or one of standing()
    bool is_newcomer = false;  ///< most likely no pedestrian: nothing is owed to it while it stands
    bool has_stood = false;    ///< for long: should it set out, the robot sees that before it drives on
    bool is_hidden = false;    ///< out of sight
  };
  [[nodiscard]] const FixedVector<Mover, kMostMovers>& movers() const { return movers_; }
  /// Pedestrians that have stood for long, where they stand: the same in all futures.
  [[nodiscard]] const FixedVector<StandingDisc, kMostMovers>& standing() const { return standing_; }
  [[nodiscard]] const MoverAt& at(int step, std::size_t mover) const {
    return at_[static_cast<std::size_t>(step) * kMostMovers + mover];
  }

 private:
  void note(int step) noexcept;
  void find_blocked(int step) noexcept;

  std::vector<MoverAt> at_;
  std::vector<Walkers> walkers_;
  FixedVector<Mover, kMostMovers> movers_;  ///< those seen come first
  FixedVector<StandingDisc, kMostMovers> standing_;
  std::uint32_t blocked_[kMostMovers] = {};  ///< a bit a future
};

}  // namespace jaywalk::motion
