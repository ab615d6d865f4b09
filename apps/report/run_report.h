#pragma once
// Gathers a run tick by tick and leaves its tables and figures behind, in room that it holds on the disk.
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "apps/report/csv_file.h"
#include "apps/report/distribution.h"
#include "apps/report/drive_metrics.h"
#include "apps/report/picture/scene.h"
#include "firmware/run_sample.h"

namespace jaywalk {

/// robot.csv, movers.csv and tracks.csv (columns: docs/reference/outputs.md), a tick at a time; on the disk within
/// kLongestWait of the ticks' time. A table that the disk does not take ends with its last whole row; the others go on.
class RunTables {
 public:
  static constexpr Duration kLongestWait = std::chrono::milliseconds(500);

  /// Throws StartupError when `folder` cannot be written to.
  explicit RunTables(const std::filesystem::path& folder);
  void add(const RunSample& sample);
  void close() {
    for (CsvFile* const table : {&robot_, &movers_, &tracks_}) table->close();
  }
  /// Goes on after `before`, which has the tracks of the last scan.
  void follow(const RunTables& before) noexcept { scan_count_ = before.scan_count_; }
  /// Of all three, with what is not on the disk yet.
  [[nodiscard]] std::uintmax_t bytes() const noexcept { return robot_.bytes() + movers_.bytes() + tracks_.bytes(); }
  /// AppendFile's, of each table that the disk did not take whole.
  [[nodiscard]] std::vector<std::string> complaints() const;

 private:
  void add_robot(const RunSample& sample);
  void add_movers(const RunSample& sample);
  void add_tracks(const RunSample& sample);

  CsvFile robot_, movers_, tracks_;
  Time written_at_ = kNever;
  std::uint32_t scan_count_ = 0;
};

/// Works outside the tick: it allocates and writes. Its memory has bounds, however long the run. Not thread-safe.
///
/// Lengths, turns and speeds are the world's where truth is given, else the controller's estimate
/// (summary.json says which: "measured_on"); what only a world can know is null without it.
class RunReport {
 public:
  /// `folder` is made when missing; an earlier run's summary.json, run.png and run.svg in it are removed, so that they
  /// cannot stand beside this run's tables. An empty path keeps the figures and writes no files. Throws
  /// StartupError when it cannot be written to.
  explicit RunReport(const std::filesystem::path& folder) : RunReport(folder, folder) {}
  /// The same with the tables in a folder of their own.
  RunReport(const std::filesystem::path& folder, const std::filesystem::path& tables);

  void add(const RunSample& sample);
  /// Rows of ticks later than `last` go to tables in another folder. Throws StartupError where these cannot be made.
  void continue_in(const std::filesystem::path& tables, Time last);
  /// No more rows.
  void end_tables() {
    if (next_tables_) turn_to_next_tables();
    tables_.reset();
  }
  /// Of the tables that the next tick goes to.
  [[nodiscard]] std::uintmax_t bytes() const {
    return next_tables_ ? next_tables_->bytes() : tables_ ? tables_->bytes() : 0;
  }
  /// What the disk did not take of the tables, a line each; empty: it has taken all so far.
  [[nodiscard]] std::vector<std::string> complaints() const;
  /// Closes the tables, writes summary.json and returns its text. Call once, after the last tick. Throws StartupError
  /// where the disk does not take the summary.
  std::string finish(const RunEnd& end);

  [[nodiscard]] double path_length_m() const { return shape_.length_m(); }
  [[nodiscard]] double duration_s() const { return ticks_ == 0 ? 0.0 : to_seconds(last_ - first_); }

  /// For the picture: the robot's way (of truth where there is one, else estimated), the movers' and the tracks'.
  [[nodiscard]] const std::vector<DrivenPose>& driven() const { return driven_.poses(); }
  [[nodiscard]] std::vector<Trail> mover_trails() const { return movers_.trails(); }
  [[nodiscard]] std::vector<Trail> track_trails() const { return tracks_.trails(); }

 private:
  void turn_to_next_tables();
  void add_truth(const TrueState& truth, Time now);
  void add_tracks(const RunSample& sample);
  void add_faults(Reason reasons);
  void add_way(const Pose2& pose, const RunSample& sample);
  [[nodiscard]] std::string summary(const RunEnd& end) const;

  std::filesystem::path folder_;
  std::unique_ptr<RunTables> tables_, next_tables_;
  Time last_of_tables_ = kNever;   ///< where there are next ones
  std::vector<std::string> lost_;  ///< complaints of tables that are closed
  std::shared_ptr<void> reserve_;  ///< room on the disk, held until the summary is written
  PathShape shape_;
  Smoothness smoothness_;
  Distribution plan_ms_, plan_processor_ms_, plan_device_ms_, tick_ms_;
  DrivenWay driven_;
  TrailBook movers_, tracks_;
  GrantedShare granted_;
  LoopCount loops_;
  std::optional<DetourCount> detours_;  ///< where the loop's own thread reports
  std::uint64_t ticks_ = 0, faults_ = 0;
  bool is_faulty_ = false;  ///< in the last tick
  Time first_ = kNever, last_ = kNever;
  std::optional<TrueState> truth_;  ///< the last one, without its movers, and the least clearances so far
};

}  // namespace jaywalk
