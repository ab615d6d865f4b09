// Plans along a recorded way, among what its laser saw: the CPU's bytes, on the emulated device.
#include <algorithm>

#include "apps/formats/logs/log_replay.h"
#include "planner/tracking/tracker.h"
#include "tests/cuda/cuda_rig.h"
#include "tests/planner/same_bytes.h"
#include "tests/recording/recordings.h"

using namespace jaywalk;
using namespace jaywalk::test;
using emulated::device;

namespace {

/// Where the odometry says that the robot was at a scan.
Pose2 pose_at(const sim::RecordedLog& log, std::size_t scan) {
  const auto later = std::upper_bound(log.odometry.begin(), log.odometry.end(), log.scans[scan].stamp,
                                      [](Time t, const sim::OdometryPose& o) { return t < o.stamp; });
  return later == log.odometry.begin() ? later->pose : std::prev(later)->pose;
}

/// Plans in windows of `side` cells on every `stride`-th of `count` scans from the middle of the recording on, towards
/// where the robot was ten scans later, or ninety: then outside a small window.
void check_recorded(const std::filesystem::path& file, const emulated::Properties& properties, std::int32_t side,
                    std::size_t count, std::size_t stride) {
  device().power_on(properties);
  const auto cpu = paper::make_cpu_paper_planner(window(side)), gpu = cuda_paper_planner(window(side));
  sim::LogReplay replay(sim::load_carmen(file));
  const sim::RecordedLog& log = replay.log();
  const Hal hal = replay.hal();
  const std::size_t first = log.scans.size() / 2;
  PerceptionConfig seeing;
  seeing.map_centre = pose_at(log, first).position();
  Tracker tracker(seeing);
  int planned = 0;
  for (std::size_t k = first; k < first + count; ++k) {
    hal.clock.sleep_until(log.scans[k].stamp);
    const LaserScan& scan = hal.laser.latest();
    tracker.update(scan, pose_at(log, k));
    if ((k - first) % stride != stride - 1) continue;
    PlanRequest request;
    request.stamp = scan.stamp;
    request.map_from_robot = pose_at(log, k);
    request.goal_in_map = pose_at(log, k + (k % 2 == 0 ? 10 : 90)).position();
    request.speed_mps = 0.6;
    request.still = &tracker.still();
    request.moving = tracker.moving();
    request.standing = tracker.standing();
    planned += check_plan(*cpu, *gpu, request) ? 1 : 0;
  }
  CHECK(planned > 0);
}

}  // namespace

TEST_CASE("emulated: plans on recorded ticks have the CPU's bytes") {
  const auto file = recording("carmen/freiburg-079-corrected.log.gz");
  if (!file) return;
  check_recorded(*file, properties_of(4), 64, 40, 10);
}

TEST_CASE("emulated at length: plans of 256 cells on recorded ticks have the CPU's bytes", "[.large]") {
  const auto file = recording("carmen/intel-corrected.log.gz");
  if (!file) return;
  for (std::uint64_t seed = 8; seed <= 9; ++seed) check_recorded(*file, properties_of(seed), 256, 60, 12);
}
