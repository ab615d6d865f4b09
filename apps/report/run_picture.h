#pragma once
#include <filesystem>
#include <span>
#include <string>

#include "apps/report/picture/scene.h"
#include "apps/report/run_report.h"
#include "firmware/control_loop.h"

namespace jaywalk {

/// What of a run its picture shows.
struct ShownRun {
  const ControlSetup& setup;
  const RunReport& figures;
  const EvidenceMap& map;
  const char* planner;
  const OperatorInput& wanted;
  std::span<const WallLine> walls;  ///< the real ones; without them the picture shows what the robot saw
};

/// Gathers what run.png and run.svg show while a run goes on. Works outside the tick.
class RunPicture {
 public:
  /// Keeps the plan of the busiest moment.
  void consider(const ControlLoop& loop, const Planner& planner, const Pose2& map_from_robot);
  /// Writes run.png and run.svg into `folder`; run.svg alone where pictures cannot be drawn. Returns the one to look
  /// at.
  std::filesystem::path save(const std::filesystem::path& folder, const std::string& title, const ShownRun& run) const;

 private:
  BusiestMoment busiest_;
  std::uint32_t plan_seen_ = 0;
};

}  // namespace jaywalk
