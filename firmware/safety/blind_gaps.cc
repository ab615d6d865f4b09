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

Lookout::Lookout(const OfEach<Pose2>& robot_from_lasers) {
  for (const Pose2& mount : robot_from_lasers) laser_from_robot_.emplace_back(inverse(mount));
}

Coverage Lookout::at(const OfEach<BlindGaps>& gaps, Vec2 place) const noexcept {
  Coverage best = Coverage::kUnwatched;
  for (std::size_t k = 0; k < laser_from_robot_.size() && best != Coverage::kProven; ++k)
    best = std::min(best, gaps[k].at(laser_from_robot_[k] * place));  // in the enumeration's order
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

}  // namespace jaywalk
