#include "firmware/estimator.h"

namespace jaywalk {
namespace {

constexpr LaserScan kNoScan{};
constexpr Duration kNoWayFor = std::chrono::seconds(10);  // time for a person in the way to walk on

LocalizationConfig localization_config(const ControlSetup& setup) {
  return {.map_from_robot_at_start = setup.start,
          .drive = setup.model.drive,
          .robot_from_laser = setup.model.laser.robot_from_laser,
          .doubts = setup.wired || setup.judges_motion};
}

PerceptionConfig perception_config(const ControlSetup& setup) {
  return {.robot_from_laser = setup.model.laser.robot_from_laser,
          .cell_m = setup.planner().cell_m,
          .map_centre = (setup.start.position() + setup.goal) * 0.5,
          .body = setup.model.footprint,
          .known_map = setup.known_map};
}

}  // namespace

Estimator::Estimator(const ControlSetup& setup)
    : sees_given_movers_(setup.sees_given_movers()),
      localizer_(localization_config(setup)),
      tracker_(perception_config(setup)) {}

bool Estimator::update(const TickRecord& t) noexcept {
  const bool new_scan = scans_.is_new(t.scan.sequence) && !scan_frozen_;
  const LaserScan& seen = scan_frozen_ ? kNoScan : t.scan;  // a frozen one shows what was
  pose_ = localizer_.update(t.wheels, seen, t.fix, tracker_.still(), tracker_.moving());
  if (sees_given_movers_ && fixes_.is_new(t.fix.sequence)) tracker_.update_given(t.fix);
  if (!new_scan || pose_.doubtful) return false;
  tracker_.update(t.scan, localizer_.map_from_robot_at_scan(), localizer_.twist(), t.now);
  return true;
}

void Estimator::forget_where_stuck(const TickRecord& t) noexcept {
  const bool no_path = t.plan_status == PlanStatus::kNoPath || t.plan_status == PlanStatus::kRobotBlocked;
  const bool waits = t.input.has_goal && no_path && stood_;
  if (waits && age(had_way_, t.now) < kNoWayFor) return;
  had_way_ = t.now;
  if (waits) tracker_.forget_unseen();
}

void Estimator::end_tick(const TickRecord& t) noexcept {
  scan_frozen_ = has(t.verdict.reasons, Reason::kScanFrozen);
  stood_ = t.command.left_radps == 0.0 && t.command.right_radps == 0.0;
}

}  // namespace jaywalk
