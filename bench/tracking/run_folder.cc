#include "bench/tracking/run_folder.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "apps/formats/logs/log_checks.h"
#include "firmware/control_setup.h"
#include "firmware/recording/recorder.h"
#include "hal/shown_text.h"
#include "hal/types/errors.h"
#include "hal/types/laser_scan.h"

namespace jaywalk::bench {
namespace {
constexpr double kMost = 1e10;  // seconds since 1970 are 2e9

/// Cell `k` of a line, without blanks round it; the line has that many.
std::string_view cell_of(std::string_view line, std::size_t k) {
  for (; k > 0; --k) line.remove_prefix(line.find(',') + 1);
  const std::string_view cell = line.substr(0, line.find(','));
  const std::size_t first = cell.find_first_not_of(" \t"), last = cell.find_last_not_of(" \t");
  return first == std::string_view::npos ? std::string_view() : cell.substr(first, last + 1 - first);
}

std::optional<double> number_of(std::string_view cell) {
  const auto value = number_in<double>(cell);
  return value && std::fabs(*value) <= kMost ? value : std::nullopt;
}

std::optional<double> number_where_known(std::string_view cell) {
  return cell.empty() || cell == "nan" ? std::numeric_limits<double>::quiet_NaN() : number_of(cell);
}

std::size_t cells_in(std::string_view line) {
  return 1 + static_cast<std::size_t>(std::count(line.begin(), line.end(), ','));
}

constexpr double kSameScanS = 0.03;  // stamps were rounded when they were written; scans are 25 ms apart or more
constexpr double kNearRunS = 1.0;    // labels may be a little late

bool is_table(const std::filesystem::path& file) {
  return (file.extension() == ".gz" ? file.stem() : file).extension() == ".csv";
}

ReferencePoses of_table(const std::filesystem::path& file, const RunFolder& run) {
  const NumberTable table(file);
  const auto t = table.column("t"), x = table.column("x"), y = table.column("y"), h = table.column("h");
  run.require_own_times(file.string(), t);
  ReferencePoses out;
  for (std::size_t k = 0; k < table.rows(); ++k) out.of_run.push_back({run.estimate_at(t[k]), {x[k], y[k], h[k]}});
  return out;
}

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

NumberTable::NumberTable(const std::filesystem::path& file) : file_(file.string()) {
  sim::LineFile lines(file, "give a table, .csv or .csv.gz");
  if (!lines.next_line() || lines.text().empty()) refuse(1, "no names of columns", "the first line names the columns");
  for (std::size_t k = 0; k < cells_in(lines.text()); ++k) columns_.emplace_back(cell_of(lines.text(), k));
  while (lines.next_line()) {
    if (lines.text().empty()) continue;
    if (const std::size_t cells = cells_in(lines.text()); cells != columns_.size()) {
      refuse(lines.line(), std::to_string(cells) + " cells", "give one a column, " + std::to_string(columns_.size()));
    }
    rows_.push_back({lines.line(), lines.text()});
  }
}

void NumberTable::refuse(std::size_t line, const std::string& cause, const std::string& remedy) const {
  throw StartupError(file_ + ":" + std::to_string(line) + ": " + cause, remedy);
}

std::size_t NumberTable::place_of(std::string_view column) const {
  const auto at = std::ranges::find(columns_, column);
  if (at == columns_.end()) refuse(1, "no column \"" + std::string(column) + "\"", "name it in the first line");
  return static_cast<std::size_t>(at - columns_.begin());
}

template <class T>
std::vector<T> NumberTable::read(std::string_view column, std::optional<T> (*value_of)(std::string_view cell),
                                 const char* remedy) const {
  const std::size_t place = place_of(column);
  std::vector<T> values;
  for (const Row& row : rows_) {
    const std::string_view cell = cell_of(row.text, place);
    const std::optional<T> value = value_of(cell);
    if (!value) refuse(row.line, "'" + shown(cell) + "' in the column " + std::string(column), remedy);
    values.push_back(*value);
  }
  return values;
}

std::vector<double> NumberTable::column(std::string_view name) const {
  return read<double>(name, number_of, "give metres and seconds");
}

std::vector<double> NumberTable::column_where_known(std::string_view name) const {
  return read<double>(name, number_where_known, "give metres and seconds");
}

std::vector<std::uint32_t> NumberTable::names(std::string_view column) const {
  return read<std::uint32_t>(column, number_in<std::uint32_t>, "give whole numbers from 0 on");
}

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

void RunFolder::require_own_times(const std::string& file, const std::vector<double>& times) const {
  const double first = ticks_.front().t_s - kNearRunS, last = ticks_.back().t_s + kNearRunS;
  const auto within = std::count_if(times.begin(), times.end(), [&](double t) { return t >= first && t <= last; });
  if (!times.empty() && 2 * static_cast<std::size_t>(within) >= times.size()) return;
  throw StartupError(
      file + ": " + std::to_string(within) + " of its " + std::to_string(times.size()) + " times lie in the run",
      "give the file that belongs to what was replayed");
}

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

ReferencePoses reference_poses(const std::filesystem::path& log, const RunFolder& run) {
  if (is_table(log)) return of_table(log, run);
  ReferencePoses out;
  std::vector<double> times;
  sim::LineFile file(log);
  while (file.next()) {
    if (file.words().front() != "FLASER") continue;
    // After the ranges: x y heading, the wheels' the same, t host t. The replay goes by the first of the times.
    const std::size_t first = file.words().size() > 1 ? 2 + file.count(1, kMaxBeams) : 2;
    if (file.words().size() < first + 9) file.refuse("the line is too short", "end FLASER lines with poses and times");
    const Pose2 corrected = file.pose(first);
    times.push_back(file.seconds(first + 6));
    out.of_run.push_back({run.estimate_at(times.back()), corrected});
    out.of_wheels.push_back({file.pose(first + 3), corrected});
  }
  if (out.of_run.empty())
    throw StartupError(log.string() + ": no FLASER lines", "give the CARMEN log that was replayed");
  run.require_own_times(log.string(), times);
  return out;
}

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
