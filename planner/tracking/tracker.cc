#include "planner/tracking/tracker.h"

#include <algorithm>
#include <optional>

#include "planner/tracking/motion_onset.h"
#include "planner/tracking/tuning.h"

namespace jaywalk {
namespace {
constexpr double kNewView = 0.05;  // least weight of a view that is evaluated, in independent views: saves time

}  // namespace

Tracker::Tracker(const PerceptionConfig& c)
    : config_(c), still_(c.map_side_cells, c.cell_m, c.map_centre), entry_(still_), loose_(still_) {
  scenes_.emplace_back(c.robot_from_laser);
  for (const Pose2& mount : c.robot_from_others) scenes_.emplace_back(mount);
  if (c.known_map) enter(*c.known_map, still_, std::nullopt);
}

void Tracker::begin(const LaserScan& scan, const Pose2& map_from_robot) noexcept {
  scanner_ = scan.scanner;
  map_from_first_ = map_from_robot * config_.robot_from_laser;
  behind_s_ = order_.behind_s(scan);
  step_s_ = step_seconds(order_.before(), scan.stamp) / static_cast<double>(scenes_.size());
  unreported_s_ += step_s_;
  if (behind_s_ == 0.0) predict_all_to(scan.stamp);
}

void Tracker::predict_all_to(Time stamp) noexcept {
  if (now_ != kNever && to_seconds(now_) - to_seconds(stamp) > kForeseenS) {  // a clock that was set back
    targets_.clear();
    hidden_ = {};
    first_scans_ = {};
  }
  now_ = stamp;
  for (Target& target : targets_) predict_to(target.estimate, target.existence.given, stamp);
}

void Tracker::associate_and_correct() noexcept {
  associate(targets_, scene().detections);
  for (Target& target : targets_) {
    Observation seen;
    Existence& existence = target.existence;
    const bool found = observe(target.estimate.track, target.appearance, scene().detections, seen);
    existence.scan_counts = found || existence.finder == scanner_ || existence.misses > 0;
    if (!existence.scan_counts) continue;
    existence.seen_share += kMeanGain * ((found ? 1.0 : 0.0) - existence.seen_share);
    if (found) {
      existence.finder = scanner_;
      update_with(target, seen, map_from_first_, now_);
    } else {
      existence.misses += 1;
    }
  }
}

void Tracker::judge(const LineOfSight& sight, const Twist2& twist) noexcept {
  const bool unreliable = first_scans_.are_unreliable(twist, now_);
  const Surroundings around{sight, past_, now_, scene().map_from_laser, map_from_first_};
  for (Target& target : targets_) {
    if (unreliable && !target.existence.given) forget_walk(target, map_from_first_, now_);
    if (target.existence.scan_counts) judge_motion(target, around);
    if (target.confirmed() && target.existence.misses == 0)
      look_at(target.estimate.as_seen.position_in_map, target.existence.pedestrian);
  }
  for (StandingPedestrian& one : candidates_) {
    if (!one.followed) look_at(one.position_in_map, one.belief);
  }
}

void Tracker::look_at(Vec2 place, PedestrianBelief& belief) noexcept {
  const Scene& scene = this->scene();
  const Vec2 view = scene.map_from_laser.position() - place;
  const double bearing_rad = atan2(view.y, view.x);
  if (belief.new_views(bearing_rad, now_) < kNewView) return;
  const auto legs = two_legs_at(place, scene);
  if (legs) belief.look(*legs, bearing_rad, now_);
}

/// A track that moves comes out again; one that had stopped stands, for as long as update_standing() has it do so.
void Tracker::leave_hidden(const Target& target) noexcept {
  const Track& seen = target.estimate.as_seen;
  hidden_.remember(target);
  if (norm(seen.velocity_in_map) < kStoppedMps)
    (void)candidates_.push_back({seen.position_in_map, target.estimate.track.radius_m, seen.last_seen,
                                 target.estimate.track.still_since,
                                 target.existence.pedestrian});  // or has as many already
}

void Tracker::drop_unseen(const LineOfSight& sight) noexcept {
  for (std::size_t b = targets_.size(); b-- > 0;) {
    Target& target = targets_[b];
    const bool empty = sight.at(target.estimate.track.position_in_map, kEmptyWithinM) == Sight::kThrough;
    if (target.existence.misses > 0 && empty) target.existence.looked_through_s += step_s_;
    if (!is_gone(target.estimate.track, target.existence, now_)) continue;
    if (target.estimate.track.moving && !target.existence.given &&
        target.existence.looked_through_s <= kLookedThroughForS)
      leave_hidden(target);
    targets_.swap_remove(b);
  }
  hidden_.update(sight, now_, step_s_);
}

void Tracker::birth() noexcept {
  if (unreported_s_ < kForeseenS) return;  // it knows them all; where it falls silent the laser has to do
  Detections& detections = scene().detections;
  for (std::size_t k = 0; k < detections.size(); ++k) {
    if (detections[k].track_id != 0) continue;
    Observation seen;
    if (!observe_new(detections, k, last_id_ + 1, seen)) continue;
    last_id_ += 1;
    Target target = born_at(seen.position_in_map, seen.std_m, seen.radius_m, now_, last_id_);
    note_seen(target.estimate, target.appearance, seen);
    target.existence.finder = scanner_;
    target.onset.free_share = seen.in_free_space ? 1.0 : 0.0;
    target.appearance.legs_share = seen.two_legs ? 1.0 : 0.0;
    anchor_here(target, map_from_first_, now_);
    if (hidden_.reidentify(target, now_))
      for (Detection& c : detections)
        if (c.track_id == last_id_) c.track_id = target.estimate.track.id;
    admit(targets_, target, map_from_first_.position());
  }
}

void Tracker::enter_still() noexcept {
  const Scene& scene = this->scene();
  const Vec2 laser_in_map = scene.map_from_laser.position();
  const std::size_t count = scene.points.size();
  decide_entries(targets_, scene.detections, {scene.in_map.position.data(), count}, still_, now_, entries_);
  const CellIndex low = still_.low();
  still_.roll_to(map_from_first_.position());
  if (config_.known_map && !(still_.low() == low)) enter(*config_.known_map, still_, low);
  entry_.enter(still_, laser_in_map, scene.in_map.position, entries_, count, step_s_);
  const Pose2 map_from_robot = scene.map_from_laser * inverse(scene.robot_from_laser);
  const Transform2 to_map(map_from_robot);
  for (const ScanPoint& end : scene.empty) MapEntry::mark_observed(still_, laser_in_map, to_map * end.in_robot);
  free_under(still_, map_from_robot, config_.body);
}

/// What motion is told of a track's past. A pedestrian known to stand where a track is found is that track.
void Tracker::note_history(Target& target) const noexcept {
  Estimate& estimate = target.estimate;
  Track& track = estimate.track;
  const auto known = std::find_if(standing_.begin(), standing_.end(), [&](const StandingPedestrian& p) {
    return distance(p.position_in_map, track.position_in_map) < kSamePedestrianM;
  });
  const bool is_known = known != standing_.end();
  track.is_pedestrian = track.moving || is_known || target.existence.pedestrian.is_pedestrian();
  const Vec2 off = track.position_in_map - estimate.still_at;
  const double crept_m = kStartsMps * step_s_;  // creeping is standing
  if (track.still_since == kNever || norm(off) > kStandsWithinM) {
    track.still_since = track.still_since == kNever && is_known ? std::min(known->since, told_) : told_;
    estimate.still_at = track.position_in_map;
  } else if (norm(off) > crept_m) {
    estimate.still_at = estimate.still_at + off * (crept_m / norm(off));
  }
}

void Tracker::publish() noexcept {
  tracks_.clear();
  moving_.clear();
  standing_.clear();
  for (const StandingPedestrian& one : candidates_) {
    if (one.belief.is_pedestrian()) (void)standing_.push_back(one);
  }
  for (Target& target : targets_) {
    if (!target.confirmed()) continue;
    note_history(target);
    Track track = target.estimate.track;
    track.covariance.pp += target.estimate.off_std_m * target.estimate.off_std_m;
    (void)tracks_.push_back(track);  // as many places as bodies
    if (track.moving) (void)moving_.push_back(track);
  }
}

void Tracker::update(const LaserScan& scan, const Pose2& map_from_robot, const Twist2& twist, Time told) noexcept {
  if (scan.stamp == kNever || !finite(map_from_robot)) return;
  told_ = told == kNever ? scan.stamp : told;
  begin(scan, map_from_robot);
  scene().update(scan, map_from_robot, twist, still_, targets_);
  for (Detection& seen : scene().detections) seen.late_s += behind_s_;
  associate_and_correct();
  const LineOfSight sight(scan, map_from_robot, scene().robot_from_laser, twist);
  judge(sight, twist);
  drop_unseen(sight);
  birth();
  enter_still();
  update_standing(targets_, still_, sight, now_, candidates_);
  publish();
  past_.keep(scan, map_from_robot, scene().robot_from_laser, twist);
}

void Tracker::update_given(const OutsideFix& fix) noexcept {
  unreported_s_ = 0.0;
  take_given(fix, map_from_first_.position(), targets_, last_id_);
  publish();
}

void Tracker::forget_unseen() noexcept {
  for (const Scene& scene : scenes_) loose_.note_in_view(still_, scene.in_map, scene.points.size());
  loose_.forget_unseen(still_);
}

}  // namespace jaywalk
