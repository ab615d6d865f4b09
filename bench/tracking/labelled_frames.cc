#include <cmath>
#include <limits>

#include "bench/tracking/number_table.h"
#include "bench/tracking/run_folder.h"

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

/// Adds whoever has labels before and after the frame, at most `between_s` apart, and none in it.
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

}  // namespace

void labelled_frames(const std::filesystem::path& file, const RunFolder& run, const LabelRule& rule,
                     const FrameSink& frame) {
  Frames frames = labels_in_map(file, run, rule);
  add_those_between(frames, rule.between_s);
  for (const auto& [when, targets] : frames) frame(when, targets);
}

}  // namespace jaywalk::bench
