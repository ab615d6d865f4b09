#include "apps/formats/logs/recorded_log.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "hal/types/errors.h"
#include "hal/types/trig.h"

namespace jaywalk::sim {
namespace {

constexpr double kSlowestTurnS = 0.1;

Duration median_period(const std::vector<RecordedScan>& scans) {
  std::vector<Duration> periods;
  for (std::size_t i = 1; i < scans.size(); ++i) periods.push_back(scans[i].stamp - scans[i - 1].stamp);
  if (periods.empty()) return Duration{0};
  const auto middle = periods.begin() + static_cast<std::ptrdiff_t>(periods.size() / 2);
  std::nth_element(periods.begin(), middle, periods.end());
  return *middle;
}

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

void LogPlace::refuse(const std::string& cause, const std::string& remedy) const {
  const std::string at = unit == "line" ? ":" : ": " + unit + " ";
  throw StartupError(file + at + std::to_string(number) + ": " + cause, remedy);
}

void RecordedLog::refuse(const LogPlace& place, std::string_view cause) {
  const auto known = std::find_if(refused.begin(), refused.end(),
                                  [&](const RefusedLines& r) { return r.file == place.file && r.cause == cause; });
  if (known != refused.end())
    ++known->count;
  else
    refused.push_back({place.file, std::string(cause), place.number, 1, place.unit});
}

std::string RecordedLog::complaint() const {
  std::string text;
  for (const RefusedLines& r : refused) {
    text += r.file + ": " + std::to_string(r.count) + " " + r.unit + (r.count == 1 ? "" : "s") +
            " left out, the first is " + r.unit + " " + std::to_string(r.first_line) + ": " + r.cause + "\n";
  }
  return remark.empty() ? text : text + remark + "\n";
}

Time RecordedLog::own_time(Time stamp) const {
  if (own_stamps.empty()) return stamp;
  if (stamp <= scans.front().stamp) return own_stamps.front();
  const auto after = std::upper_bound(scans.begin(), scans.end(), stamp,
                                      [](Time t, const RecordedScan& scan) { return t < scan.stamp; });
  if (after == scans.end()) return own_stamps.back();
  const auto k = static_cast<std::size_t>(after - scans.begin());
  const double share = to_seconds(stamp - scans[k - 1].stamp) / to_seconds(after->stamp - scans[k - 1].stamp);
  return own_stamps[k - 1] + duration_from_seconds(share * to_seconds(own_stamps[k] - own_stamps[k - 1]));
}

LaserModel RecordedLog::laser() const {
  LaserModel laser;
  laser.robot_from_laser = robot_from_laser;
  if (scans.empty()) return laser;
  const RecordedScan& first = scans.front();
  const double step = static_cast<double>(first.angle_step_rad);
  laser.beams = first.beams;
  laser.fov_rad = (step < 0.0 ? -step : step) * static_cast<double>(first.beams - 1);
  laser.range_min_m = static_cast<double>(first.range_min_m);
  laser.range_max_m = static_cast<double>(first.range_max_m);
  const Duration period = median_period(scans);
  laser.rate_hz = period > Duration{0} ? 1.0 / to_seconds(period) : 0.0;
  return laser;
}

Duration RecordedLog::spinning_sweep() const {
  const double turn_s = std::min(to_seconds(median_period(scans)), kSlowestTurnS);
  return duration_from_seconds(turn_s * laser().fov_rad / (2.0 * kPi));
}

BeamFan carmen_fan(std::size_t beams, double aperture_rad) {
  const std::size_t steps = beams % 2 == 0 ? beams : beams - 1;
  const double step = steps == 0 ? aperture_rad : aperture_rad / static_cast<double>(steps);
  return {static_cast<float>(-aperture_rad / 2.0), static_cast<float>(step)};
}

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
