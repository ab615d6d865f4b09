#pragma once
#include <filesystem>

#include "apps/formats/mcap_writer.h"
#include "apps/formats/ros_topics.h"
#include "firmware/control_setup.h"
#include "firmware/recording/tick_record.h"
#include "hal/types/robot_model.h"
#include "planner/tracking/tracker.h"

namespace jaywalk {

/// A run as an MCAP file, tick by tick, and a metadata.yaml beside it. Thread: one, between ticks.
class RunExporter {
 public:
  /// Throws StartupError when the file cannot be made.
  RunExporter(const std::filesystem::path& file, const ControlSetup& setup);

  /// Messages of one tick, with the tracker's state after it.
  void add(const TickRecord& t, const Tracker& tracker);
  /// Attaches the recording, where there is one (else empty) in one file, so that `jaywalk replay` comes to the same
  /// commands, and ends the files. Throws StartupError where the disk did not take all.
  void finish(const std::filesystem::path& recording);
  [[nodiscard]] const exchange::McapWriter& file() const { return file_; }

 private:
  std::filesystem::path path_;
  exchange::McapWriter file_;
  RobotModel model_;
  exchange::RosTopics topics_;
};

}  // namespace jaywalk
