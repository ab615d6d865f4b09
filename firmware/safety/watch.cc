#include "firmware/safety/watch.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace jaywalk {
namespace {

constexpr double kPiece_m = 0.02;       // a post has 70 mm
constexpr double kMostlyOutward = 0.5;  // of a point's speed: 60 degrees to either side of straight out
constexpr std::size_t kEveryStep = 4;   // 16 cm: what a laser never sees does not come in slices

}  // namespace

Watch::Watch(const Footprint& footprint, const OfEach<Pose2>& robot_from_lasers, double margin_m)
    : footprint_(footprint), lookout_(robot_from_lasers), margin_m_(margin_m) {
  const double front = footprint.front_m, rear = -footprint.rear_m, half = footprint.half_width_m;
  const auto along = [this](Vec2 from, Vec2 to, Vec2 outward) {
    const int pieces = static_cast<int>(distance(from, to) / kPiece_m) + 1;
    for (int k = 1; k < pieces; ++k) rim_.push_back({from + (to - from) * (static_cast<double>(k) / pieces), outward});
  };
  const Vec2 corners[4] = {{front, half}, {rear, half}, {rear, -half}, {front, -half}};
  const Vec2 normals[4] = {{0.0, 1.0}, {-1.0, 0.0}, {0.0, -1.0}, {1.0, 0.0}};  // of the side that begins there
  for (std::size_t k = 0; k < 4; ++k) {
    rim_.push_back({corners[k], normals[k] + normals[(k + 3) % 4]});
    along(corners[k], corners[(k + 1) % 4], normals[k]);
  }
}

double Watch::outward_mps(const RimPoint& rim, Vec2 moves) noexcept {
  return std::max(moves.x * rim.outward.x, moves.y * rim.outward.y);
}

/// Whether a place lies within what the robot keeps free round itself.
bool Watch::held_free(Vec2 place) const noexcept {
  return place.x <= footprint_.front_m + margin_m_ && place.x >= -footprint_.rear_m - margin_m_ &&
         std::fabs(place.y) <= footprint_.half_width_m + margin_m_;
}

double Watch::unwatched_mps(const OfEach<BlindGaps>& gaps, const Twist2& twist, const SweptPath& path) const noexcept {
  double fastest = 0.0;
  for (const RimPoint& rim : rim_) {
    const Vec2 moves = velocity(twist, rim.on_body);
    const double speed = norm(moves);
    if (speed <= fastest || outward_mps(rim, moves) <= kMostlyOutward * speed) continue;
    const Vec2 beyond = rim.on_body + rim.outward * margin_m_;
    bool unwatched = false;
    for (std::size_t k = 0; k <= path.steps() && !unwatched; k += kEveryStep)
      unwatched = lookout_.at(gaps, path.place_of(k, beyond)) == Coverage::kUnwatched;
    if (unwatched) fastest = speed;
  }
  return fastest;
}

double Watch::way_to_lost_m(const OfEach<BlindGaps>& gaps, const Twist2& twist, const SweptPath& path,
                            double margin_m) const noexcept {
  constexpr double kNever_m = std::numeric_limits<double>::infinity();
  double nearest_m = kNever_m;
  for (const BlindGaps& of : gaps) nearest_m = std::min(nearest_m, of.nearest_lost_m());
  if (nearest_m == kNever_m) return kNever_m;
  std::size_t first = path.steps() + 1;
  for (const RimPoint& rim : rim_) {
    if (outward_mps(rim, velocity(twist, rim.on_body)) <= 0.0) continue;
    const Vec2 grown = rim.on_body + rim.outward * margin_m;
    for (std::size_t k = 1; k < first; ++k) {
      const Vec2 place = path.place_of(k, grown);
      if (!held_free(place) && lookout_.at(gaps, place) == Coverage::kLost) first = k;
    }
  }
  return first > path.steps() ? kNever_m : static_cast<double>(first - 1) * SweptPath::kStep_m;
}

}  // namespace jaywalk
