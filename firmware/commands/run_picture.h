#pragma once
#include <filesystem>
#include <span>
#include <string>

#include "firmware/commands/loop_runner.h"
#include "firmware/report/picture/scene.h"

namespace jaywalk {

/// Gathers what run.png and run.svg show while a run goes on. Works outside the tick.
class RunPicture {
 public:
  /// Looks at the step just lived through; keeps the plan of the busiest moment.
  void consider(const LoopRunner& runner);
  /// Writes run.png and run.svg into `folder`; run.svg alone where pictures cannot be drawn. `walls` are the real ones;
  /// without them the picture shows what the robot saw. Returns the one to look at.
  std::filesystem::path save(const std::filesystem::path& folder, const std::string& title, const LoopRunner& runner,
                             std::span<const WallLine> walls) const;

 private:
  BusiestMoment busiest_;
  std::uint32_t plan_seen_ = 0;
};

}  // namespace jaywalk
