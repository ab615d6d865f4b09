// Against recordings that nobody here made; each says "skipped: no data" where they are not.
#include "tests/perception/recordings.h"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <optional>
#include <set>
#include <string>

#include "planner/localization/localizer.h"
#include "planner/tracking/tracker.h"
#include "tests/recording/recordings.h"
#include "tests/support/catch.h"

using namespace jaywalk;
using namespace recordings;

namespace {

constexpr DriveModel kDrive{.wheel_radius_m = 0.17, .track_width_m = 0.56, .max_wheel_speed_radps = 16.0};

/// What came of running a recording through localizer and tracker.
struct Seen {
  std::vector<Pose2> poses;  ///< a scan
  std::vector<std::vector<Track>> tracks;
  std::set<std::uint32_t> moving_ids;
};

Seen run(const Recording& recording, const Pose2& start, const Pose2& robot_from_laser) {
  Seen seen;
  Localizer localizer({.map_from_robot_at_start = start, .drive = kDrive, .robot_from_laser = robot_from_laser});
  Tracker tracker({.robot_from_laser = robot_from_laser, .map_centre = start.position()});
  WheelsFromPoses wheels_of(kDrive);
  WheelState wheels;
  const OutsideFix no_fix;
  LaserScan last;
  std::size_t row = 0;
  for (const LaserScan& scan : recording.scans) {
    while (row < recording.odometry.size() && recording.odometry[row].t_s <= to_seconds(scan.stamp)) {
      wheels = wheels_of.reading(recording.odometry[row++]);
      (void)localizer.update(wheels, last, no_fix, tracker.still(), tracker.moving());
    }
    (void)localizer.update(wheels, scan, no_fix, tracker.still(), tracker.moving());
    tracker.update(scan, localizer.map_from_robot_at_scan(), localizer.twist());
    last = scan;
    seen.poses.push_back(localizer.map_from_robot_at_scan());
    seen.tracks.emplace_back(tracker.tracks().begin(), tracker.tracks().end());
    for (const Track& t : tracker.moving()) seen.moving_ids.insert(t.id);
  }
  return seen;
}

/// The scan nearest in time.
std::size_t scan_at(const Recording& recording, double t_s) {
  const auto nearest = std::ranges::min_element(
      recording.scans, {}, [&](const LaserScan& scan) { return std::fabs(to_seconds(scan.stamp) - t_s); });
  return static_cast<std::size_t>(nearest - recording.scans.begin());
}

bool near_track(const std::vector<Track>& tracks, Vec2 place, double within_m, bool moving_only) {
  return std::any_of(tracks.begin(), tracks.end(), [&](const Track& t) {
    return (t.moving || !moving_only) && distance(t.position_in_map, place) < within_m;
  });
}

/// Labelled places of pedestrians who walk, and how many of them a moving track is near.
struct WalkersFound {
  std::size_t labels = 0, found = 0, names = 0;
};

/// A recording whose labels are ours (bench/tracking/labels); nothing where it is missing.
std::optional<WalkersFound> walkers_found(const std::string& name) {
  const auto file = recording("static/" + name + ".scan.txt.gz");
  if (!file) return std::nullopt;
  const Recording recording = read_scan_odom(*file, std::nullopt);
  const Seen seen = run(recording, {}, {});
  WalkersFound walk{.names = seen.moving_ids.size()};
  for (const Label& label : read_labels(JAYWALK_LABELS "/" + name + ".csv")) {
    if (!label.walks) continue;
    const std::size_t k = scan_at(recording, label.t_s);
    walk.labels += 1;
    walk.found += near_track(seen.tracks[k], seen.poses[k] * label.in_laser, 0.5, true) ? 1U : 0U;
  }
  std::cout << name << ": walkers found " << walk.found << " of " << walk.labels << ", names " << walk.names << "\n";
  return walk;
}

}  // namespace

TEST_CASE("nine in ten who walk round a standing robot are known to walk, where they are") {
  const auto walk = walkers_found("standing_robot_people_walk");
  if (!walk) return;
  CHECK(walk->labels >= 200);
  CHECK(10 * walk->found >= 9 * walk->labels);  // 400 of 420
  CHECK(walk->names < 30);                      // 19
}

TEST_CASE("pedestrians who come straight towards a standing robot are known to walk") {
  const auto walk = walkers_found("standing_robot_people_walk_2");
  if (!walk) return;
  CHECK(walk->labels >= 140);
  CHECK(10 * walk->found >= 8 * walk->labels);  // 125 of 141; 95 % wanted
}

