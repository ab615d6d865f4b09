#include "planner/tracking/tracker.h"

#include <algorithm>
#include <limits>

#include "planner/tracking/absence.h"
#include "planner/tracking/association.h"
#include "planner/tracking/entries.h"
#include "planner/scan/first_scans.h"
#include "planner/tracking/given_movers.h"
#include "planner/tracking/hidden_walkers.h"
#include "planner/mapping/loose_things.h"
#include "planner/mapping/map_entry.h"
#include "planner/tracking/motion_judgement.h"
#include "planner/tracking/prediction.h"
#include "planner/tracking/scene.h"
#include "planner/tracking/sighting.h"
#include "planner/tracking/standers.h"

namespace jaywalk {
namespace {

void rename(Clusters& clusters, std::uint32_t from, std::uint32_t to) {
  for (Cluster& c : clusters) {
    if (c.track_id == from) c.track_id = to;
  }
}

}  // namespace

struct Tracker::State {
  explicit State(const PerceptionConfig& c)
      : robot_from_laser(c.robot_from_laser),
        own_body(c.body),
        still(c.map_side_cells, c.cell_m, c.map_centre),
        entry(still),
        loose(still),
        scene(c.robot_from_laser) {
    if (c.known_map != nullptr) enter(*c.known_map, still);
  }

  void predict_all_to(Time stamp) noexcept;
  void forget_bodies() noexcept;
  void associate_and_correct() noexcept;
  void judge(const LineOfSight& sight, const Twist2& twist) noexcept;
  void drop_unseen(const LineOfSight& sight) noexcept;
  void leave_hidden(const Body& body) noexcept;
  void birth() noexcept;
  void enter_still() noexcept;
  void publish() noexcept;

  Pose2 robot_from_laser;
  Footprint own_body;
  EvidenceMap still;
  MapEntry entry;
  LooseThings loose;
  Scene scene;
  Entries entries{};

  FirstScans first_scans;
  Bodies bodies;
  HiddenWalkers hidden;
  std::uint32_t last_id = 0;
  double unreported_s = std::numeric_limits<double>::infinity();  ///< since an outside system last told of movers
  Time now = kNever;
  double step_s = 0.0;

