// Recordings whose wheels were made from the poses that others corrected afterwards: how far the scans pull the robot
// off them.
#include <cstdio>
#include <vector>

#include "apps/formats/logs/log_replay.h"
#include "bench/tracking/track_score.h"
#include "planner/localization/localizer.h"
#include "planner/tracking/tracker.h"
#include "tests/recording/recordings.h"
#include "tests/support/catch.h"

using namespace jaywalk;
using namespace jaywalk::bench;

namespace {

constexpr Duration kTick = std::chrono::milliseconds(20);

/// A pair a scan, from a start that is `elsewhere` in the map: walls lie across other cells there.
std::vector<PosePair> follow(const std::filesystem::path& carmen, const Pose2& elsewhere) {
  sim::LogReplay replay(sim::load_carmen(carmen));
  const std::vector<sim::OdometryPose>& corrected = replay.log().odometry;
  REQUIRE(corrected.size() == replay.log().scans.size());
  const Pose2 start = elsewhere * replay.start_pose();
  Localizer localizer({.map_from_robot_at_start = start, .drive = replay.drive(), .robot_from_laser = {}});
  Tracker tracker({.robot_from_laser = {}, .map_centre = start.position()});
  std::vector<PosePair> drive;
  const Hal hal = replay.hal();
  std::uint32_t last = 0;
  for (Time now = replay.start_time(); !replay.ended(); now += kTick) {
    hal.clock.sleep_until(now);
    const LaserScan& scan = hal.laser.latest();
    static_cast<void>(localizer.update(hal.drive.latest(), scan, {}, tracker.still(), tracker.moving()));
    if (scan.sequence == last) continue;
    last = scan.sequence;
    const Pose2& seen_from = localizer.map_from_robot_at_scan();
    tracker.update(scan, seen_from, localizer.twist());
    drive.push_back({seen_from, corrected[last - 1].pose});
  }
  return drive;
}

/// Means over eight starts, of which the first is the recording's own. Prints each.
RelativeError mean_of_starts(const std::filesystem::path& carmen) {
  constexpr int kStarts = 8;
  RelativeError mean;
  for (int k = 0; k < kStarts; ++k) {
    const RelativeError one = relative_error(follow(carmen, {0.037 * k, 0.071 * k, 0.8 * k}), 10.0, 1.0);
    CHECK(one.stretches > 300);
    std::printf("start %d: %.2f %%, %.2f degrees\n", k, one.translation_percent, one.heading_deg);
    mean.translation_percent += one.translation_percent / kStarts;
    mean.heading_deg += one.heading_deg / kStarts;
  }
  std::printf("mean: %.2f %%, %.2f degrees\n", mean.translation_percent, mean.heading_deg);
  return mean;
}

}  // namespace

TEST_CASE("over 10 m scans pull the robot off wheels made from corrected poses by half a percent at most") {
  // 0.6 degrees are the reference's own: docs/explanation/results.md#tracking-and-poses.
  const auto [carmen, most_deg] = GENERATE(table<const char*, double>(
      {{"carmen/freiburg-079-corrected.log.gz", 0.6}, {"carmen/intel-corrected.log.gz", 0.25}}));
  const auto file = recording(carmen);
  if (!file) return;
  const RelativeError error = mean_of_starts(*file);
  CHECK(error.translation_percent < 0.5);
  CHECK(error.heading_deg < most_deg);
}
