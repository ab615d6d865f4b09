#include "firmware/robot/place_check.h"

#include <cmath>
#include <utility>

#include "hal/shown_text.h"

namespace jaywalk {
namespace {

constexpr double kWheelRolled_rad = 0.1;  ///< of a wheel: it does not stand

}  // namespace

std::string words_of(const PlaceAnswer& answer) {
  using Why = PlaceAnswer::Why;
  const std::string forced = "or here --force, which takes it unseen\n";
  if (answer.is_taken()) return "there\n";
  if (answer.why == Why::kMoved) return "refused: the robot moved meanwhile; try again when it stands\n";
  const Pose2& there = answer.better;
  const std::string better = answer.has_better ? formatted("%.2f,%.2f %.2f", there.x, there.y, there.heading) : "";
  if (answer.why == Why::kElsewhere) return "refused: the scan fits much better at " + better + "; say that, " + forced;
  const std::string share = formatted("%.0f %% of it lies on walls", 100.0 * answer.fit);
  return std::string("refused: the scan does not fit there: ") + share + " of the map; " +
         (answer.has_better ? "it fits at " + better : "look again where the robot is") + ", " + forced;
}

bool PlaceCheck::step(const std::optional<Orders>& told, const TickRecord& t, const EvidenceMap& still) noexcept {
  if (told) {
    order_ = *told;
    search_.give_up();
    return look(t, still);
  }
  if (!search_.is_busy()) return false;
  if (std::fabs(t.wheels.left_rad - left_rad_) > kWheelRolled_rad ||
      std::fabs(t.wheels.right_rad - right_rad_) > kWheelRolled_rad) {
    search_.give_up();
    return end(PlaceAnswer::Why::kMoved);
  }
  return search_.step(still) && decide();
}

bool PlaceCheck::look(const TickRecord& t, const EvidenceMap& still) noexcept {
  there_ = other_ = {};
  if (order_.forced) return end(PlaceAnswer::Why::kForced);
  left_rad_ = t.wheels.left_rad, right_rad_ = t.wheels.right_rad;
  sample_ = {};
  for (const LaserScan& scan : t.scans()) {
    if (scan.sequence == 0) continue;
    const Pose2& mount = model_.lasers()[scan.scanner].robot_from_laser;
    projection_.project(scan, mount, {}, points_);
    add_sample(points_, mount.position(), model_.lasers().size(), sample_);
  }
  const auto matched = [&](const Pose2& near) {
    return PlaceSearch::matched(sample_, still, near, ToldPlace::kEye_m, ToldPlace::kEye_rad);
  };
  there_ = matched(*order_.here);
  other_ = matched(t.pose.map_from_robot);
  if (there_.says_nothing()) return end(other_.is_good() ? PlaceAnswer::Why::kElsewhere : PlaceAnswer::Why::kUnknown);
  search_.begin(sample_, order_.here->position());
  return false;
}

bool PlaceCheck::decide() noexcept {
  using Why = PlaceAnswer::Why;
  if (search_.best().is_clearly_better_than(other_)) other_ = search_.best();
  if (!there_.fits()) return end(Why::kPoor);
  return end(other_.is_clearly_better_than(there_) ? Why::kElsewhere : Why::kFits);
}

bool PlaceCheck::end(PlaceAnswer::Why why) noexcept {
  const bool matched = why != PlaceAnswer::Why::kUnknown && why != PlaceAnswer::Why::kForced;
  answer_ = {.number = order_.number,
             .why = why,
             .map_from_robot = matched ? there_.map_from_robot : *order_.here,
             .fit = there_.fit(),
             .has_better = other_.is_good(),
             .better = other_.map_from_robot};
  return true;
}

bool Permission::judge(Reason reasons) noexcept {
  const bool latched = has(reasons, Reason::kLatched);
  const Reason faults = without(reasons, kNoFaults);
  const bool rises = without(faults, std::exchange(faults_, faults)) != Reason::kNone;
  const bool begins = !std::exchange(latched_, latched) && latched;
  if (begins || (latched && rises)) revoke();
  return std::exchange(revokes_reset_, false) || begins;
}

}  // namespace jaywalk
