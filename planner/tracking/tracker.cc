#include "planner/tracking/tracker.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <vector>

#include "hal/types/trig.h"
#include "planner/mapping/map_entry.h"
#include "planner/scan/scan_points.h"
#include "planner/tracking/detection.h"
#include "planner/tracking/motion_onset.h"
#include "planner/tracking/scene.h"
#include "planner/tracking/target.h"
#include "planner/tracking/tuning.h"

namespace jaywalk {
namespace {
constexpr double kNewView = 0.05;  // least weight of a view that is evaluated, in independent views: saves time

void rename(Detections& detections, std::uint32_t from, std::uint32_t to) {
  for (Detection& c : detections) {
    if (c.track_id == from) c.track_id = to;
  }
}

}  // namespace

/// Its parts, one a step of the update: more fields than a struct has elsewhere.
struct Tracker::State {
  explicit State(const PerceptionConfig& c)
      : mounts{c.robot_from_laser},
        own_body(c.body),
        known(c.known_map),
        still(c.map_side_cells, c.cell_m, c.map_centre),
        entry(still),
        loose(still) {
    mounts.insert(mounts.end(), c.robot_from_others.begin(), c.robot_from_others.end());
    for (const Pose2& mount : mounts) scenes.emplace_back(mount);
    if (known) enter(*known, still, std::nullopt);
  }

  void begin(const LaserScan& scan, const Pose2& map_from_robot) noexcept;
  void predict_all_to(Time stamp) noexcept;
  void forget_targets() noexcept;
  void associate_and_correct() noexcept;
  void judge(const LineOfSight& sight, const Twist2& twist) noexcept;
  void look_at(Vec2 place, PedestrianBelief& belief) noexcept;
  void drop_unseen(const LineOfSight& sight) noexcept;
  void leave_hidden(const Target& target) noexcept;
  void birth() noexcept;
  void enter_still() noexcept;
  void note_history(Target& target) const noexcept;
  void publish() noexcept;

  std::vector<Pose2> mounts;  ///< robot_from_laser, of each scanner
  Footprint own_body;
  std::shared_ptr<const KnownMap> known;
  EvidenceMap still;
  MapEntry entry;
  IsolatedObstacles loose;
  std::vector<Scene> scenes;  ///< of each scanner's newest scan
  Entries entries{};

  FirstScans first_scans;
  PastScans past;
  Targets targets;
  OccludedTracks hidden;
  std::uint32_t last_id = 0;
  double unreported_s = std::numeric_limits<double>::infinity();  ///< since an outside system last told of movers
  Time now = kNever, told = kNever;                               ///< the scan's stamp; the loop's time
  ScanOrder order;
  std::size_t scanner = 0;  ///< of the scan at hand
  Pose2 map_from_first;     ///< at that scan, of the first laser
  double behind_s = 0.0;    ///< 0 or less: so much before `now` it was taken
  /// What it adds to how long things are seen: no more in a second than a second, however many look at them.
  double step_s = 0.0;

  [[nodiscard]] Scene& scene() noexcept { return scenes[scanner]; }

