#include <limits>

#include "bench/tracking/run_folder.h"
#include "firmware/control_setup.h"
#include "firmware/recording/recorder.h"
#include "firmware/recording/tick_record.h"

namespace jaywalk::bench {
namespace {
constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

using Frames = std::map<double, std::vector<Target>>;
using Trails = std::map<std::uint32_t, std::map<double, Vec2>>;  ///< places of each id by time

Frames labels_in_map(const std::filesystem::path& file, const RunFolder& run, const LabelRule& rule) {
  const NumberTable labels(file);
  const bool in_laser = labels.has("t_bag");
  const auto id = labels.names("id");
  const auto t = labels.column(in_laser ? "t_bag" : "t_s"), x = labels.column(in_laser ? "x" : "x_m"),
             y = labels.column(in_laser ? "y" : "y_m");
  const auto walks = labels.has("walks") ? labels.column("walks") : std::vector<double>(labels.rows(), 1.0);
  run.require_own_times(file.string(), t);
  Frames frames;
  for (std::size_t k = 0; k < labels.rows(); ++k) {
    const double when = t[k] - rule.late_s;
    const Pose2 map_from_labels = in_laser ? run.estimate_at(when) * rule.robot_from_laser : Pose2{};
    frames[when].push_back({id[k], map_from_labels * Vec2{x[k], y[k]}, {kUnknown, kUnknown}, walks[k] != 0.0});
  }
  return frames;
}

/// Adds to each frame the targets that have labels before and after it, at most `between_s` apart, and none in it.
void add_those_between(Frames& frames, double between_s) {
  Trails trails;
  for (const auto& [t, targets] : frames) {
    for (const Target& target : targets) trails[target.id][t] = target.position_in_map;
  }
  for (auto& [t, targets] : frames) {
    for (const auto& [id, trail] : trails) {
      const auto after = trail.lower_bound(t);
      if (after == trail.end() || after->first == t || after == trail.begin()) continue;
      const auto before = std::prev(after);
      if (after->first - before->first > between_s) continue;
      const double share = (t - before->first) / (after->first - before->first);
      const Vec2 there = before->second + (after->second - before->second) * share;
      targets.push_back({id, there, {kUnknown, kUnknown}, false});
    }
  }
}

constexpr double kEndsOnM = 0.05;  // a beam that ends this far outside a body ends on it: range noise, five sigma

/// The movers at each tick.
std::map<double, std::vector<Target>> movers_by_time(const std::filesystem::path& file) {
  const NumberTable table(file);
  const auto id = table.names("id");
  const auto t = table.column("t_s"), x = table.column("x_m"), y = table.column("y_m"), vx = table.column("vx_mps"),
             vy = table.column("vy_mps");
  std::map<double, std::vector<Target>> out;
  for (std::size_t k = 0; k < table.rows(); ++k) {
    out[t[k]].push_back({id[k], {x[k], y[k]}, {vx[k], vy[k]}});
  }
  return out;
}

int beams_on(const LaserScan& scan, const Transform2& map_from_laser, const Target& target, double radius_m) {
  int count = 0;
  for (std::size_t b = 0; b < scan.beam_count; ++b) {
    if (!scan.is_hit(b)) continue;
    const Vec2 end = map_from_laser * (direction(scan.angle_rad(b)) * static_cast<double>(scan.range_m[b]));
    count += distance(end, target.position_in_map) < radius_m + kEndsOnM ? 1 : 0;
  }
  return count;
}

}  // namespace

void labelled_frames(const std::filesystem::path& file, const RunFolder& run, const LabelRule& rule,
                     const FrameSink& frame) {
  Frames frames = labels_in_map(file, run, rule);
  add_those_between(frames, rule.between_s);
  for (const auto& [when, targets] : frames) frame(when, targets);
}

void simulated_frames(const std::filesystem::path& folder, const RunFolder& run, const ViewRule& rule,
                      const FrameSink& frame) {
  const auto movers = movers_by_time(folder / "movers.csv");
  const std::string file = (folder / "recording.jwr").string();
  RecordingReader recording(file);
  const Pose2 robot_from_laser = setup_from_text(recording.setup(), file).model.laser.robot_from_laser;
  TickRecord tick;
  std::uint32_t last = 0;
  while (recording.next(tick)) {
    if (tick.scan.sequence == last || tick.scan.stamp == kNever) continue;
    last = tick.scan.sequence;
    const double t_s = to_seconds(tick.scan.stamp);
    const std::optional<Pose2> robot = run.truth_at(t_s);
    auto at = movers.upper_bound(t_s + 1e-6);  // a scan sees movers where they came to by then
    if (!robot || at == movers.begin()) continue;
    std::vector<Target> targets = std::prev(at)->second;
    const Transform2 map_from_laser(*robot * robot_from_laser);
    for (Target& target : targets) {
      target.in_view = distance(target.position_in_map, robot->position()) < rule.range_m &&
                       beams_on(tick.scan, map_from_laser, target, rule.radius_m) >= rule.beams;
    }
    frame(t_s, targets);
  }
}

}  // namespace jaywalk::bench
