#include "bench/tracking/crowd.h"

#include <memory>

#include "tests/support/catch.h"

using namespace jaywalk;

TEST_CASE("the crowd that seeing is timed in fills every track with a mover and leaves the pose right") {
  const auto crowd = std::make_unique<bench::Crowd>();
  bench::CrowdWatcher watcher(*crowd);
  auto& [localizer, tracker] = watcher;
  const auto scan = std::make_unique<LaserScan>();
  WheelState wheels;
  for (std::uint32_t k = 0; k <= 150; ++k) {
    crowd->at(k, *scan, wheels);
    (void)localizer.update(wheels, *scan, {}, tracker.still(), tracker.moving());
    tracker.update(*scan, localizer.map_from_robot_at_scan(), localizer.twist());
  }
  CHECK(scan->beam_count == 1081);
  CHECK(tracker.moving().size() == kMaxTracks);
  // After 10 s at 0.5 rad/s on the circle of 0.3 m.
  CHECK(distance(localizer.map_from_robot_at_scan().position(), direction(5.0) * 0.3) < 0.05);
}
