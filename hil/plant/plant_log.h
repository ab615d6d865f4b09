#pragma once
#include <array>
#include <filesystem>
#include <fstream>
#include <string>

#include "hil/far_end/simulated_robot.h"

namespace jaywalk::rig {

/// What happened at the far end, for judging a run: a line an event, "SECONDS words", seconds since start.
///
/// A drive's state that changes; the wheels begin to turn, come to rest and how; at the end what the world knows.
/// A rest says how long after the controller's last heartbeat it came, where that is what ended the drive:
/// "at rest, 513 ms after the controller was last heard, from 0.612 m/s".
class PlantLog {
 public:
  /// Throws StartupError where the file cannot be written.
  PlantLog(const std::filesystem::path& file, Time start);
  void event(Time now, const std::string& words);
  /// The far end itself was held up: by this machine, not by whom it judges.
  void late(Time now, Duration by);
  void follow(SimulatedRobot& robot, Time now);
  void finish(SimulatedRobot& robot, Time now);

 private:
  void follow_drive(SimulatedRobot& robot, std::size_t side, Time now);
  void follow_motion(SimulatedRobot& robot, Time now);

  std::ofstream file_;
  Time start_;
  std::array<std::string, 2> state_{"off", "off"};
  std::array<Time, 2> heard_{kNever, kNever};
  bool moving_ = false;
  double speed_heard_mps_ = 0.0;  ///< of the faster wheel, at the controller's last heartbeat
  double way_m_ = 0.0;
  Vec2 place_{};
  bool has_place_ = false;
};

}  // namespace jaywalk::rig
