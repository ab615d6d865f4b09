#include "planner/perception/tracker.h"

#include <algorithm>
#include <cmath>

#include "planner/perception/association.h"
#include "planner/perception/bodies.h"
#include "planner/perception/clusters.h"
#include "planner/perception/entries.h"
#include "planner/perception/first_scans.h"
#include "planner/perception/ground.h"
#include "planner/perception/hidden_walkers.h"
#include "planner/perception/kalman.h"
#include "planner/perception/map_entry.h"
#include "planner/perception/motion_judgement.h"
#include "planner/perception/segments.h"
#include "planner/perception/self_mask.h"

namespace jaywalk {
namespace {

constexpr double kGivenAccelStd = 0.5;        // the paper's movers keep their speed and seldom turn
constexpr double kLongestStepS = 1.0;         // scans farther apart than this tell no velocity
constexpr double kPathBreaksS = 0.4;          // unseen so long, a body may be another
constexpr double kUnseenForS = 2.0;           // a hidden one is believed in this long, and no longer than it was seen
constexpr double kWalksUnseenForS = 1.0;      // who walks; after that he may have turned or stopped: HiddenWalkers
constexpr double kTentativeUnseenForS = 0.6;  // one not believed yet: dark cloth returns nothing for half a second
constexpr double kGivenUnseenForS = 1.0;      // one from outside, this long after its last report
constexpr double kSeenGain = 0.15;            // of the running mean of how often a body was seen
constexpr double kFreeGain = 0.3;             // of the running mean of how free the ground under a body was
constexpr double kNoiseGain = 0.075;          // a scan: a second teaches how noisy a body is
constexpr double kMostNoise = 25.0;           // times the variance expected, or as small a part of it
constexpr double kMostSurprise = 16.0;        // that one scan teaches: more is another's place
constexpr double kRadiusGain = 0.2;           // of the running mean of a body's radius

bool finite(const Pose2& pose) { return std::isfinite(pose.x) && std::isfinite(pose.y) && std::isfinite(pose.heading); }

/// Steers the measurement noise to where surprises are 2 on average, whatever the body is: a disc is seen to a
/// centimetre, a pair of legs sways.
void learn_noise(Body& body) {
  const double wanted = 0.5 * std::min(body.track.surprise, kMostSurprise) - 1.0;
  body.noise = std::clamp(body.noise * (1.0 + kNoiseGain * wanted), 1.0 / kMostNoise, kMostNoise);
}

/// What is kept of how a body was seen last.
void note_sight(Body& body, const Observation& seen) {
  body.outline_in_map = seen.outline_in_map;
  body.beams = seen.beams;
  body.whole = seen.whole;
  body.hidden_side = seen.hidden_side;
  body.on_wall = seen.on_wall;
  body.edge_m = seen.edge_m;
}

void rename(Clusters& clusters, std::uint32_t from, std::uint32_t to) {
  for (Cluster& c : clusters) {
    if (c.track_id == from) c.track_id = to;
  }
}

double step_seconds(Time from, Time to) {
  if (from == kNever || to <= from) return 0.0;
  return std::min(to_seconds(to - from), kLongestStepS);
}

}  // namespace

struct Tracker::State {
  explicit State(const PerceptionConfig& c)
      : config(c), still(c.map_side_cells, c.cell_m, c.map_centre), entry(still) {}

  void predict_to(Time now) noexcept;
  void look(const LaserScan& scan, const Pose2& map_from_robot, const Twist2& twist) noexcept;
  void drop_own_points() noexcept;
  void associate_and_correct() noexcept;
  void take(Body& body, const Observation& seen) noexcept;
  void judge(const LineOfSight& sight, const Twist2& twist) noexcept;
  void drop_unseen(const LineOfSight& sight) noexcept;
  [[nodiscard]] bool gone(const Body& body) const noexcept;
  void birth() noexcept;
  void enter_still() noexcept;
  void publish() noexcept;

  PerceptionConfig config;
  EvidenceMap still;
  MapEntry entry;

  SelfMask self_mask;
  ScanProjection projection;
  ScanPoints points;
  PointsInMap in_map;
  Segments segments;
  Clusters clusters;
  Entries entries{};
  Pose2 map_from_laser;

