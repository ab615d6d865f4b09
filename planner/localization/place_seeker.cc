#include "planner/localization/place_seeker.h"

#include <cmath>

namespace jaywalk {
namespace {

/// A robot that looks for its place stands: its wheels count no more, m and rad.
constexpr double kStood_m = 0.02, kStood_rad = 0.02;
constexpr double kSamePlace_m = 0.1;  ///< a newer scan is matched no farther off

}  // namespace

void PlaceSeeker::begin_anew() noexcept {
  gave_ = 0;
  found_ = false;
  sample_ = {};
  search_.give_up();
}

std::optional<Pose2> PlaceSeeker::take(const ScanPoints& points, Vec2 laser_in_robot, std::size_t scanner,
                                       const Pose2& odom_from_robot, const EvidenceMap& still) noexcept {
  const Pose2 gone = inverse(odom_from_robot_) * odom_from_robot;
  const bool stood = norm(gone.position()) < kStood_m && std::fabs(gone.heading) < kStood_rad;
  if (!stood) begin_anew();
  odom_from_robot_ = stood ? odom_from_robot_ : odom_from_robot;
  if (search_.is_busy()) return {};
  if (found_) {
    const std::optional<Pose2> place = confirmed(points, laser_in_robot, still);
    begin_anew();
    if (place) return place;
  }
  const unsigned bit = 1U << scanner;
  if ((gave_ & bit) == 0) add_sample(points, laser_in_robot, scanners_, sample_);
  gave_ |= bit;
  return {};
}

void PlaceSeeker::step(const EvidenceMap& still, Vec2 about) noexcept {
  if (search_.is_busy()) {
    if (search_.step(still)) found_ = search_.is_sole() && search_.best().is_good();
  } else if (gave_ + 1 == 1U << scanners_) {
    search_.begin(sample_, about);
    gave_ = 0;
    sample_ = {};
  }
}

std::optional<Pose2> PlaceSeeker::confirmed(const ScanPoints& points, Vec2 laser_in_robot,
                                            const EvidenceMap& still) noexcept {
  SeenSample now;
  add_sample(points, laser_in_robot, 1, now);
  const Pose2& place = search_.best().map_from_robot;
  const PlaceFit fit = PlaceSearch::matched(now, still, place, kStood_m, kStood_rad);
  const bool same = distance(fit.map_from_robot.position(), place.position()) < kSamePlace_m;
  return same && fit.is_good() ? std::optional(fit.map_from_robot) : std::nullopt;
}

}  // namespace jaywalk