  FixedVector<Track, kMaxTracks> tracks, moving;
  StandingCandidates candidates;
  StandingPedestrians standing;  ///< those of them that are pedestrians
};

void Tracker::State::forget_targets() noexcept {
  targets.clear();
  hidden = {};
  first_scans = {};
}

void Tracker::State::begin(const LaserScan& scan, const Pose2& map_from_robot) noexcept {
  scanner = scan.scanner;
  map_from_first = map_from_robot * mounts[0];
  behind_s = order.behind_s(scan);
  step_s = step_seconds(order.before(), scan.stamp) / static_cast<double>(scenes.size());
  unreported_s += step_s;
  if (behind_s == 0.0) predict_all_to(scan.stamp);
}

void Tracker::State::predict_all_to(Time stamp) noexcept {
  if (now != kNever && to_seconds(now) - to_seconds(stamp) > kForeseenS) forget_targets();
  now = stamp;
  for (Target& target : targets) predict_to(target.estimate, target.existence.given, stamp);
}

void Tracker::State::associate_and_correct() noexcept {
  associate(targets, scene().detections);
  for (Target& target : targets) {
    Observation seen;
    Existence& existence = target.existence;
    const bool found = observe(target.estimate.track, target.appearance, scene().detections, seen);
    existence.scan_counts = found || existence.finder == scanner || existence.misses > 0;
    if (!existence.scan_counts) continue;
    existence.seen_share += kMeanGain * ((found ? 1.0 : 0.0) - existence.seen_share);
    if (found) {
      existence.finder = scanner;
      update_with(target, seen, map_from_first, now);
    } else {
      existence.misses += 1;
    }
  }
}

void Tracker::State::judge(const LineOfSight& sight, const Twist2& twist) noexcept {
  const bool unreliable = first_scans.are_unreliable(twist, now);
  const Surroundings around{sight, past, now, scene().map_from_laser, map_from_first};
  for (Target& target : targets) {
    if (unreliable && !target.existence.given) forget_walk(target, map_from_first, now);
    if (target.existence.scan_counts) judge_motion(target, around, now);
    if (target.confirmed() && target.existence.misses == 0)
      look_at(target.estimate.as_seen.position_in_map, target.existence.pedestrian);
  }
  for (StandingPedestrian& one : candidates) {
    if (!one.followed) look_at(one.position_in_map, one.belief);
  }
}

void Tracker::State::look_at(Vec2 place, PedestrianBelief& belief) noexcept {
  const Scene& scene = this->scene();
  const Vec2 view = scene.map_from_laser.position() - place;
  const double bearing_rad = atan2(view.y, view.x);
  if (belief.new_views(bearing_rad, now) < kNewView) return;
  const auto legs = two_legs_at(place, scene.points, scene.in_map, scene.segments, scene.sweep);
  if (legs) belief.look(*legs, bearing_rad, now);
}

/// A track that moves comes out again; one that had stopped stands, for as long as update_standing() has it do so.
void Tracker::State::leave_hidden(const Target& target) noexcept {
  const Track& seen = target.estimate.as_seen;
  hidden.remember(target);
  if (norm(seen.velocity_in_map) < kStoppedMps)
    (void)candidates.push_back({seen.position_in_map, target.estimate.track.radius_m, seen.last_seen, kNever,
                                target.existence.pedestrian});  // or has as many already
}

void Tracker::State::drop_unseen(const LineOfSight& sight) noexcept {
  for (std::size_t b = targets.size(); b-- > 0;) {
    Target& target = targets[b];
    const bool empty = sight.at(target.estimate.track.position_in_map, kEmptyWithinM) == Sight::kThrough;
    if (target.existence.misses > 0 && empty) target.existence.looked_through_s += step_s;
    if (!is_gone(target.estimate.track, target.existence, now)) continue;
    if (target.estimate.track.moving && !target.existence.given &&
        target.existence.looked_through_s <= kLookedThroughForS)
      leave_hidden(target);
    targets.swap_remove(b);
  }
  hidden.update(sight, now, step_s);
}

void Tracker::State::birth() noexcept {
  if (unreported_s < kForeseenS) return;  // it knows them all; where it falls silent the laser has to do
  Detections& detections = scene().detections;
  for (std::size_t k = 0; k < detections.size(); ++k) {
    if (detections[k].track_id != 0) continue;
    Observation seen;
    if (!observe_new(detections, k, last_id + 1, seen)) continue;
    last_id += 1;
    Target target = born_at(seen.position_in_map, seen.std_m, seen.radius_m, now, last_id);
    note_seen(target.estimate, target.appearance, seen);
    target.existence.finder = scanner;
    target.onset.free_share = seen.in_free_space ? 1.0 : 0.0;
    target.appearance.legs_share = seen.two_legs ? 1.0 : 0.0;
    anchor_here(target.onset, target.estimate.track.position_in_map, target.appearance, map_from_first, now);
    if (hidden.reidentify(target, now)) rename(detections, last_id, target.estimate.track.id);
    admit(targets, target, map_from_first.position());
  }
}

void Tracker::State::enter_still() noexcept {
  const Scene& scene = this->scene();
  const Vec2 laser_in_map = scene.map_from_laser.position();
  const std::size_t count = scene.points.size();
  decide_entries(targets, scene.detections, {scene.in_map.position.data(), count}, still, now, entries);
  const CellIndex low = still.low();
  still.roll_to(map_from_first.position());
  if (known && !(still.low() == low)) enter(*known, still, low);
  entry.enter(still, laser_in_map, scene.in_map.position, entries, count, step_s);
  const Pose2 map_from_robot = scene.map_from_laser * inverse(mounts[scanner]);
  const Transform2 to_map(map_from_robot);
  for (const ScanPoint& end : scene.empty) MapEntry::mark_observed(still, laser_in_map, to_map * end.in_robot);
  free_under(still, map_from_robot, own_body);
}

/// What motion is told of a track's past. A pedestrian known to stand where a track is found is that track.
void Tracker::State::note_history(Target& target) const noexcept {
  Estimate& estimate = target.estimate;
  Track& track = estimate.track;
  const auto is_here = [&](const StandingPedestrian& p) {
    return distance(p.position_in_map, track.position_in_map) < kSamePedestrianM;
  };
  track.is_pedestrian = track.moving || target.existence.pedestrian.is_pedestrian() ||
                        std::any_of(standing.begin(), standing.end(), is_here);
  if (track.still_since != kNever && distance(track.position_in_map, estimate.still_at) <= kStandsWithinM) return;
  estimate.still_at = track.position_in_map;
  track.still_since = told;
}

void Tracker::State::publish() noexcept {
  tracks.clear();
  moving.clear();
  standing.clear();
  for (const StandingPedestrian& one : candidates) {
    if (one.belief.is_pedestrian()) (void)standing.push_back(one);
  }
  for (Target& target : targets) {
    if (!target.confirmed()) continue;
    note_history(target);
    Track track = target.estimate.track;
    track.covariance.pp += target.estimate.off_std_m * target.estimate.off_std_m;
    (void)tracks.push_back(track);  // as many places as bodies
    if (track.moving) (void)moving.push_back(track);
  }
}

Tracker::Tracker(const PerceptionConfig& config) : state_(std::make_unique<State>(config)) {}
Tracker::~Tracker() = default;

void Tracker::update(const LaserScan& scan, const Pose2& map_from_robot, const Twist2& twist, Time told) noexcept {
  State& s = *state_;
  if (scan.stamp == kNever || !finite(map_from_robot)) return;
  s.told = told == kNever ? scan.stamp : told;
  s.begin(scan, map_from_robot);
  s.scene().update(scan, map_from_robot, twist, s.still, s.targets);
  for (Detection& seen : s.scene().detections) seen.late_s += s.behind_s;
  s.associate_and_correct();
  const LineOfSight sight(scan, map_from_robot, s.mounts[s.scanner], twist);
  s.judge(sight, twist);
  s.drop_unseen(sight);
  s.birth();
  s.enter_still();
  update_standing(s.targets, s.still, sight, s.now, s.candidates);
  s.publish();
  s.past.keep(scan, map_from_robot, s.mounts[s.scanner], twist);
}

void Tracker::update_given(const OutsideFix& fix) noexcept {
  State& s = *state_;
  s.unreported_s = 0.0;
  take_given(fix, s.map_from_first.position(), s.targets, s.last_id);
  s.publish();
}

void Tracker::forget_unseen() noexcept {
  State& s = *state_;
  s.loose.begin();
  for (const Scene& scene : s.scenes) s.loose.note_in_view(s.still, scene.in_map, scene.points.size());
  s.loose.forget_unseen(s.still);
}

const EvidenceMap& Tracker::still() const { return state_->still; }
std::span<const Track> Tracker::tracks() const { return {state_->tracks.data(), state_->tracks.size()}; }
std::span<const Track> Tracker::moving() const { return {state_->moving.data(), state_->moving.size()}; }
std::span<const StandingPedestrian> Tracker::standing() const {
  return {state_->standing.data(), state_->standing.size()};
}

}  // namespace jaywalk