  FirstScans first_scans;
  Bodies bodies;
  HiddenWalkers hidden;
  std::uint32_t last_id = 0;
  bool movers_are_given = false;
  Time now = kNever;
  double step_s = 0.0;

  FixedVector<Track, kMaxTracks> tracks, moving;
};

void Tracker::State::predict_to(Time stamp) noexcept {
  step_s = step_seconds(now, stamp);
  now = stamp;
  for (Body& body : bodies) {
    const double dt = step_seconds(body.track.stamp, stamp);
    if (body.given) {
      predict(body.track, dt, kGivenAccelStd);
    } else {
      body.models.predict(body.track, dt);
    }
    body.track.stamp = std::max(body.track.stamp, stamp);
  }
}

void Tracker::State::look(const LaserScan& scan, const Pose2& map_from_robot, const Twist2& twist) noexcept {
  self_mask.learn(scan, map_from_robot.heading);
  projection.project(scan, config.robot_from_laser, twist, points);
  drop_own_points();
  const Sweep sweep = sweep_of(scan);
  begin_at_a_jump(sweep, points);
  map_from_laser = map_from_robot * config.robot_from_laser;
  const Transform2 to_map(map_from_robot);
  for (std::size_t k = 0; k < points.size(); ++k) {
    in_map.position[k] = to_map * points[k].in_robot;
    in_map.ground[k] = ground_at(still, in_map.position[k], points[k].range_m);
  }
  cut_at_jumps(points, sweep, segments);
  cut_between(bodies, in_map, segments);
  find_clusters(points, in_map, segments, sweep, map_from_laser.position(), clusters);
}

void Tracker::State::drop_own_points() noexcept {
  std::size_t kept = 0;
  for (std::size_t k = 0; k < points.size(); ++k) {
    if (!self_mask.on_robot(points[k].beam)) points[kept++] = points[k];
  }
  points.truncate(kept);
}

void Tracker::State::take(Body& body, const Observation& seen) noexcept {
  Track& track = body.track;
  move_all(body, seen.was_off);
  const double std_m = seen.std_m * std::sqrt(body.noise);
  track.surprise = gate_distance2(track, seen.position_in_map, std_m);
  learn_noise(body);
  body.models.correct(track, seen.position_in_map, std_m);
  track.radius_m += kRadiusGain * (seen.radius_m - track.radius_m);
  if (seen.arc_m > 0.0) body.arc_m += (body.arc_m > 0.0 ? kRadiusGain : 1.0) * (seen.arc_m - body.arc_m);
  track.hits += 1;
  body.misses = 0;
  const bool after_a_gap = to_seconds(now - body.track.last_seen) > kPathBreaksS;
  if (after_a_gap) body.path.clear();
  track.last_seen = now;
  body.path.add(now, {seen.position_in_map, seen.width_m, seen.spacing_m, seen.whole});
  note_sight(body, seen);
  if (after_a_gap && !track.moving) anchor_here(body, map_from_laser, now);  // what stood elsewhere may be another
  body.free_share += std::max(kFreeGain, 1.0 / body.track.hits) * ((seen.in_free_space ? 1.0 : 0.0) - body.free_share);
  body.looked_through_s = 0.0;
  body.as_seen = track;
}

void Tracker::State::associate_and_correct() noexcept {
  associate(bodies, clusters);
  for (Body& body : bodies) {
    Observation seen;
    const bool found = observe(body, clusters, seen);
    body.seen_share += kSeenGain * ((found ? 1.0 : 0.0) - body.seen_share);
    if (found) {
      take(body, seen);
    } else {
      body.misses += 1;
    }
  }
}

void Tracker::State::judge(const LineOfSight& sight, const Twist2& twist) noexcept {
  const bool misled = first_scans.mislead(twist, now);
  const Surroundings around{sight, still, map_from_laser};
  for (Body& body : bodies) {
    if (misled && !body.given) forget_walk(body, map_from_laser, now);
    judge_motion(body, around, now);
  }
}

bool Tracker::State::gone(const Body& body) const noexcept {
  const double unseen_s = to_seconds(now - body.track.last_seen);
  if (body.given) return unseen_s > kGivenUnseenForS;
  if (body.looked_through_s > kLookedThroughForS) return true;
  if (!body.confirmed()) return unseen_s > kTentativeUnseenForS;
  const double known_s = to_seconds(body.track.last_seen - body.born);
  return unseen_s > std::min(body.track.moving ? kWalksUnseenForS : kUnseenForS, known_s);
}

void Tracker::State::drop_unseen(const LineOfSight& sight) noexcept {
  for (std::size_t b = bodies.size(); b-- > 0;) {
    Body& body = bodies[b];
    const bool empty = sight.at(body.track.position_in_map, kEmptyWithinM) == Sight::kThrough;
    if (body.misses > 0 && empty) body.looked_through_s += step_s;
    if (!gone(body)) continue;
    if (body.track.moving && !body.given && body.looked_through_s <= kLookedThroughForS) hidden.remember(body);
    bodies.swap_remove(b);
  }
  hidden.wait(sight, now, step_s);
}

void Tracker::State::birth() noexcept {
  if (movers_are_given) return;
  for (std::size_t k = 0; k < clusters.size(); ++k) {
    if (clusters[k].track_id != 0) continue;
    Observation seen;
    if (!observe_new(clusters, k, last_id + 1, seen)) continue;
    last_id += 1;
    Body body = born_at(seen.position_in_map, seen.std_m, seen.radius_m, now, last_id);
    note_sight(body, seen);
    body.free_share = seen.in_free_space ? 1.0 : 0.0;
    anchor_here(body, map_from_laser, now);
    if (hidden.return_as(body, now)) rename(clusters, last_id, body.track.id);
    admit(bodies, body, map_from_laser.position());
  }
}

void Tracker::State::enter_still() noexcept {
  decide_entries(bodies, clusters, in_map, points.size(), still, now, entries);
  still.roll_to(map_from_laser.position());
  entry.enter(still, map_from_laser.position(), in_map.position, entries, points.size(), step_s);
}

void Tracker::State::publish() noexcept {
  tracks.clear();
  moving.clear();
  for (const Body& body : bodies) {
    if (!body.confirmed()) continue;
    (void)tracks.push_back(body.track);  // as many places as bodies
    if (body.track.moving) (void)moving.push_back(body.track);
  }
}

Tracker::Tracker(const PerceptionConfig& config) : state_(std::make_unique<State>(config)) {}
Tracker::~Tracker() = default;

void Tracker::update(const LaserScan& scan, const Pose2& map_from_robot, const Twist2& twist) noexcept {
  State& s = *state_;
  if (scan.stamp == kNever || !finite(map_from_robot)) return;
  s.predict_to(scan.stamp);
  s.look(scan, map_from_robot, twist);
  s.associate_and_correct();
  const LineOfSight sight(scan, map_from_robot, s.config.robot_from_laser, twist);
  s.judge(sight, twist);
  s.drop_unseen(sight);
  s.birth();
  s.enter_still();
  s.publish();
}

void Tracker::update_given(const OutsideFix& fix) noexcept {
  State& s = *state_;
  s.movers_are_given = true;
  const double std_m = std::max(fix.mover_std_m, 1e-3);
  for (const ObservedMover& mover : fix.movers) {
    const auto known = std::find_if(s.bodies.begin(), s.bodies.end(),
                                    [&](const Body& b) { return b.given && b.given_id == mover.id; });
    if (known == s.bodies.end()) {
      Body body = born_at(mover.position_in_map, std_m, mover.radius_m, fix.stamp, ++s.last_id);
      body.given = true;
      body.given_id = mover.id;
      body.track.moving = true;
      admit(s.bodies, body, s.map_from_laser.position());
      continue;
    }
    predict(known->track, step_seconds(known->track.stamp, fix.stamp), kGivenAccelStd);
    known->track.stamp = std::max(known->track.stamp, fix.stamp);
    correct(known->track, mover.position_in_map, std_m);
    known->track.hits += 1;
    known->track.last_seen = fix.stamp;
  }
  s.publish();
}

const EvidenceMap& Tracker::still() const { return state_->still; }
std::span<const Track> Tracker::tracks() const { return {state_->tracks.data(), state_->tracks.size()}; }
std::span<const Track> Tracker::moving() const { return {state_->moving.data(), state_->moving.size()}; }

}  // namespace jaywalk
