#include "bench/tracking/relative_pose.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace jaywalk::bench {
namespace {
constexpr double kStepM = 0.05;

/// Metres driven until each pair.
std::vector<double> way_m(const std::vector<PosePair>& drive) {
  std::vector<double> way;
  Vec2 last = drive.empty() ? Vec2{} : drive.front().truth.position();
  double sum = 0.0;
  for (const PosePair& p : drive) {
    const double step = distance(last, p.truth.position());
    if (step >= kStepM) sum += step, last = p.truth.position();
    way.push_back(sum);
  }
  return way;
}

double median(std::vector<double>& values) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// The estimate's motion from `a` to `b`, seen from where the true one leads.
Pose2 motion_error(const PosePair& a, const PosePair& b) {
  return inverse(inverse(a.truth) * b.truth) * (inverse(a.estimate) * b.estimate);
}

}  // namespace

StepError greatest_step_error(const std::vector<PosePair>& drive) {
  StepError most;
  for (std::size_t k = 1; k < drive.size(); ++k) {
    const Pose2 off = motion_error(drive[k - 1], drive[k]);
    most.translation_m = std::max(most.translation_m, norm(off.position()));
    most.heading_deg = std::max(most.heading_deg, std::fabs(off.heading) * 180.0 / kPi);
  }
  return most;
}

RelativeError relative_error(const std::vector<PosePair>& drive, double length_m, double every_m) {
  const std::vector<double> way = way_m(drive);
  std::vector<double> percent, degrees;
  double next_start = 0.0;
  for (std::size_t a = 0; a < drive.size(); ++a) {
    if (way[a] < next_start) continue;
    const auto end = std::lower_bound(way.begin(), way.end(), way[a] + length_m);
    if (end == way.end()) break;
    next_start = way[a] + every_m;
    const auto b = static_cast<std::size_t>(end - way.begin());
    const Pose2 off = motion_error(drive[a], drive[b]);
    percent.push_back(100.0 * norm(off.position()) / (way[b] - way[a]));
    degrees.push_back(std::fabs(off.heading) * 180.0 / kPi);
  }
  const std::size_t stretches = percent.size();
  return {stretches, median(percent), median(degrees)};
}

}  // namespace jaywalk::bench
