// Plans along a recorded way, among what its laser saw: the CPU's bytes, on the emulated device.
#include <algorithm>

#include "apps/formats/logs/recorded_log.h"
#include "planner/tracking/tracker.h"
#include "tests/cuda/cuda_rig.h"
#include "tests/planner/cuda_parity.h"
#include "tests/recording/recordings.h"

using namespace jaywalk;
using namespace jaywalk::test;
using emulated::device;

namespace {

/// A recording whose odometry is where the robot was, a scan at a time.
class RecordedWay {
 public:
  explicit RecordedWay(const std::filesystem::path& file) : log_(sim::load_carmen(file)) {}

  [[nodiscard]] std::size_t scans() const { return log_.scans.size(); }
  [[nodiscard]] Pose2 pose_at(std::size_t k) const {
    const auto later = std::upper_bound(log_.odometry.begin(), log_.odometry.end(), log_.scans[k].stamp,
                                        [](Time t, const sim::OdometryPose& o) { return t < o.stamp; });
    return later == log_.odometry.begin() ? later->pose : std::prev(later)->pose;
  }
  [[nodiscard]] LaserScan scan_at(std::size_t k) const {
    const sim::RecordedScan& from = log_.scans[k];
    LaserScan scan;
    scan.stamp = from.stamp;
    scan.sequence = static_cast<std::uint32_t>(k + 1);
    scan.beam_count = from.beams;
    scan.first_angle_rad = from.first_angle_rad, scan.angle_step_rad = from.angle_step_rad;
    scan.range_min_m = from.range_min_m, scan.range_max_m = from.range_max_m;
    std::copy_n(log_.range_m.begin() + static_cast<std::ptrdiff_t>(from.first_range), from.beams, scan.range_m.begin());
    return scan;
  }

 private:
  sim::RecordedLog log_;
};

/// Plans in windows of `side` cells on every `stride`-th of `count` scans from the middle of the recording on, towards
/// where the robot was ten scans later, or ninety: then outside a small window.
void check_recorded(const RecordedWay& way, const emulated::Properties& properties, std::int32_t side,
                    std::size_t count, std::size_t stride) {
  device().power_on(properties);
  paper::PaperConfig config;
  config.side_cells = config.max_side_cells = side;
  const auto cpu = paper::make_cpu_paper_planner(config), gpu = cuda_paper_planner(config);
  const std::size_t first = way.scans() / 2;
  const Pose2 begin = way.pose_at(first);
  PerceptionConfig seeing;
  seeing.map_centre = begin.position();
  Tracker tracker(seeing);
  int planned = 0;
  for (std::size_t k = first; k < first + count; ++k) {
    const LaserScan scan = way.scan_at(k);
    tracker.update(scan, way.pose_at(k));
    if ((k - first) % stride != stride - 1) continue;
    PlanRequest request;
    request.stamp = scan.stamp;
    request.map_from_robot = way.pose_at(k);
    request.goal_in_map = way.pose_at(k + (k % 2 == 0 ? 10 : 90)).position();
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
  check_recorded(RecordedWay(*file), properties_of(4), 64, 40, 10);
}

TEST_CASE("emulated at length: plans of 256 cells on recorded ticks have the CPU's bytes", "[.large]") {
  const auto file = recording("carmen/intel-corrected.log.gz");
  if (!file) return;
  const RecordedWay way(*file);
  for (std::uint64_t seed = 8; seed <= 9; ++seed) check_recorded(way, properties_of(seed), 256, 60, 12);
}
