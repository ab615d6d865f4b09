#include "firmware/safety/unseen_walls.h"

#include <algorithm>
#include <cmath>

namespace jaywalk {
namespace {
constexpr double kOff_m = 0.03;       // three standard deviations of a range: farther from the line is another surface
constexpr double kApart_m = 0.3;      // between two hits of a wall
constexpr double kSeed_m = 0.10;      // so much of it tells its direction from noise
constexpr double kShortest_m = 0.15;  // of what is seen of it: its direction is good to a few degrees
constexpr double kLongest_m = 3.0;    // more says nothing about the piece beside the robot
constexpr double kSpacing_m = 0.04;   // as the stop zone's steps
constexpr int kRefitEvery = 8, kMissing = 3;

/// Straight line through points, by total least squares.
class LineFit {
 public:
  void add(Vec2 p) noexcept {
    ++count_;
    sum_ = sum_ + p;
    xx_ += p.x * p.x, xy_ += p.x * p.y, yy_ += p.y * p.y;
    if (count_ % kRefitEvery != 0) return;
    const double n = count_;
    middle_ = sum_ * (1.0 / n);
    // The principal axis of the points' covariance.
    along_ = direction(0.5 * atan2(2.0 * (xy_ / n - middle_.x * middle_.y),
                                   xx_ / n - middle_.x * middle_.x - yy_ / n + middle_.y * middle_.y));
  }
  [[nodiscard]] bool known() const noexcept { return count_ >= kRefitEvery; }
  [[nodiscard]] double off_m(Vec2 p) const noexcept { return cross(along_, p - middle_); }
  [[nodiscard]] Vec2 along() const noexcept { return along_; }
  [[nodiscard]] Vec2 foot_of(Vec2 p) const noexcept { return middle_ + along_ * dot(along_, p - middle_); }

 private:
  int count_ = 0;
  Vec2 sum_{}, middle_{}, along_{};
  double xx_ = 0.0, xy_ = 0.0, yy_ = 0.0;
};

bool cuts(const LineFit& line, const Footprint& body) noexcept {
  double least = 1e9, most = -1e9;
  for (const Vec2 corner : corners_of(body))
    least = std::min(least, line.off_m(corner)), most = std::max(most, line.off_m(corner));
  return least <= 0.0 && most >= 0.0;
}

}  // namespace

UnseenWalls::UnseenWalls(const Footprint& footprint, const OfEach<Pose2>& robot_from_lasers, double reach_m)
    : footprint_(footprint), reach_m_(reach_m), lookout_(robot_from_lasers) {
  for (const Pose2& mount : robot_from_lasers) robot_from_laser_.emplace_back(mount);
}

void UnseenWalls::update(const OfEach<LaserScan>& scans, const OfEach<BlindGaps>& gaps, std::span<const Vec2> known,
                         KnownGround* ground) noexcept {
  ground_ = ground;
  points_.clear();
  for (const Vec2 point : known) add(gaps, point);
  for (std::size_t k = 0; k < scans.size(); ++k) {
    for (std::size_t beam = 0; beam < gaps[k].beams(); ++beam) {
      for (const int step : {1, -1})
        if (gaps[k].looks(beam) && !gaps[k].looks(gaps[k].beside(beam, -step)))
          continue_wall(scans[k], gaps, {k, beam, step});
    }
  }
}

void UnseenWalls::add(const OfEach<BlindGaps>& gaps, Vec2 point) noexcept {
  const bool counts = footprint_.distance_to(point) > 0.0 && lookout_.at(gaps, point) == Coverage::kUnwatched;
  if (counts) (void)points_.push_back(point);
}

void UnseenWalls::continue_wall(const LaserScan& scan, const OfEach<BlindGaps>& gaps, const Rim& rim) noexcept {
  const BlindGaps& own = gaps[rim.scanner];
  const Transform2& robot_from_laser = robot_from_laser_[rim.scanner];
  LineFit line;
  Vec2 first{}, last{};
  int missing = 0;
  for (std::size_t beam = rim.beam; own.looks(beam) && missing <= kMissing; beam = own.beside(beam, rim.inward)) {
    const Vec2 hit = robot_from_laser * (direction(scan.angle_rad(beam)) * static_cast<double>(scan.range_m[beam]));
    const bool belongs = scan.is_hit(beam) && (distance(first, last) < kSeed_m || std::fabs(line.off_m(hit)) < kOff_m);
    missing = belongs ? 0 : missing + 1;
    if (!belongs) continue;
    if (last == Vec2{}) first = last = hit;
    if (distance(hit, last) > kApart_m || distance(hit, first) > kLongest_m) break;
    line.add(last = hit);
  }
  if (last == Vec2{}) return;
  const double past_body_m = norm(first) + footprint_.circumscribed_radius_m();
  if (!line.known() || distance(first, last) < kShortest_m) {
    const double out_of_sight = rim.inward * (first - robot_from_laser * Vec2{}).y;  // forward where it is above 0
    const std::size_t before = points_.size();
    add_line(gaps, first, {out_of_sight > 0.0 ? 1.0 : -1.0, 0.0}, past_body_m);
    for (std::size_t k = before; k < points_.size() && ground_ != nullptr; ++k) ground_->suppose(points_[k]);
  } else if (!cuts(line, footprint_)) {
    const Vec2 outward = line.along() * (dot(line.along(), first - last) > 0.0 ? 1.0 : -1.0);
    add_line(gaps, line.foot_of(first), outward, past_body_m);
  }
}

void UnseenWalls::add_line(const OfEach<BlindGaps>& gaps, Vec2 from, Vec2 along, double length_m) noexcept {
  for (double gone = 0.0; gone < length_m; gone += kSpacing_m) {
    const Vec2 place = from + along * gone;
    if (norm(place) < reach_m_ && (ground_ == nullptr || !ground_->seen_free(place))) add(gaps, place);
  }
}

}  // namespace jaywalk
