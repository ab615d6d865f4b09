#include "apps/formats/logs/recorded_log.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include "hal/types/errors.h"
#include "hal/types/trig.h"

namespace jaywalk::sim {
namespace {

/// x / sin(x); the series where the quotient loses digits.
double arc_over_chord(double x) { return x * x < 1e-8 ? 1.0 + x * x / 6.0 : x / sin(x); }

/// Pose of the drive after the readings so far, and the encoders' angles then.
struct Driven {
  Pose2 pose;
  WheelState wheels;
};

/// Drives the arc that ends with `to`'s heading and as near to its position as an arc can.
void drive_arc(Driven& driven, const Pose2& to, const DriveModel& drive) {
  const double turn = wrap_angle(to.heading - driven.pose.heading);
  const Vec2 along = direction(driven.pose.heading + turn / 2.0);
  const double chord = dot(to.position() - driven.pose.position(), along);
  const double arc = chord * arc_over_chord(turn / 2.0);
  const double apart = turn * drive.track_width_m / 2.0;
  const Vec2 reached = driven.pose.position() + along * chord;
  driven.pose = {reached.x, reached.y, to.heading};
  driven.wheels.left_rad += (arc - apart) / drive.wheel_radius_m;
  driven.wheels.right_rad += (arc + apart) / drive.wheel_radius_m;
}

constexpr double kAsideM = 0.01;  // an arc that ends this near is the way that was driven
// A robot that hardly drives does not turn far to get a few centimetres aside: that is slip, or a hop of the
// recording's.
constexpr double kMostSlipM = 0.03, kMostBentRad = 0.26;
constexpr Duration kOften = std::chrono::milliseconds(100), kLongestFilled = std::chrono::milliseconds(1500);
constexpr Duration kSparse = std::chrono::milliseconds(150);  // in less a robot does not turn, drive and turn back

/// Lateral error, m, at which an arc from the drive's pose ends beside `to`.
double arc_misses_by(const Driven& driven, const Pose2& to) {
  const double turn = wrap_angle(to.heading - driven.pose.heading);
  return std::fabs(cross(direction(driven.pose.heading + turn / 2.0), to.position() - driven.pose.position()));
}

/// The heading to drive straight to `to` with: ahead, or backwards where that is less of a turn.
double heading_towards(const Driven& driven, const Pose2& to) {
  const Vec2 way = to.position() - driven.pose.position();
  const double ahead = atan2(way.y, way.x);
  return std::fabs(wrap_angle(ahead - driven.pose.heading)) <= kPi / 2 ? ahead : wrap_angle(ahead + kPi);
}

/// Whether it got to `to` by turning, driving straight and turning.
bool turns_and_drives(const Driven& driven, const Pose2& to) {
  const double miss_m = arc_misses_by(driven, to);
  const double bent = wrap_angle(heading_towards(driven, to) - driven.pose.heading);
  return miss_m > kMostSlipM || (miss_m > kAsideM && std::fabs(bent) < kMostBentRad);
}

/// Stamps a reading; its speeds, where the recording says none, are the mean ones since `before`.
void stamp_reading(WheelState& now, Time stamp, const WheelState& before) {
  now.stamp = stamp;
  ++now.sequence;
  if (before.sequence == 0) return;
  const double dt = to_seconds(stamp - before.stamp);
  if (!(dt > 0.0)) return;
  now.left_radps = (now.left_rad - before.left_rad) / dt;
  now.right_radps = (now.right_rad - before.right_rad) / dt;
}

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

DriveModel nominal_drive() { return {.wheel_radius_m = 0.1, .track_width_m = 0.5, .max_wheel_speed_radps = 100.0}; }

std::vector<WheelState> wheel_trail(const std::vector<OdometryPose>& poses, const DriveModel& drive) {
  std::vector<WheelState> trail;
  trail.reserve(3 * poses.size());
  Driven driven;
  if (!poses.empty()) driven.pose = poses.front().pose;
  const auto drive_to = [&](const Pose2& to, Time stamp) {
    const WheelState before = driven.wheels;
    drive_arc(driven, to, drive);
    stamp_reading(driven.wheels, stamp, before);
    trail.push_back(driven.wheels);
  };
  for (const OdometryPose& next : poses) {
    const bool sparse = !trail.empty() && next.stamp - trail.back().stamp > kSparse;
    if (sparse && turns_and_drives(driven, next.pose)) {
      const Time since = trail.back().stamp;
      const Duration third = (next.stamp - since) / 3;
      const double heading = heading_towards(driven, next.pose);
      drive_to({driven.pose.x, driven.pose.y, heading}, since + third);
      drive_to({next.pose.x, next.pose.y, heading}, since + 2 * third);
    }
    drive_to(next.pose, next.stamp);
    if (!next.twist) continue;
    const double apart = next.twist->w_radps * drive.track_width_m / 2.0;
    trail.back().left_radps = (next.twist->v_mps - apart) / drive.wheel_radius_m;
    trail.back().right_radps = (next.twist->v_mps + apart) / drive.wheel_radius_m;
  }
  return trail;
}

std::vector<WheelState> filled_in(const std::vector<WheelState>& trail) {
  std::vector<WheelState> filled;
  filled.reserve(2 * trail.size());
  for (const WheelState& next : trail) {
    const WheelState last = filled.empty() ? next : filled.back();
    const Duration gap = next.stamp - last.stamp;
    const std::int64_t steps = gap <= kLongestFilled ? (gap + kOften - Duration{1}) / kOften : 1;
    for (std::int64_t k = 1; k < steps; ++k) {
      const double share = static_cast<double>(k) / static_cast<double>(steps);
      WheelState between = filled.back();
      between.left_rad = last.left_rad + share * (next.left_rad - last.left_rad);
      between.right_rad = last.right_rad + share * (next.right_rad - last.right_rad);
      stamp_reading(between, last.stamp + gap * k / steps, filled.back());
      filled.push_back(between);
    }
    filled.push_back(next);
    filled.back().sequence = static_cast<std::uint32_t>(filled.size());
  }
  return filled;
}

DriveTimes report_times(const std::vector<WheelState>& trail) {
  constexpr double kLongestReport_s = 0.25, kLatest_s = 0.2;
  DriveTimes times;
  std::vector<double> periods_s;
  for (std::size_t k = 1; k < trail.size(); ++k) periods_s.push_back(to_seconds(trail[k].stamp - trail[k - 1].stamp));
  if (periods_s.empty()) return times;
  std::sort(periods_s.begin(), periods_s.end());
  const double middle_s = std::min(periods_s[periods_s.size() / 2], kLongestReport_s);
  times.report_s = std::max(times.report_s, middle_s);
  times.late_s = std::clamp(periods_s[periods_s.size() * 19 / 20] - times.report_s, 0.0, kLatest_s);
  return times;
}

void LogPlace::refuse(const std::string& cause, const std::string& remedy) const {
  const std::string at = unit == "line" ? ":" : ": " + unit + " ";
  throw StartupError(file + at + std::to_string(number) + ": " + cause, remedy);
}

void RecordedLog::refuse(const LogPlace& place, std::string_view cause) {
  const auto known = std::find_if(refused.begin(), refused.end(), [&](const RefusedLines& r) {
    return r.place.file == place.file && r.cause == cause;
  });
  if (known != refused.end())
    ++known->count;
  else
    refused.push_back({place, std::string(cause), 1});
}

std::string RecordedLog::complaint() const {
  std::string text;
  for (const RefusedLines& r : refused) {
    const auto& [file, number, unit] = r.place;
    text += file + ": " + std::to_string(r.count) + " " + unit + (r.count == 1 ? "" : "s") +
            " left out, the first is " + unit + " " + std::to_string(number) + ": " + r.cause + "\n";
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
  laser.fov_rad = std::fabs(step) * static_cast<double>(first.beams - 1);
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

BeamAngles carmen_fan(std::size_t beams, double aperture_rad) {
  const std::size_t steps = beams % 2 == 0 ? beams : beams - 1;
  const double step = steps == 0 ? aperture_rad : aperture_rad / static_cast<double>(steps);
  return {-aperture_rad / 2.0, step, beams};
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
