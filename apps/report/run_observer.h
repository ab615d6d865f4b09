#pragma once
// Observer of a run: its report, tables and pictures.
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "apps/formats/mcap_writer.h"
#include "apps/report/picture/scene.h"
#include "apps/report/run_report.h"
#include "firmware/control_loop.h"
#include "firmware/run_sample.h"

namespace jaywalk {
/// What a run leaves in its folder beside the recording: tables, summary, pictures, and run.mcap where that is wanted.
class RunObserver : public TickObserver {
 public:
  /// `mcap`: also write run.mcap, byte for byte what `jaywalk export` writes; only where loop and report share a
  /// thread.
  explicit RunObserver(bool mcap = false) : wants_mcap_(mcap) {}
  /// The real walls, for the picture; without them it shows what the robot saw.
  void show_walls(std::vector<sim::WallSegment> walls) { walls_ = std::move(walls); }

  void begin(const std::filesystem::path& out, const std::filesystem::path& tables,
             const ControlSetup& setup) override {
    out_ = out;
    setup_ = setup;
    report_.emplace(out, tables);
    if (wants_mcap_) exporter_.emplace(out / "run.mcap", setup);
  }
  void report(const RunSample& sample) override;
  void continue_in(const std::filesystem::path& part, Time last) override { report_->continue_in(part, last); }
  void end_tables() override { report_->end_tables(); }
  [[nodiscard]] std::uintmax_t bytes() const override { return report_->bytes(); }
  [[nodiscard]] std::vector<std::string> complaints() const override { return report_->complaints(); }
  [[nodiscard]] bool is_losing() const override { return !complaints().empty(); }
  /// Writes summary and pictures: run.svg, and run.png where it can be drawn. Returns the one to look at.
  std::filesystem::path finish(const RunEnd& end, const ControlLoop& loop, const Planner& planner) override;

 private:
  /// Keeps the plan of the busiest moment.
  void consider(const ControlLoop& loop, const Planner& planner);
  [[nodiscard]] PictureScene scene(const ControlLoop& loop, const Planner& planner) const;

  bool wants_mcap_;
  std::filesystem::path out_;
  ControlSetup setup_;
  std::optional<RunReport> report_;
  std::optional<RunExporter> exporter_;
  BusiestMoment busiest_;
  std::uint32_t plan_seen_ = 0;
  std::vector<sim::WallSegment> walls_;
  OperatorInput wanted_;  ///< the last tick's, as its pose
  Pose2 map_from_robot_;
};

}  // namespace jaywalk
