#include "planner/prediction/mover_history.h"

#include <algorithm>
#include <cmath>

#include "planner/tracking/tuning.h"

namespace jaywalk::motion {
namespace {
constexpr double kWithinM = 9.0;  ///< of the robot: more than both come in 6 s
constexpr double kUnknownForS = static_cast<double>(TurningModel::kNewForS);  ///< a body that is new may walk off
constexpr double kSeenForS = 0.5;                                             ///< shorter: noise, no newcomer
constexpr double kWalksFromTheStartS = 1.0;  ///< known to walk sooner than this: it did not stand
constexpr double kUnknownWithinM = 4.0;
constexpr double kLeastBodyM = 0.15, kWidestBodyM = 0.7;
constexpr double kLeastRadiusM = 0.2;
constexpr double kStandingRadiusM = 0.35;  ///< of the disc of a standing pedestrian, its body at most
constexpr double kSteadyVariance = 0.01;   ///< of a velocity to learn from, m2/s2
constexpr double kDropShare = 0.6;         ///< a velocity that falls below this share of the last is not believed,
constexpr int kDrops = 3;                  ///< for so many scans
constexpr double kLookEveryS = 0.5;
constexpr double kLearnWithinM = 8.0;
constexpr double kTurnSine = 0.43;  ///< of 0.45 rad, in half a second: it has turned

double speed_of(const Track& t) { return norm(t.velocity_in_map); }

bool is_as_wide_as_a_body(const Track& t) { return t.radius_m > kLeastBodyM && t.radius_m < kWidestBodyM; }

constexpr std::uint32_t kOccludedPurpose = 2;
constexpr std::size_t kFewest = 4;     ///< of kFutures left: it is somewhere else
constexpr float kSureWithinM = 12.0F;  ///< beams farther off pass beside a leg
constexpr float kBeyondM = 0.2F;       ///< a beam must go on behind a place to show that it is empty
constexpr float kReturnsWithinM = 0.8F;

/// Whether five beams side by side pass over a place.
bool sees_through(const SeenFrom& seen, float x, float y) {
  const LaserScan& scan = *seen.scan;
  const Pose2& laser = seen.map_from_laser;
  const auto heading_rad = static_cast<float>(laser.heading);
  const float dx = x - static_cast<float>(laser.x), dy = y - static_cast<float>(laser.y);
  const float away = std::sqrt(dx * dx + dy * dy);
  const float bearing = cell::wrapped(cell::angle_of(dx, dy) - heading_rad);
  const float beam = (bearing - scan.first_angle_rad) / scan.angle_step_rad;
  if (!(beam >= 2.0F && beam < static_cast<float>(scan.beam_count) - 3.0F) || away > kSureWithinM) return false;
  const auto middle = static_cast<std::size_t>(beam + 0.5F);
  for (std::size_t k = middle - 2; k <= middle + 2; ++k) {
    const bool passes = scan.is_hit(k) ? scan.range_m[k] > away + kBeyondM : scan.found_nothing(k);
    if (!passes) return false;
  }
  return true;
}

bool sees_through(const OfEach<SeenFrom>& scans, float x, float y) {
  for (const SeenFrom& seen : scans) {
    if (sees_through(seen, x, y)) return true;
  }
  return false;
}

}  // namespace

void MoverHistory::update(const Seen& seen) noexcept {
  const double dt = before_ == kNever ? 0.0 : std::clamp(to_seconds(seen.now - before_), 0.0, 0.5);
  before_ = seen.now;
  for (History& m : histories_) m.here = false;
  for (const Track& track : seen.tracks) {
    History& m = history_of(track, seen);
    note(m, track);
    count_newcomer(m, to_seconds(seen.now - m.first_seen), kUnknownForS);
    if (track.moving && track.covariance.vv < kSteadyVariance && speed_of(track) > kWalksMps) {
      m.usual_mps += (m.usual_mps == 0.0 ? 1.0 : 0.05) * (speed_of(track) - m.usual_mps);
      if (m.steady_s > 1.0) turning_.usual_mps += 0.01F * (static_cast<float>(speed_of(track)) - turning_.usual_mps);
      m.steady_s += dt;
    } else {
      m.steady_s = 0.0;
    }
    learn(m, seen);
  }
  forget_gone(seen);
  occluded_.update(static_cast<float>(dt), seen.scans, turning_, seen.guide);
  believe(seen);
}

MoverHistory::History& MoverHistory::history_of(const Track& track, const Seen& seen) noexcept {
  for (History& m : histories_) {
    if (m.track.id == track.id) return m;
  }
  if (histories_.full()) histories_.swap_remove(0);  // cannot be: the tracker keeps no more tracks than this
  History fresh;
  fresh.track = track;
  fresh.first_seen = fresh.looked = seen.now;
  fresh.came_out = occluded_.take(track.position_in_map, fresh.usual_mps);
  occluded_.remove(track.id);
  (void)histories_.push_back(fresh);
  return histories_.back();
}

void MoverHistory::note(History& m, const Track& track) noexcept {
  const double before = norm(m.velocity);
  const bool drops = before > 0.25 && speed_of(track) < kDropShare * before && m.drops < kDrops;
  m.drops = drops ? m.drops + 1 : 0;
  if (!drops) m.velocity = track.velocity_in_map;
  m.track = track;
  m.here = true;
}

/// Once of each that was seen to stand first: has it walked off by now, or was it furniture?
void MoverHistory::count_newcomer(History& m, double known_s, double enough_s) noexcept {
  if (m.counted || !is_as_wide_as_a_body(m.track) || !(m.is_pedestrian() || known_s >= enough_s)) return;
  m.counted = true;
  if (m.is_pedestrian() && known_s < kWalksFromTheStartS) return;
  turning_.newcomers += 1.0F;
  turning_.walked_off += m.is_pedestrian() ? 1.0F : 0.0F;
}

/// Every half a second: did a pedestrian that walked in the open turn, or stop?
void MoverHistory::learn(History& m, const Seen& seen) noexcept {
  if (to_seconds(seen.now - m.looked) < kLookEveryS) return;
  const Look now{m.track.position_in_map, m.track.velocity_in_map};
  const double was = norm(m.before.velocity), is = norm(now.velocity);
  if (m.looks >= 2 && was > kWalksMps && m.track.moving && in_the_open(m, seen)) {
    turning_.watched_s += static_cast<float>(kLookEveryS);
    const bool bent = std::fabs(cross(m.before.velocity, now.velocity)) > kTurnSine * was * is ||
                      dot(m.before.velocity, now.velocity) < 0.0;
    if (m.rests == 0 && is > 0.5 * was && bent) turning_.turns += 1.0F, m.rests = 3;
    if (m.rests == 0 && is < 0.3 * was) turning_.stops += 1.0F, m.rests = 3;
  }
  m.rests = std::max(0, m.rests - 1);
  m.before = m.last;
  m.last = now;
  ++m.looks;
  m.looked = seen.now;
}

/// Nothing that would make it turn: neither wall nor mover nor robot near where it was.
bool MoverHistory::in_the_open(const History& m, const Seen& seen) const noexcept {
  const Vec2 place = m.before.place, robot = seen.map_from_robot.position();
  if (distance(robot, m.track.position_in_map) > kLearnWithinM || distance(robot, place) < 1.5) return false;
  const double speed = norm(m.before.velocity);
  const cell::Heading along{static_cast<float>(m.before.velocity.x / speed),
                            static_cast<float>(m.before.velocity.y / speed)};
  if (faces_surface(seen.guide, static_cast<float>(place.x), static_cast<float>(place.y), along, 1.1F)) return false;
  return std::none_of(histories_.begin(), histories_.end(), [&](const History& o) {
    return o.track.id != m.track.id && distance(o.track.position_in_map, place) < 1.6;
  });
}

void MoverHistory::forget_gone(const Seen& seen) noexcept {
  for (std::size_t k = histories_.size(); k-- > 0;) {
    History& m = histories_[k];
    if (m.here) continue;
    count_newcomer(m, to_seconds(m.track.stamp - m.first_seen), kSeenForS);
    if (m.is_pedestrian() && m.usual_mps > 0.0) occluded_.add(belief_of(m, seen.now), turning_, seen.guide);
    histories_.swap_remove(k);
  }
}

bool MoverHistory::may_walk(const History& m, const Seen& seen) const noexcept {
  if (m.is_pedestrian()) return true;
  const Vec2 place = m.track.position_in_map;
  return to_seconds(seen.now - m.first_seen) < kUnknownForS && is_as_wide_as_a_body(m.track) &&
         distance(place, seen.map_from_robot.position()) < kUnknownWithinM &&
         !seen.still.stands(seen.still.cell_at(place));
}

MoverBelief MoverHistory::belief_of(const History& m, Time now) const noexcept {
  const Track& t = m.track;
  const double p = std::sqrt(std::max(t.covariance.pp, 0.0)), v = std::sqrt(std::max(t.covariance.vv, 0.0));
  const auto f = [](double value) { return static_cast<float>(value); };
  return {.id = t.id,
          .x = f(t.position_in_map.x),
          .y = f(t.position_in_map.y),
          .vx = f(m.velocity.x),
          .vy = f(m.velocity.y),
          .position_std = f(p),
          .velocity_std = f(v),
          .correlation = f(std::clamp(t.covariance.pv / (p * v + 1e-9), -0.99, 0.99)),
          .late_s = f(std::clamp(to_seconds(now - t.stamp), 0.0, 1.0)),
          .radius_m = f(std::clamp(t.radius_m, kLeastRadiusM, kWidestBodyM)),
          .usual_mps = m.usual_mps > 0.1 ? f(m.usual_mps) : turning_.usual_mps,
          .is_pedestrian = m.is_pedestrian(),
          .newcomer = !m.is_pedestrian(),
          .stood_s = t.still_since == kNever ? 0.0F : f(to_seconds(now - t.still_since))};
}

void MoverHistory::believe(const Seen& seen) noexcept {
  const Vec2 robot = seen.map_from_robot.position();
  beliefs_.clear();
  masked_.clear();
  standing_.clear();
  for (const History& m : histories_) {
    if (m.is_pedestrian()) {
      (void)masked_.push_back({m.track.position_in_map, m.track.radius_m});
    }
    if (distance(m.track.position_in_map, robot) < kWithinM && may_walk(m, seen)) {
      (void)beliefs_.push_back(belief_of(m, seen.now));
    }
  }
  add_standing(seen);
  const auto away = [&robot](const MoverBelief& b) {
    const double dx = static_cast<double>(b.x) - robot.x, dy = static_cast<double>(b.y) - robot.y;
    return dx * dx + dy * dy;
  };
  std::sort(beliefs_.begin(), beliefs_.end(), [&away](const MoverBelief& a, const MoverBelief& b) {
    return away(a) != away(b) ? away(a) < away(b) : a.id < b.id;
  });
  for (const MoverBelief& b : beliefs_)
    if (b.stands())
      (void)standing_.push_back(
          {{static_cast<double>(b.x), static_cast<double>(b.y)}, static_cast<double>(b.radius_m)});
}

/// Standing pedestrians that are no tracks: they may start to walk as well.
void MoverHistory::add_standing(const Seen& seen) noexcept {
  std::uint32_t number = 0;
  for (const StandingPedestrian& pedestrian : seen.standing) {
    const Vec2 place = pedestrian.position_in_map;
    const std::uint32_t id = 0x80000000U + number++;
    const bool known = std::any_of(histories_.begin(), histories_.end(), [&place](const History& m) {
      return distance(m.track.position_in_map, place) < kSamePedestrianM;
    });
    if (known || distance(place, seen.map_from_robot.position()) > kWithinM) continue;
    (void)beliefs_.push_back(
        {.id = id,
         .x = static_cast<float>(place.x),
         .y = static_cast<float>(place.y),
         .position_std = 0.1F,
         .velocity_std = 0.02F,
         .radius_m = static_cast<float>(std::min(kStandingRadiusM, pedestrian.radius_m)),
         .usual_mps = turning_.usual_mps,
         .is_pedestrian = true,  // its disc is a body, which the map has the shins of
         .stood_s = static_cast<float>(std::max(0.0, to_seconds(age(pedestrian.since, seen.now))))});
  }
}

void OccludedMovers::add(const MoverBelief& belief, const TurningModel& turning, const Guide& guide) noexcept {
  if (!movers_.push_back({.id = belief.id, .usual_mps = belief.usual_mps})) return;
  for (std::uint32_t k = 0; k < kFutures; ++k) {
    movers_.back().walkers[k] =
        PedestrianSample::drawn(belief, turning, guide, cell::Draws({0, kOccludedPurpose, belief.id, k}));
  }
}

void OccludedMovers::remove(std::uint32_t id) noexcept {
  for (std::size_t k = movers_.size(); k-- > 0;) {
    if (movers_[k].id == id) movers_.swap_remove(k);
  }
}

bool OccludedMovers::take(Vec2 place, double& usual_mps) noexcept {
  std::size_t best = movers_.size();
  float least = kReturnsWithinM * kReturnsWithinM;
  for (std::size_t k = 0; k < movers_.size(); ++k) {
    for (const PedestrianSample& w : movers_[k].walkers) {
      const float dx = w.x - static_cast<float>(place.x), dy = w.y - static_cast<float>(place.y);
      if (dx * dx + dy * dy < least) least = dx * dx + dy * dy, best = k;
    }
  }
  if (best == movers_.size()) return false;
  usual_mps = static_cast<double>(movers_[best].usual_mps);
  movers_.swap_remove(best);
  return true;
}

void OccludedMovers::update(float dt, const OfEach<SeenFrom>& scans, const TurningModel& turning,
                            const Guide& guide) noexcept {
  for (std::size_t k = movers_.size(); k-- > 0;) {
    OccludedMover& mover = movers_[k];
    std::size_t kept = 0;
    for (PedestrianSample w : mover.walkers) {
      w.step(guide, turning, false, dt);
      const bool gone = sees_through(scans, w.x, w.y) || guide.distance(w.x, w.y) < 0.1F;
      if (!gone) mover.walkers[kept++] = w;
    }
    mover.age_s += dt;
    if (kept < kFewest || mover.age_s > static_cast<float>(kRememberedS)) {
      movers_.swap_remove(k);
      continue;
    }
    for (std::size_t f = kept; f < kFutures; ++f) {  // the rest copy those left, and draw on their own from here
      PedestrianSample& w = mover.walkers[f] = mover.walkers[f % kept];
      w.draws = cell::Draws({cell::Draws(w.draws).bits(), kOccludedPurpose, mover.id, static_cast<std::uint32_t>(f)});
    }
  }
}

}  // namespace jaywalk::motion
