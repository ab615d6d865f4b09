#include "apps/formats/logs/beam_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "hal/types/trig.h"

namespace jaywalk::sim {
namespace {

constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();

/// The nearer hit; what found nothing (infinity) says more than what knows nothing.
float nearer(float a, float b) {
  if (std::isnan(a)) return b;
  return std::isnan(b) ? a : std::min(a, b);
}

BeamAngles fan_of(const RecordedScan& scan) {
  return {static_cast<double>(scan.first_angle_rad), static_cast<double>(scan.angle_step_rad), scan.beams};
}

}  // namespace

std::ptrdiff_t BeamAngles::beam_at(double angle) const {
  const double last = static_cast<double>(beams) - 1.0;
  const double middle_rad = first_rad + 0.5 * last * step_rad;
  const double beam = std::round(0.5 * last + wrap_angle(angle - middle_rad) / step_rad);
  return beam >= 0.0 && beam <= last ? static_cast<std::ptrdiff_t>(beam) : -1;
}

void resample(const BeamAngles& from, std::span<const float> ranges, const BeamAngles& to, std::span<float> out) {
  std::fill(out.begin(), out.end(), kUnknown);
  std::vector<bool> met(to.beams, false);
  for (std::size_t k = 0; k < ranges.size(); ++k) {
    const std::ptrdiff_t beam = to.beam_at(from.angle_rad(k));
    if (beam < 0) continue;
    float& range = out[static_cast<std::size_t>(beam)];
    range = nearer(range, ranges[k]);
    met[static_cast<std::size_t>(beam)] = true;
  }
  for (std::size_t m = 0; m < to.beams; ++m) {
    const std::ptrdiff_t beside = met[m] ? -1 : from.beam_at(to.angle_rad(m));
    if (beside >= 0) out[m] = ranges[static_cast<std::size_t>(beside)];
  }
}

void fit_beams(RecordedLog& log, const std::string& name) {
  std::vector<RecordedScan> sorted = log.scans;
  std::sort(sorted.begin(), sorted.end(), [](const auto& a, const auto& b) { return a.beams < b.beams; });
  if (sorted.empty() || sorted.front().beams == sorted.back().beams) return;
  const RecordedScan model = sorted[sorted.size() / 2];
  log.add_remark(name + ": scans of " + std::to_string(sorted.front().beams) + " to " +
                 std::to_string(sorted.back().beams) + " beams, each read as " + std::to_string(model.beams));
  std::vector<float> fitted;
  fitted.reserve(log.scans.size() * model.beams);
  for (RecordedScan& scan : log.scans) {
    const std::span<const float> ranges(log.range_m.data() + scan.first_range, scan.beams);
    scan.first_range = fitted.size();
    if (scan.beams == model.beams) {
      fitted.insert(fitted.end(), ranges.begin(), ranges.end());
      continue;
    }
    fitted.resize(scan.first_range + model.beams);
    resample(fan_of(scan), ranges, fan_of(model), std::span(fitted).subspan(scan.first_range));
    scan.beams = model.beams;
    scan.first_angle_rad = model.first_angle_rad;
    scan.angle_step_rad = model.angle_step_rad;
  }
  log.range_m = std::move(fitted);
}

}  // namespace jaywalk::sim
