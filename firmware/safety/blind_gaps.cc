#include "firmware/safety/blind_gaps.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace jaywalk {
namespace {
constexpr double kPostRadius_m = 0.035;  // SAFETY: a cylinder of 70 mm is seen everywhere
constexpr double kAhead_rad = kPi / 3.0;
constexpr double kRim_rad = 1e-6;  // as blank() has it: a beam on a sector's rim is in it
constexpr double kInfinity_m = std::numeric_limits<double>::infinity();

constexpr std::uint32_t kShare = 2, kShareAhead = 3;  // one in so many
constexpr Duration kLongestAhead = std::chrono::seconds(1);

constexpr double kPiece_m = 0.02;       // a post has 70 mm
constexpr double kMostlyOutward = 0.5;  // of a point's speed: 60 degrees to either side of straight out
constexpr std::size_t kEveryStep = 4;   // 16 cm: what a laser never sees does not come in slices

// Of walls that are continued.
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

void BlindGaps::update(const LaserScan& scan) noexcept {
  const std::size_t beams = std::min<std::size_t>(scan.beam_count, kMaxBeams);
  const auto first_rad = static_cast<double>(scan.first_angle_rad), step_rad = static_cast<double>(scan.angle_step_rad);
  const bool is_scan = beams >= 2 && std::isfinite(first_rad) && std::isfinite(step_rad) && step_rad != 0.0;
  if (!is_scan) {
    beams_ = 0;
    counts_ = {};
    nearest_lost_m_ = 0.0;
    return;
  }
  if (beams != beams_ || first_rad != first_rad_ || step_rad != step_rad_) learn_directions(scan);
  judge_beams(scan);
  find_gaps();
}

void BlindGaps::learn_directions(const LaserScan& scan) noexcept {
  beams_ = std::min<std::size_t>(scan.beam_count, kMaxBeams);
  first_rad_ = static_cast<double>(scan.first_angle_rad);
  step_rad_ = static_cast<double>(scan.angle_step_rad);
  all_round_ = static_cast<double>(beams_) * std::fabs(step_rad_) > 2.0 * kPi - 0.5 * std::fabs(step_rad_);
  for (std::size_t k = 0; k < beams_; ++k) {
    const double angle = scan.angle_rad(k);
    ahead_[k] = std::fabs(wrap_angle(angle + laser_.robot_from_laser.heading)) <= kAhead_rad;
    blanked_[k] = std::any_of(laser_.blanked.begin(), laser_.blanked.end(),
                              [angle](const BlankedSector& sector) { return sector.off_rad(angle) <= kRim_rad; });
  }
}

void BlindGaps::judge_beams(const LaserScan& scan) noexcept {
  counts_ = {};
  for (std::size_t k = 0; k < beams_; ++k) {
    if (blanked_[k]) {
      beam_[k] = Beam::kBlanked;
      continue;
    }
    const bool lost = scan.state(k) == BeamState::kUnknown;
    beam_[k] = lost ? Beam::kLost : Beam::kMeasured;
    counts_.lost += lost ? 1U : 0U;
    counts_.measured += lost ? 0U : 1U;
    counts_.ahead += ahead_[k] ? 1U : 0U;
    counts_.lost_ahead += ahead_[k] && lost ? 1U : 0U;
  }
}

void BlindGaps::find_gaps() noexcept {
  std::fill_n(gap_.begin(), beams_, Gap{kInfinity_m, Coverage::kProven});
  nearest_lost_m_ = kInfinity_m;
  const double step = std::fabs(step_rad_);
  const auto measured = [](Beam beam) { return beam == Beam::kMeasured; };
  const auto first = static_cast<std::size_t>(
      std::find_if(beam_.begin(), beam_.begin() + static_cast<std::ptrdiff_t>(beams_), measured) - beam_.begin());
  if (first == beams_) {
    mark(0, beams_, kPi);
    return;
  }
  std::size_t before = first;
  const std::size_t end = all_round_ ? first + beams_ + 1 : beams_;
  for (std::size_t k = first + 1; k < end; ++k) {
    if (!measured(beam_[k % beams_])) continue;
    if (k - before > 1) mark(before, k - before, 0.5 * step * static_cast<double>(k - before));
    before = k;
  }
  if (all_round_) return;
  if (first > 0) mark(0, first, step * static_cast<double>(first));
  const std::size_t after = beams_ - 1 - before;
  if (after > 0) mark(before, after, step * static_cast<double>(after));
}

void BlindGaps::mark(std::size_t from, std::size_t count, double half_rad) noexcept {
  const double middle_m = kPostRadius_m / sin(std::min(half_rad, 0.5 * kPi));
  const double near_m = std::max(0.0, middle_m - kPostRadius_m);
  for (std::size_t k = from; k < from + count; ++k) {
    const bool lost = beam_[k % beams_] == Beam::kLost || beam_[(k + 1) % beams_] == Beam::kLost;
    gap_[k % beams_] = {near_m, lost ? Coverage::kLost : Coverage::kUnwatched};
    if (lost) nearest_lost_m_ = std::min(nearest_lost_m_, near_m);
  }
}

Coverage BlindGaps::at(Vec2 place) const noexcept {
  if (beams_ == 0) return Coverage::kUnwatched;
  const double past_first = wrap_angle(atan2(place.y, place.x) - first_rad_) * (step_rad_ < 0.0 ? -1.0 : 1.0);
  const double turned = past_first < 0.0 ? past_first + 2.0 * kPi : past_first;
  const double beams = turned / std::fabs(step_rad_);
  auto interval = static_cast<std::size_t>(beams);
  const std::size_t intervals = all_round_ ? beams_ : beams_ - 1;
  if (interval >= intervals) {
    // Half a beam's width beyond the last beam and before the first is seen as they are.
    const bool at_last = beams < static_cast<double>(beams_) - 0.5,
               at_first = 2.0 * kPi / std::fabs(step_rad_) - beams < 0.5;
    if (!all_round_ && !at_last && !at_first) return Coverage::kUnwatched;
    interval = at_first && !at_last ? 0 : intervals - 1;
  }
  const Gap& gap = gap_[interval];
  return dot(place, place) < gap.near_m * gap.near_m ? Coverage::kProven : gap.coverage;
}

Coverage coverage_at(const OfEach<BlindGaps>& gaps, Vec2 place) noexcept {
  Coverage best = Coverage::kUnwatched;
  for (std::size_t k = 0; k < gaps.size() && best != Coverage::kProven; ++k)
    best = std::min(best, gaps[k].at(gaps[k].laser_from_robot() * place));  // in the enumeration's order
  return best;
}

bool SightLoss::is_lost(const BeamCounts& counts, Time now) noexcept {
  if (kShareAhead * counts.lost_ahead <= counts.ahead) {
    lost_ahead_since_ = kNever;
  } else if (lost_ahead_since_ == kNever) {
    lost_ahead_since_ = now;
  }
  const bool ahead = lost_ahead_since_ != kNever && now - lost_ahead_since_ > kLongestAhead;
  return ahead || kShare * counts.lost > counts.lost + counts.measured;
}

Watch::Watch(const Footprint& footprint, double margin_m)
    : margin_m_(margin_m),
      held_free_{footprint.front_m + margin_m, footprint.rear_m + margin_m, footprint.half_width_m + margin_m} {
  const auto along = [this](Vec2 from, Vec2 to, Vec2 outward) {
    const int pieces = static_cast<int>(distance(from, to) / kPiece_m) + 1;
    for (int k = 1; k < pieces; ++k) rim_.push_back({from + (to - from) * (static_cast<double>(k) / pieces), outward});
  };
  const std::array<Vec2, 4> corners = corners_of(footprint);
  const Vec2 normals[4] = {{0.0, 1.0}, {-1.0, 0.0}, {0.0, -1.0}, {1.0, 0.0}};  // of the side that begins there
  for (std::size_t k = 0; k < 4; ++k) {
    rim_.push_back({corners[k], normals[k] + normals[(k + 3) % 4]});
    along(corners[k], corners[(k + 1) % 4], normals[k]);
  }
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
      unwatched = coverage_at(gaps, path.place_of(k, beyond)) == Coverage::kUnwatched;
    if (unwatched) fastest = speed;
  }
  return fastest;
}

