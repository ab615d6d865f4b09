#include "tests/perception/recordings.h"

#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <sstream>

namespace jaywalk::recordings {

std::optional<std::filesystem::path> find(const std::string& file) {
  const char* from_user = std::getenv("JAYWALK_DATA");
  const std::filesystem::path folder = from_user != nullptr ? from_user : JAYWALK_DATA_BESIDE;
  if (std::filesystem::exists(folder / file)) return folder / file;
  std::cout << "skipped: no data (" << file << ")\n";
  return std::nullopt;
}

std::vector<std::string> lines_of(const std::filesystem::path& file) {
  std::vector<std::string> lines;
  const gzFile in = gzopen(file.c_str(), "rb");
  std::vector<char> buffer(1 << 16);
  while (in != nullptr && gzgets(in, buffer.data(), static_cast<int>(buffer.size())) != nullptr) {
    lines.emplace_back(buffer.data());
  }
  if (in != nullptr) gzclose(in);
  return lines;
}

namespace {

void read_ranges(const char* text, std::uint32_t count, LaserScan& scan) {
  scan.beam_count = count;
  for (std::uint32_t k = 0; k < count; ++k) {
    char* end = nullptr;
    scan.range_m[k] = std::strtof(text, &end);
    text = end;
  }
}

/// Reads `count` numbers and moves `text` behind them.
std::vector<double> numbers(const char*& text, int count) {
  std::vector<double> out;
  for (int k = 0; k < count; ++k) {
    char* end = nullptr;
    out.push_back(std::strtod(text, &end));
    text = end;
  }
  return out;
}

/// One scan a turn, at most ten times a second: what a replay takes these lasers for (sim::RecordedLog).
void spin(std::vector<LaserScan>& scans) {
  const double seconds = to_seconds(scans.back().stamp - scans.front().stamp);
  const double turn_s = std::min(0.1, seconds / static_cast<double>(scans.size() - 1));
  for (LaserScan& scan : scans) {
    const double fan = static_cast<double>(scan.angle_step_rad) * (scan.beam_count - 1);
    scan.sweep = duration_from_seconds(turn_s * fan / (2.0 * kPi));
  }
}

}  // namespace

Recording read_scan_odom(const std::filesystem::path& scans, const std::optional<std::filesystem::path>& odometry) {
  Recording out;
  for (const std::string& line : lines_of(scans)) {
    if (line[0] == '#') continue;
    const char* text = line.c_str();
    const std::vector<double> head = numbers(text, 6);
    LaserScan scan;
    scan.stamp = time_from_seconds(head[0]);
    scan.sequence = static_cast<std::uint32_t>(out.scans.size() + 1);
    scan.first_angle_rad = static_cast<float>(head[1]);
    scan.angle_step_rad = static_cast<float>(head[2]);
    scan.range_min_m = static_cast<float>(head[3]);
    scan.range_max_m = static_cast<float>(head[4]);
    read_ranges(text, static_cast<std::uint32_t>(head[5]), scan);
    out.scans.push_back(scan);
  }
  spin(out.scans);
  if (!odometry) return out;
  for (const std::string& line : lines_of(*odometry)) {
    if (line[0] == '#') continue;
    const char* text = line.c_str();
    const std::vector<double> row = numbers(text, 4);
    out.odometry.push_back({row[0], {row[1], row[2], row[3]}});
  }
  return out;
}

Recording read_carmen(const std::filesystem::path& file) {
  Recording out;
  for (const std::string& line : lines_of(file)) {
    if (line.rfind("FLASER ", 0) != 0) continue;
    const char* text = line.c_str() + 7;
    const auto count = static_cast<std::uint32_t>(numbers(text, 1)[0]);
    LaserScan scan;
    read_ranges(text, count, scan);
    for (std::uint32_t k = 0; k < count; ++k) (void)numbers(text, 1);
    const std::vector<double> poses = numbers(text, 6);
    const double t = std::strtod(line.c_str() + line.rfind(' '), nullptr);
    scan.stamp = time_from_seconds(t);
    scan.sequence = static_cast<std::uint32_t>(out.scans.size() + 1);
    scan.first_angle_rad = static_cast<float>(-kPi / 2);
    scan.angle_step_rad = static_cast<float>(kPi / count);
    scan.range_min_m = 0.05F;
    scan.range_max_m = 40.0F;
    out.scans.push_back(scan);
    out.reference.push_back({t, {poses[0], poses[1], poses[2]}});
    out.odometry.push_back({t, {poses[3], poses[4], poses[5]}});
  }
  return out;
}

std::vector<Label> read_labels(const std::filesystem::path& file) {
  std::vector<Label> out;
  const std::vector<std::string> lines = lines_of(file);
  const bool says_who_walks = !lines.empty() && lines.front().find("walks") != std::string::npos;
  for (const std::string& line : lines) {
    std::istringstream row(line);
    Label label;
    char comma = ',';
    if (!(row >> label.t_s >> comma >> label.id >> comma >> label.in_laser.x >> comma >> label.in_laser.y)) continue;
    double last = 0.0;
    label.walks = !says_who_walks || (row >> comma >> last && last != 0.0);
    out.push_back(label);
  }
  return out;
}

WheelState WheelsFromPoses::reading(const StampedPose& at) {
  if (wheels_.sequence > 0) {
    const Pose2 step = inverse(last_.pose) * at.pose;
    const double half = 0.5 * step.heading;
    const double chord = norm(step.position()) * (dot(step.position(), direction(half)) < 0.0 ? -1.0 : 1.0);
    const double arc = std::fabs(half) < 1e-6 ? chord : chord * half / sin(half);
    const double spread = half * drive_.track_width_m;
    const double left = (arc - spread) / drive_.wheel_radius_m, right = (arc + spread) / drive_.wheel_radius_m;
    const double dt = at.t_s - last_.t_s;
    wheels_.left_rad += left;
    wheels_.right_rad += right;
    wheels_.left_radps = dt > 0.0 ? left / dt : 0.0;
    wheels_.right_radps = dt > 0.0 ? right / dt : 0.0;
  }
  wheels_.stamp = time_from_seconds(at.t_s);
  wheels_.sequence += 1;
  last_ = at;
  return wheels_;
}

}  // namespace jaywalk::recordings
