#pragma once
// A tracker that looks at a room of 12 m x 10 m, scan after scan of a 15 Hz laser.
#include <algorithm>
#include <initializer_list>
#include <limits>

#include "planner/tracking/tracker.h"
#include "tests/perception/room.h"

namespace jaywalk::test {

inline constexpr double kNoiseM = 0.01;

struct Watch {
  Tracker tracker{{.robot_from_laser = {}, .map_side_cells = 256, .map_centre = {}}};
  std::uint32_t scan = 0;
  std::size_t most_moving = 0;
  Fan fan{};

  void see(const Room& room, const Pose2& robot = {}) {
    tracker.update(scan_of(room, robot, ++scan, kNoiseM, fan), robot);
    most_moving = std::max(most_moving, tracker.moving().size());
  }
  /// Somebody in the empty room who is dark all over: his beams return nothing.
  void see_dark(const Disc& disc) {
    Room room = rectangle(12.0, 10.0);
    const LaserScan empty = scan_of(room, {}, ++scan, kNoiseM, fan);
    room.discs = {disc};
    LaserScan seen = scan_of(room, {}, scan, kNoiseM, fan);
    for (std::size_t k = 0; k < seen.beam_count; ++k) {
      if (seen.range_m[k] != empty.range_m[k]) seen.range_m[k] = std::numeric_limits<float>::quiet_NaN();
    }
    tracker.update(seen, {});
  }
  /// Looks at an empty 12 m x 10 m room for two seconds.
  void look_round() {
    for (int k = 0; k < 30; ++k) see(rectangle(12.0, 10.0));
  }
};

inline Room with(std::initializer_list<Disc> discs) {
  Room room = rectangle(12.0, 10.0);
  room.discs = discs;
  return room;
}

}  // namespace jaywalk::test
