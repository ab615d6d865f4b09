#include "bench/tracking/run_folder.h"

#include <algorithm>
#include <cmath>

#include "bench/tracking/number_table.h"
#include "hal/types/errors.h"

namespace jaywalk::bench {
namespace {

constexpr double kSameScanS = 0.03;  // stamps were rounded when they were written; scans are 25 ms apart or more
constexpr double kNearRunS = 1.0;    // labels may be a little late

}  // namespace

RunFolder::RunFolder(const std::filesystem::path& folder) {
  const NumberTable tracks(folder / "tracks.csv");
  const auto id = tracks.names("id");
  const auto t = tracks.column("t_s"), x = tracks.column("x_m"), y = tracks.column("y_m"), vx = tracks.column("vx_mps"),
             vy = tracks.column("vy_mps"), moving = tracks.column("moving");
  const auto std_m = tracks.has("std_m") ? tracks.column("std_m") : std::vector<double>(tracks.rows(), std::nan(""));
  for (std::size_t k = 0; k < tracks.rows(); ++k) {
    tracks_[t[k]].push_back({id[k], {x[k], y[k]}, {vx[k], vy[k]}, moving[k] != 0.0, std_m[k]});
  }
  const NumberTable robot(folder / "robot.csv");
  const auto rt = robot.column("t_s"), ex = robot.column("est_x_m"), ey = robot.column("est_y_m"),
             eh = robot.column("est_heading_rad"), tx = robot.column_where_known("x_m"),
             ty = robot.column_where_known("y_m"), th = robot.column_where_known("heading_rad");
  for (std::size_t k = 0; k < robot.rows(); ++k) {
    ticks_.push_back({rt[k], {ex[k], ey[k], eh[k]}, {tx[k], ty[k], th[k]}});
  }
  if (ticks_.empty()) throw StartupError((folder / "robot.csv").string() + ": no rows", "give the folder of a run");
  has_truth_ = !std::isnan(ticks_.front().truth.x);
}

std::vector<Hypothesis> RunFolder::tracks_at(double t_s, bool moving_only) const {
  auto at = tracks_.lower_bound(t_s - kSameScanS);
  if (at == tracks_.end() || at->first > t_s + kSameScanS) return {};
  const auto next = std::next(at);
  if (next != tracks_.end() && std::fabs(next->first - t_s) < std::fabs(at->first - t_s)) at = next;
  std::vector<Hypothesis> out;
  std::copy_if(at->second.begin(), at->second.end(), std::back_inserter(out),
               [&](const Hypothesis& h) { return h.moving || !moving_only; });
  return out;
}

const RunFolder::Tick& RunFolder::tick_at(double t_s) const {
  const auto at = std::lower_bound(ticks_.begin(), ticks_.end(), t_s - 1e-6,
                                   [](const Tick& tick, double t) { return tick.t_s < t; });
  return at == ticks_.end() ? ticks_.back() : *at;
}

Pose2 RunFolder::estimate_at(double t_s) const { return tick_at(t_s).estimate; }

std::optional<Pose2> RunFolder::truth_at(double t_s) const {
  return has_truth_ ? std::optional(tick_at(t_s).truth) : std::nullopt;
}

void RunFolder::require_own_times(const std::string& file, const std::vector<double>& times) const {
  const double first = ticks_.front().t_s - kNearRunS, last = ticks_.back().t_s + kNearRunS;
  const auto within = std::count_if(times.begin(), times.end(), [&](double t) { return t >= first && t <= last; });
  if (!times.empty() && 2 * static_cast<std::size_t>(within) >= times.size()) return;
  throw StartupError(
      file + ": " + std::to_string(within) + " of its " + std::to_string(times.size()) + " times lie in the run",
      "give the file that belongs to what was replayed");
}

double RunFolder::minutes() const { return (ticks_.back().t_s - ticks_.front().t_s) / 60.0; }

std::vector<double> RunFolder::track_times() const {
  std::vector<double> out;
  for (const auto& [t, tracks] : tracks_) out.push_back(t);
  return out;
}

std::vector<PosePair> RunFolder::poses() const {
  std::vector<PosePair> out;
  for (const Tick& tick : ticks_) {
    if (has_truth_) out.push_back({tick.estimate, tick.truth});
  }
  return out;
}

}  // namespace jaywalk::bench