double Watch::way_to_lost_m(const OfEach<BlindGaps>& gaps, const Twist2& twist, const SweptPath& path,
                            double margin_m) const noexcept {
  double nearest_m = kInfinity_m;
  for (const BlindGaps& of : gaps) nearest_m = std::min(nearest_m, of.nearest_lost_m());
  if (nearest_m == kInfinity_m) return kInfinity_m;
  std::size_t first = path.steps() + 1;
  for (const RimPoint& rim : rim_) {
    if (outward_mps(rim, velocity(twist, rim.on_body)) <= 0.0) continue;
    const Vec2 grown = rim.on_body + rim.outward * margin_m;
    for (std::size_t k = 1; k < first; ++k) {
      const Vec2 place = path.place_of(k, grown);
      if (held_free_.distance_to(place) > 0.0 && coverage_at(gaps, place) == Coverage::kLost) first = k;
    }
  }
  return first > path.steps() ? kInfinity_m : static_cast<double>(first - 1) * SweptPath::kStep_m;
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
  const bool counts = footprint_.distance_to(point) > 0.0 && coverage_at(gaps, point) == Coverage::kUnwatched;
  if (counts) (void)points_.push_back(point);
}

void UnseenWalls::continue_wall(const LaserScan& scan, const OfEach<BlindGaps>& gaps, const Rim& rim) noexcept {
  const BlindGaps& own = gaps[rim.scanner];
  const Transform2& robot_from_laser = own.robot_from_laser();
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