  FixedVector<Track, kMaxTracks> tracks, moving;
  Standers standing;
};

void Tracker::State::forget_bodies() noexcept {
  bodies.clear();
  hidden = {};
  first_scans = {};
}

void Tracker::State::predict_all_to(Time stamp) noexcept {
  if (now != kNever && to_seconds(now) - to_seconds(stamp) > kForeseenS) forget_bodies();
  step_s = step_seconds(now, stamp);
  unreported_s += step_s;
  now = stamp;
  for (Body& body : bodies) predict_to(body, stamp);
}

void Tracker::State::associate_and_correct() noexcept {
  associate(bodies, scene.clusters);
  for (Body& body : bodies) {
    Observation seen;
    const bool found = observe(body, scene.clusters, seen);
    body.seen_share += kMeanGain * ((found ? 1.0 : 0.0) - body.seen_share);
    if (found) {
      take_sight(body, seen, scene.map_from_laser, now);
    } else {
      body.misses += 1;
    }
  }
}

void Tracker::State::judge(const LineOfSight& sight, const Twist2& twist) noexcept {
  const bool misled = first_scans.mislead(twist, now);
  const Surroundings around{sight, still, scene.map_from_laser};
  for (Body& body : bodies) {
    if (misled && !body.given) forget_walk(body, scene.map_from_laser, now);
    judge_motion(body, around, now);
  }
}

/// Walkers come out again, and who had stopped stands there (note_standers() sees to it, and to how long).
void Tracker::State::leave_hidden(const Body& body) noexcept {
  const Track& seen = body.as_seen;
  hidden.remember(body);
  if (norm(seen.velocity_in_map) < kStoppedMps)
    (void)standing.push_back({seen.position_in_map, body.track.radius_m, seen.last_seen});  // or has as many already
}

void Tracker::State::drop_unseen(const LineOfSight& sight) noexcept {
  for (std::size_t b = bodies.size(); b-- > 0;) {
    Body& body = bodies[b];
    const bool empty = sight.at(body.track.position_in_map, kEmptyWithinM) == Sight::kThrough;
    if (body.misses > 0 && empty) body.looked_through_s += step_s;
    if (!gone(body, now)) continue;
    if (body.track.moving && !body.given && body.looked_through_s <= kLookedThroughForS) leave_hidden(body);
    bodies.swap_remove(b);
  }
  hidden.wait(sight, now, step_s);
}

void Tracker::State::birth() noexcept {
  if (unreported_s < kForeseenS) return;  // it knows them all; where it falls silent the laser has to do
  Clusters& clusters = scene.clusters;
  for (std::size_t k = 0; k < clusters.size(); ++k) {
    if (clusters[k].track_id != 0) continue;
    Observation seen;
    if (!observe_new(clusters, k, last_id + 1, seen)) continue;
    last_id += 1;
    Body body = born_at(seen.position_in_map, seen.std_m, seen.radius_m, now, last_id);
    note_sight(body, seen);
    body.free_share = seen.in_free_space ? 1.0 : 0.0;
    body.legs_share = seen.two_legs ? 1.0 : 0.0;
    anchor_here(body, scene.map_from_laser, now);
    if (hidden.return_as(body, now)) rename(clusters, last_id, body.track.id);
    admit(bodies, body, scene.map_from_laser.position());
  }
}

void Tracker::State::enter_still() noexcept {
  const Vec2 laser_in_map = scene.map_from_laser.position();
  const std::size_t count = scene.points.size();
  decide_entries(bodies, scene.clusters, scene.in_map, count, still, now, entries);
  still.roll_to(laser_in_map);
  entry.enter(still, laser_in_map, scene.in_map.position, entries, count, step_s);
  const Pose2 map_from_robot = scene.map_from_laser * inverse(robot_from_laser);
  const Transform2 to_map(map_from_robot);
  for (const ScanPoint& end : scene.empty) MapEntry::mark_observed(still, laser_in_map, to_map * end.in_robot);
  free_under(still, map_from_robot, own_body);
}

void Tracker::State::publish() noexcept {
  tracks.clear();
  moving.clear();
  for (const Body& body : bodies) {
    if (!body.confirmed()) continue;
    Track track = body.track;
    track.covariance.pp += body.off_std_m * body.off_std_m;
    (void)tracks.push_back(track);  // as many places as bodies
    if (track.moving) (void)moving.push_back(track);
  }
}

Tracker::Tracker(const PerceptionConfig& config) : state_(std::make_unique<State>(config)) {}
Tracker::~Tracker() = default;

void Tracker::update(const LaserScan& scan, const Pose2& map_from_robot, const Twist2& twist) noexcept {
  State& s = *state_;
  if (scan.stamp == kNever || !finite(map_from_robot)) return;
  s.predict_all_to(scan.stamp);
  s.scene.look(scan, map_from_robot, twist, s.still, s.bodies);
  s.associate_and_correct();
  const LineOfSight sight(scan, map_from_robot, s.robot_from_laser, twist);
  s.judge(sight, twist);
  s.drop_unseen(sight);
  s.birth();
  s.enter_still();
  s.publish();
  note_standers(s.bodies, s.still, sight, s.now, s.standing);
}

void Tracker::update_given(const OutsideFix& fix) noexcept {
  State& s = *state_;
  s.unreported_s = 0.0;
  take_given(fix, s.scene.map_from_laser.position(), s.bodies, s.last_id);
  s.publish();
}

void Tracker::forget_unseen() noexcept {
  State& s = *state_;
  s.loose.forget_unseen(s.still, s.scene.in_map, s.scene.points.size());
}

const EvidenceMap& Tracker::still() const { return state_->still; }
std::span<const Track> Tracker::tracks() const { return {state_->tracks.data(), state_->tracks.size()}; }
std::span<const Track> Tracker::moving() const { return {state_->moving.data(), state_->moving.size()}; }
std::span<const Stander> Tracker::standing() const { return {state_->standing.data(), state_->standing.size()}; }

bool Tracker::hides_somebody(Vec2 place, double within_m) const noexcept {
  const State& s = *state_;
  const auto lost_near = [&](Vec2 seen_at, Time last_seen) {
    const double unseen_s = to_seconds(s.now - last_seen);  // of who is in the map by now nobody keeps count
    return unseen_s > kLookedThroughForS && unseen_s < kRememberedS && distance(seen_at, place) < within_m;
  };
  return std::any_of(s.standing.begin(), s.standing.end(),
                     [&](const Stander& him) { return lost_near(him.position_in_map, him.last_seen); }) ||
         std::any_of(s.bodies.begin(), s.bodies.end(),
                     [&](const Body& body) {
                       return body.somebody && lost_near(body.as_seen.position_in_map, body.as_seen.last_seen);
                     }) ||
         s.hidden.lost_near(place, within_m);
}

}  // namespace jaywalk
