#include "apps/formats/logs/beam_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "hal/types/trig.h"

namespace jaywalk::sim {
namespace {

constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();

/// The directions of one scan's beams.
class Fan {
 public:
  explicit Fan(const RecordedScan& scan)
      : first_rad_(static_cast<double>(scan.first_angle_rad)),
        step_rad_(static_cast<double>(scan.angle_step_rad)),
        last_(static_cast<double>(scan.beams) - 1.0) {}

  [[nodiscard]] double angle_rad(std::size_t beam) const { return first_rad_ + step_rad_ * static_cast<double>(beam); }
  /// The beam nearest to that direction; -1 outside the fan.
  [[nodiscard]] std::ptrdiff_t beam_at(double angle) const {
    const double middle_rad = first_rad_ + 0.5 * last_ * step_rad_;
    const double beam = std::round(0.5 * last_ + wrap_angle(angle - middle_rad) / step_rad_);
    return beam >= 0.0 && beam <= last_ ? static_cast<std::ptrdiff_t>(beam) : -1;
  }

 private:
  double first_rad_, step_rad_, last_;
};

/// The nearer hit; what found nothing (infinity) says more than what knows nothing.
float nearer(float a, float b) {
  if (std::isnan(a)) return b;
  return std::isnan(b) ? a : std::min(a, b);
}

void resample(const RecordedScan& own, std::span<const float> ranges, const RecordedScan& model,
              std::vector<float>& out) {
  const Fan from(own), to(model);
  const std::size_t begin = out.size();
  out.resize(begin + model.beams, kUnknown);
  std::vector<bool> met(model.beams, false);
  for (std::size_t k = 0; k < ranges.size(); ++k) {
    const std::ptrdiff_t beam = to.beam_at(from.angle_rad(k));
    if (beam < 0) continue;
    float& range = out[begin + static_cast<std::size_t>(beam)];
    range = nearer(range, ranges[k]);
    met[static_cast<std::size_t>(beam)] = true;
  }
  for (std::size_t m = 0; m < model.beams; ++m) {
    const std::ptrdiff_t beside = met[m] ? -1 : from.beam_at(to.angle_rad(m));
    if (beside >= 0) out[begin + m] = ranges[static_cast<std::size_t>(beside)];
  }
}

}  // namespace

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
    resample(scan, ranges, model, fitted);
    scan.beams = model.beams;
    scan.first_angle_rad = model.first_angle_rad;
    scan.angle_step_rad = model.angle_step_rad;
  }
  log.range_m = std::move(fitted);
}

}  // namespace jaywalk::sim
