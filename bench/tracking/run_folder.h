#pragma once
// Run folder (docs/reference/outputs.md) and its tables, as frames to score, and poses to compare it with.
#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "bench/tracking/track_score.h"

namespace jaywalk::bench {
/// A comma-separated table, plain or .gz, with names of columns in the first line. Columns are looked at when asked
/// for: others may hold words. Everything throws StartupError "FILE:LINE: cause; remedy".
class NumberTable {
 public:
  /// Throws for what cannot be read, has no first line, or has a row of more or fewer cells than that.
  explicit NumberTable(const std::filesystem::path& file);

  [[nodiscard]] std::size_t rows() const { return rows_.size(); }
  [[nodiscard]] bool has(std::string_view column) const { return std::ranges::count(columns_, column) > 0; }
  /// Throws where there is no such column, and for a cell that is no number of a place, time or speed.
  [[nodiscard]] std::vector<double> column(std::string_view name) const;
  /// The same; NaN (unknown) for cells that are empty or "nan".
  [[nodiscard]] std::vector<double> column_where_known(std::string_view name) const;
  /// Whole numbers from 0 on that fit into 32 bits.
  [[nodiscard]] std::vector<std::uint32_t> names(std::string_view column) const;

 private:
  struct Row {
    std::size_t line = 0;
    std::string text;
  };
  [[nodiscard]] std::size_t place_of(std::string_view column) const;
  /// The column's cells as `value_of` has them; throws with `remedy` where it has none.
  template <class T>
  [[nodiscard]] std::vector<T> read(std::string_view column, std::optional<T> (*value_of)(std::string_view cell),
                                    const char* remedy) const;
  [[noreturn]] void refuse(std::size_t line, const std::string& cause, const std::string& remedy) const;

  std::string file_;
  std::vector<std::string> columns_;
  std::vector<Row> rows_;
};

/// The tracks and poses of `jaywalk sim` or `jaywalk replay`. Errors: StartupError.
class RunFolder {
 public:
  explicit RunFolder(const std::filesystem::path& folder);

  /// The tracks of the scan nearest to `t_s`; none where no scan within 30 ms left any.
  [[nodiscard]] std::vector<Hypothesis> tracks_at(double t_s, bool moving_only) const;
  /// Where the controller thought it was in the first tick at or after `t_s`; the last pose after the end.
  [[nodiscard]] Pose2 estimate_at(double t_s) const { return tick_at(t_s).estimate; }
  /// Where it really was at the end of that tick; nothing for a replay.
  [[nodiscard]] std::optional<Pose2> truth_at(double t_s) const {
    return has_truth_ ? std::optional(tick_at(t_s).truth) : std::nullopt;
  }
  [[nodiscard]] bool has_truth() const { return has_truth_; }  ///< false for a replay, and a run on a robot
  /// Throws StartupError where most of the times that stand in `file` do not lie in the run, or there are none: another
  /// recording's would be scored as if they belonged.
  void require_own_times(const std::string& file, const std::vector<double>& times) const;
  [[nodiscard]] double minutes() const { return (ticks_.back().t_s - ticks_.front().t_s) / 60.0; }
  /// Every time at which there are tracks, rising.
  [[nodiscard]] std::vector<double> track_times() const;
  [[nodiscard]] std::vector<PosePair> poses() const;  ///< estimate and truth, a tick each; empty for a replay

 private:
  struct Tick {
    double t_s = 0.0;
    Pose2 estimate, truth;
  };
  [[nodiscard]] const Tick& tick_at(double t_s) const;

  std::map<double, std::vector<Hypothesis>> tracks_;
  std::vector<Tick> ticks_;
  bool has_truth_ = false;
};

/// Called with each frame.
using FrameSink = std::function<void(double t_s, const std::vector<Target>&)>;

/// What counts as in view in a simulation: nearer than `range_m`, and hit by at least `beams` beams of the scan.
struct ViewRule {
  double range_m = 10.0;
  double radius_m = 0.27;
  int beams = 3;
};

/// The movers of a simulation at every scan of its recording, by movers.csv.
void simulated_frames(const std::filesystem::path& folder, const RunFolder& run, const ViewRule& rule,
                      const FrameSink& frame);

/// How labels are read.
struct LabelRule {
  Pose2 robot_from_laser{};  ///< for labels in the laser's frame
  double between_s = 0.0;  ///< whoever has labels before and after a frame, at most so far apart, is taken to be there
  double late_s = 0.0;     ///< a label's time is so long after the stamp of the scan that it holds for
};

/// Labels: t_s,id,x_m,y_m in the map, or t_bag,id,x,y in the laser's frame; a frame for every time that stands in it.
/// Where a column `walks` is 0, and for those who are there between their labels, finding somebody is neither right nor
/// wrong (Target::in_view). Velocities are not known.
void labelled_frames(const std::filesystem::path& file, const RunFolder& run, const LabelRule& rule,
                     const FrameSink& frame);

/// A recording's poses as others corrected them, against the run's and against the wheels' alone.
struct ReferencePoses {
  std::vector<PosePair> of_run, of_wheels;
};

/// From the FLASER lines of a corrected CARMEN log that the run replayed, or from a table `t,x,y,h` (.csv, .csv.gz; s,
/// m, rad), which knows no wheels. Throws StartupError when there are none.
[[nodiscard]] ReferencePoses reference_poses(const std::filesystem::path& log, const RunFolder& run);

}  // namespace jaywalk::bench
