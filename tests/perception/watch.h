#pragma once
// A tracker that looks at a room of 12 m x 10 m, scan after scan of a 15 Hz laser.
#include <algorithm>
#include <limits>
#include <span>

#include "planner/tracking/tracker.h"
#include "tests/perception/room.h"
#include "tests/support/catch.h"

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
    const LaserScan empty = scan_of(with({}), {}, ++scan, kNoiseM, fan);
    LaserScan seen = scan_of(with({disc}), {}, scan, kNoiseM, fan);
    for (std::size_t k = 0; k < seen.beam_count; ++k) {
      if (seen.range_m[k] != empty.range_m[k]) seen.range_m[k] = std::numeric_limits<float>::quiet_NaN();
    }
    tracker.update(seen, {});
  }
  /// Looks at an empty 12 m x 10 m room for two seconds.
  void look_round() {
    for (int k = 0; k < 30; ++k) see(with({}));
  }
};

/// One that knows the empty room.
struct SettledWatch : Watch {
  SettledWatch() { look_round(); }
};

/// The one track that moves.
inline const Track& only_mover(const Tracker& tracker) {
  REQUIRE(tracker.moving().size() == 1);
  return tracker.moving()[0];
}

/// The first of these tracks within `within_m` of a place, or none.
inline const Track* track_near(std::span<const Track> tracks, Vec2 place, double within_m) {
  const auto it = std::ranges::find_if(
      tracks, [&](const Track& track) { return distance(track.position_in_map, place) < within_m; });
  return it == tracks.end() ? nullptr : &*it;
}

/// Of the cells from `low` up to but not `beyond`.
inline int occupied_cells(const EvidenceMap& map, CellIndex low, CellIndex beyond) {
  int count = 0;
  for (int j = low.j; j < beyond.j; ++j) {
    for (int i = low.i; i < beyond.i; ++i) count += map.occupied({i, j}) ? 1 : 0;
  }
  return count;
}

}  // namespace jaywalk::test
