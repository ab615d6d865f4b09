#pragma once
// The busiest place that seeing is built for: as many walkers round the robot as there may be tracks.
#include "hal/sim/sensors.h"
#include "hal/types/wheels.h"
#include "planner/localization/localizer.h"
#include "planner/tracking/tracker.h"

namespace jaywalk::bench {
/// A hall of 24 m x 20 m with pillars. A robot drives a small circle in its middle; round it kMaxTracks people walk to
/// and fro, each on a ray of its own, so that nobody ever hides another.
class Crowd {
 public:
  Crowd();

  /// The laser's view and the wheels' angles at scan `k` from 0, 15 a second.
  void at(std::uint32_t k, LaserScan& scan, WheelState& wheels);
  [[nodiscard]] const RobotModel& model() const { return model_; }
  [[nodiscard]] const sim::Walls& walls() const { return walls_; }
  [[nodiscard]] Pose2 start() const;

 private:
  RobotModel model_;
  sim::Walls walls_;
  sim::LaserSim laser_;
  std::vector<sim::Disc> walkers_;
};

/// The controller's part that sees, where the robot in the crowd starts.
struct CrowdWatcher {
  explicit CrowdWatcher(const Crowd& crowd);
  Localizer localizer;
  Tracker tracker;
};

}  // namespace jaywalk::bench
