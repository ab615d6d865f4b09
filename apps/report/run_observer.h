#pragma once
#include <optional>
#include <vector>

#include "apps/formats/run_exporter.h"
#include "apps/report/run_picture.h"
#include "apps/report/run_report.h"
#include "firmware/run_sample.h"

namespace jaywalk {

/// What a run leaves in its folder beside the recording: tables, summary, pictures, and run.mcap where that is wanted.
class RunObserver : public TickObserver {
 public:
  /// `mcap`: also write run.mcap, byte for byte what `jaywalk export` writes; only where loop and report share a
  /// thread.
  explicit RunObserver(bool mcap = false) : wants_mcap_(mcap) {}
  /// The real walls, for the picture; without them it shows what the robot saw.
  void show_walls(std::vector<WallLine> walls) { walls_ = std::move(walls); }

  void begin(const std::filesystem::path& out, const std::filesystem::path& tables, const ControlSetup& setup) override;
  void report(const RunSample& sample) override;
  void continue_in(const std::filesystem::path& part, Time last) override { report_->continue_in(part, last); }
  void end_tables() override { report_->end_tables(); }
  [[nodiscard]] std::uintmax_t bytes() const override { return report_->bytes(); }
  [[nodiscard]] std::vector<std::string> complaints() const override { return report_->complaints(); }
  [[nodiscard]] bool is_losing() const override { return report_->is_losing(); }
  /// Returns the picture.
  std::filesystem::path finish(const RunEnd& end, const ControlLoop& loop, const Planner& planner) override;

 private:
  bool wants_mcap_;
  std::filesystem::path out_;
  ControlSetup setup_;
  std::optional<RunReport> report_;
  std::optional<RunExporter> exporter_;
  RunPicture picture_;
  std::vector<WallLine> walls_;
  OperatorInput wanted_;  ///< the last tick's, as its pose
  Pose2 map_from_robot_;
};

}  // namespace jaywalk