TEST_CASE("nothing moves where nobody is") {
  const auto file = recording("static/no_people_left.scan.txt.gz");
  if (!file) return;
  const Recording recording = read_scan_odom(*file, std::nullopt);
  const Seen seen = run(recording, {}, {});
  CHECK(seen.moving_ids.empty());  // in 58 s: one would be 1 a minute
  // The robot turns and drives round the hall and comes back to where it set out, to the eye.
  CHECK(norm(seen.poses.back().position()) < 0.6);
}

TEST_CASE("hardly anything moves where nobody is, wherever the recording begins") {
  const auto file = recording("static/no_people_left.scan.txt.gz");
  if (!file) return;
  const Recording all = read_scan_odom(*file, std::nullopt);
  std::size_t starts = 0, misled = 0;
  for (std::size_t first = 1; first + 60 < all.scans.size(); first += 3) {  // eight seconds each
    Recording part;
    part.scans.assign(all.scans.begin() + static_cast<std::ptrdiff_t>(first),
                      all.scans.begin() + static_cast<std::ptrdiff_t>(first + 60));
    starts += 1;
    misled += run(part, {}, {}).moving_ids.empty() ? 0U : 1U;
  }
  std::cout << "starts at which something moves: " << misled << " of " << starts << "\n";
  CHECK(10 * misled <= starts);  // of a robot that drives at 0.9 m/s and knows nothing of its speed
}

// The pose error at the end of one run is chance, so that eight runs are too few for a mean. These 40 runs: mean error
// 0.16 m, largest 0.46 m, 7 above 0.25 m; the version before: 0.16 m, 0.44 m, 8. Which of the few pedestrians there are
// known to walk is chance, too.
TEST_CASE("after five minutes in Freiburg poses are a fifth of a metre right on average and hardly anything moves") {
  const auto file = recording("carmen/freiburg-079-corrected.log.gz");
  if (!file) return;
  Recording recording = read_carmen(*file);
  recording.scans.resize(1500);
  const Pose2 start = recording.reference.front().pose, end = recording.reference[1499].pose;
  double sum_m = 0.0;
  std::size_t movers = 0;
  for (int k = 0; k < 40; ++k) {  // the map turned, so that walls lie across other cells
    const Pose2 turned{0.0, 0.0, 0.04 * k};
    const Seen seen = run(recording, turned * start, {});
    const double off_m = distance(seen.poses.back().position(), turned * end.position());
    std::cout << "after 5.5 minutes off by " << off_m << " m, " << seen.moving_ids.size() << " movers\n";
    sum_m += off_m;
    movers += seen.moving_ids.size();
    CHECK(off_m < 0.6);
    CHECK(seen.moving_ids.size() <= 3);
  }
  CHECK(movers <= 60);
  CHECK(sum_m / 40.0 < 0.2);
}

TEST_CASE("people before a wheelchair are tracked where they were labelled") {
  const auto scans = recording("wheelchair/scan.txt.gz");
  const auto odometry = recording("wheelchair/odom.txt.gz");
  const auto people = recording("wheelchair/people.csv.gz");
  if (!scans || !odometry || !people) return;
  const Recording recording = read_scan_odom(*scans, odometry);
  const Pose2 robot_from_laser{0.6, 0.2, 0.715};  // by eye, from the corridor's walls and the odometry
  const Seen seen = run(recording, recording.odometry.front().pose, robot_from_laser);
  std::size_t found = 0, walking = 0, labels = 0;
  for (const Label& label : read_labels(*people)) {
    const std::size_t k = scan_at(recording, label.t_s);
    const Vec2 place = seen.poses[k] * robot_from_laser * label.in_laser;
    labels += 1;
    found += near_track(seen.tracks[k], place, 0.75, false) ? 1U : 0U;
    walking += near_track(seen.tracks[k], place, 0.75, true) ? 1U : 0U;
  }
  std::cout << "labels tracked " << found << " of " << labels << ", known to walk " << walking
            << ", names of who moves " << seen.moving_ids.size() << "\n";
  CHECK(labels > 50);
  CHECK(found >= 42);                  // 45 of 57
  CHECK(walking >= 8);                 // 9: why so few, docs/explanation/results.md#tracking-and-poses
  CHECK(seen.moving_ids.size() < 11);  // 7
}
