#pragma once
#include <array>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

#include "hil/far_end/simulated_robot.h"

namespace jaywalk::rig {

/// What the far end is told to do wrong, a line an order:
///
///   emergency left|right CODE    a drive breaks, and says so (CODE as in CiA 301, or its own; hexadecimal)
///   unplug left|right            its cable is pulled; plug puts it back
///   lie left|right INDEX SUB     a CiA 402 drive acknowledges writes to an object (hexadecimal) and ignores them
///   lack left|right INDEX SUB    it has no such object
///   say 701#05                   a frame as another program would send it; eight digits: an extended identifier
///   scanner reset|half           the connection is torn; half a telegram comes
///   scanner halves|silence|garbage|gone SECONDS
///   scanner lose FROM_DEG TO_DEG a sector measures nothing, counter-clockwise in the laser's frame
///   scanner damage SHARE         of all messages so many are damaged, 0 to 1
///   scanner soiled|dirty         it warns of dirt on its window; it says that it can measure no more
///   scanner whole                an end of the last four
///
/// Returns what is wrong with the order; empty where it was obeyed.
[[nodiscard]] std::string obey(std::string_view order, SimulatedRobot& robot);

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
