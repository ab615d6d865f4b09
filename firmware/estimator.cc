#include "firmware/estimator.h"

#include <algorithm>
#include <utility>

#include "planner/localization/odometry.h"

namespace jaywalk {
namespace {

constexpr LaserScan kNoScan{};
constexpr Duration kNoWayFor = std::chrono::seconds(10);  // time for a person in the way to walk on

}  // namespace

Estimator::Estimator(const ControlSetup& setup)
    : sees_given_movers_(setup.sees_given_movers()),
      times_(setup.model.drive.times),
      localizer_({.map_from_robot_at_start = setup.start,
                  .drive = setup.model.drive,
                  .robot_from_laser = setup.model.laser.robot_from_laser,
                  .doubts = setup.wired || setup.judges_motion,
                  .robot_from_others = other_mounts(setup.model)}),
      tracker_({.robot_from_laser = setup.model.laser.robot_from_laser,
                .cell_m = setup.planner().cell_m,
                .map_centre = (setup.start.position() + setup.goal) * 0.5,
                .body = setup.model.footprint,
                .known_map = setup.known_map,
                .robot_from_others = other_mounts(setup.model)}) {
  for (std::size_t k = 0; k < setup.model.lasers().size(); ++k) rests_.push_back({RestWatch(setup.model, k)});
}

PoseEstimate Estimator::pose_at(Time now) const noexcept {
  constexpr DriveTimes kUsual;
  if (times_.report_s <= kUsual.report_s && times_.late_s <= kUsual.late_s) return pose_;
  const double seconds = std::clamp(to_seconds(age(pose_.stamp, now)), 0.0, times_.oldest_report_s());
  const Twist2 twist = localizer_.twist();
  PoseEstimate carried = pose_;
  carried.map_from_robot = after_arc(pose_.map_from_robot, {twist.v_mps * seconds, twist.w_radps * seconds});
  return carried;
}

bool Estimator::update(const TickRecord& t) noexcept {
  FixedVector<const LaserScan*, kMostScanners> scans;
  for (const LaserScan& scan : t.scans()) {
    (void)scans.push_back(&scan);
    for (std::size_t k = scans.size() - 1; k > 0 && scans[k]->stamp < scans[k - 1]->stamp; --k)
      std::swap(scans[k], scans[k - 1]);
  }
  bool new_scan = false;
  for (const LaserScan* scan : scans) new_scan = take(t, *scan) || new_scan;
  return new_scan;
}

bool Estimator::take(const TickRecord& t, const LaserScan& scan) noexcept {
  const bool frozen = frozen_[scan.scanner];
  const bool new_scan = std::exchange(scans_seen_[scan.scanner], scan.sequence) != scan.sequence && !frozen;
  const bool explained = is_explained(scan, t.wheels);
  const LaserScan& seen = frozen || !explained ? kNoScan : scan;  // a frozen one shows what was
  const bool in_doubt = pose_.doubtful;
  pose_ = localizer_.update(t.wheels, seen, t.fix, tracker_.still(), tracker_.moving());
  if (sees_given_movers_ && std::exchange(fix_seen_, t.fix.sequence) != t.fix.sequence) tracker_.update_given(t.fix);
  if (in_doubt && !pose_.doubtful) {
    for (Rest& rest : rests_) {
      rest.watch.begin_anew();
      rest.says = RestWatch::Says::kNothing;
    }
  }
  if (!new_scan || !explained || pose_.doubtful) return false;
  tracker_.update(scan, localizer_.map_from_robot_at_scan(scan.scanner), localizer_.twist(), t.now);
  return true;
}

bool Estimator::is_explained(const LaserScan& scan, const WheelState& wheels) noexcept {
  if (pose_.doubtful) return true;
  using Says = RestWatch::Says;
  Rest& own = rests_[scan.scanner];
  if (frozen_[scan.scanner]) {  // it repeats a scan of another place
    own.watch.begin_anew();
    return true;
  }
  const Says says = own.watch.judge(scan, wheels);
  if (says != Says::kNothing) own.says = says;
  // Another scanner shows the robot standing: this one was moved in its mount.
  const bool stands = std::ranges::any_of(rests_, [](const Rest& rest) { return rest.says == Says::kStands; });
  if (says == Says::kMoved && !stands) localizer_.carried();
  return says != Says::kDoubts && says != Says::kMoved;
}

void Estimator::forget_where_stuck(const TickRecord& t) noexcept {
  const bool no_path = t.plan_status == PlanStatus::kNoPath || t.plan_status == PlanStatus::kRobotBlocked;
  const bool waits = t.input.has_goal && no_path && stood_;
  if (waits && age(had_way_, t.now) < kNoWayFor) return;
  had_way_ = t.now;
  if (waits) tracker_.forget_unseen();
}

void Estimator::end_tick(const TickRecord& t) noexcept {
  for (std::size_t k = 0; k < t.scans().size(); ++k)
    frozen_[k] = has(t.verdict.reasons, Reason::kScanFrozen) && (t.other_scans.empty() || t.verdict.is_faulty(k));
  stood_ = t.command.left_radps == 0.0 && t.command.right_radps == 0.0;
}

std::span<const Vec2> KnownWalls::near(const EvidenceMap& still, const Pose2& map_from_robot) noexcept {
  points_.clear();
  still_ = finite(map_from_robot) ? &still : nullptr;
  map_from_robot_ = map_from_robot;
  if (still_ == nullptr) return {};
  const Transform2 robot_from_map(inverse(map_from_robot));
  for_each_surface_near(
      still, map_from_robot.position(), reach_m_, [&](CellIndex cell) { return still.stands(cell); },
      [&](Vec2 surface) { (void)points_.push_back(robot_from_map * surface); });
  decltype(supposed_) still_supposed;
  for (const Vec2 place : supposed_) {
    if (distance(place, map_from_robot.position()) > reach_m_ || still.seen_free(still.cell_at(place))) continue;
    (void)still_supposed.push_back(place);
    (void)points_.push_back(robot_from_map * place);
  }
  supposed_ = still_supposed;
  return {points_.data(), points_.size()};
}

void KnownWalls::suppose(Vec2 place) noexcept {
  constexpr double kApart_m = 0.03;  // each look at a wall's end supposes the same again
  if (still_ == nullptr) return;
  const Vec2 in_map = map_from_robot_ * place;
  for (const Vec2 other : supposed_)
    if (distance(other, in_map) < kApart_m) return;
  (void)supposed_.push_back(in_map);
}

}  // namespace jaywalk
