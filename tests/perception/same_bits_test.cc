// Seeing is under the float contract (docs/explanation/conventions.md): one drive past walkers, and a digest of all it
// led to.
#include <cstdint>
#include <cstring>

#include "planner/localization/localizer.h"
#include "planner/localization/odometry.h"
#include "planner/tracking/tracker.h"
#include "tests/perception/room.h"
#include "tests/support/catch.h"

using namespace jaywalk;
using namespace jaywalk::test;

namespace {

constexpr DriveModel kDrive{.wheel_radius_m = 0.1, .track_width_m = 0.33, .max_wheel_speed_radps = 14.0};
constexpr ArcStep kStep{.distance_m = 0.03, .turn_rad = 0.012};  // of the robot, a scan: 0.45 m/s, 0.18 rad/s
constexpr double kWheelsClaim = 1.03;                            // times that

/// FNV-1a over the bits of numbers, one by one: what lies between a struct's members does not count.
class Digest {
 public:
  template <class Number>
  void add(Number number) {
    unsigned char bytes[sizeof number];
    std::memcpy(bytes, &number, sizeof number);
    for (const unsigned char byte : bytes) value_ = (value_ ^ byte) * 1099511628211ULL;
  }
  void add(Vec2 v) { add(v.x), add(v.y); }
  void add(const Pose2& pose) { add(pose.position()), add(pose.heading); }
  void add(const PoseEstimate& e) { add(e.map_from_robot), add(e.position_std_m), add(e.heading_std_rad); }
  void add(const Track& t) {
    add(t.id), add(t.position_in_map), add(t.velocity_in_map);
    add(t.covariance.pp), add(t.covariance.pv), add(t.covariance.vv);
    add(t.radius_m), add(t.hits), add<std::uint8_t>(t.moving ? 1 : 0);
  }
  [[nodiscard]] std::uint64_t value() const { return value_; }

 private:
  std::uint64_t value_ = 14695981039346656037ULL;
};

/// Two walkers, a pillar, a wall that juts into the room.
Room room_after(double s) {
  return with({{{3.5, -2.5}, 0.3}, {{2.5, -3.0 + 0.9 * s}, 0.25}, {{-1.0 + 0.7 * s, 3.0 - 0.2 * s}, 0.2}},
              {{{-3.0, -5.0}, {-3.0, -2.0}}});
}

/// The wheels' angles after `k` steps of an arc.
WheelState wheels_after(std::uint32_t k) {
  const double way = kWheelsClaim * kStep.distance_m * k, aside = 0.5 * kDrive.track_width_m * kStep.turn_rad * k;
  return {.stamp = time_from_seconds(k / 15.0),
          .sequence = k + 1,
          .left_rad = (way - aside) / kDrive.wheel_radius_m,
          .right_rad = (way + aside) / kDrive.wheel_radius_m};
}

void add_map(Digest& digest, const EvidenceMap& map) {
  for (std::int32_t y = -60; y < 60; ++y) {
    for (std::int32_t x = -70; x < 70; ++x) {
      digest.add(map.evidence({x, y}));
      if (map.occupied({x, y})) digest.add(map.surface({x, y})), digest.add(map.to_laser({x, y}));
    }
  }
}

/// Of five seconds among walkers, with scans that say they took so long.
std::uint64_t digest_of_drive(Duration sweep) {
  Localizer localizer({.map_from_robot_at_start = {}, .drive = kDrive, .robot_from_laser = {}});
  Tracker tracker({.robot_from_laser = {}, .map_side_cells = 256, .map_centre = {}});
  Digest digest;
  Pose2 truth;
  std::size_t moving = 0;
  for (std::uint32_t k = 0; k < 75; ++k) {
    LaserScan scan = scan_of(room_after(k / 15.0), truth, k + 1, 0.01);
    scan.sweep = sweep;
    digest.add(localizer.update(wheels_after(k), scan, {}, tracker.still(), tracker.moving()));
    tracker.update(scan, localizer.map_from_robot_at_scan(), localizer.twist());
    for (const Track& track : tracker.tracks()) digest.add(track);
    moving += tracker.moving().size();
    truth = after_arc(truth, kStep);
  }
  add_map(digest, tracker.still());
  CHECK(moving > 60);  // so that walkers were in it
  return digest.value();
}

}  // namespace

TEST_CASE("poses, tracks and map have the same bits with every compiler, optimisation level and processor") {
  // The digest is what g++ 11 and 12, clang 14 and aarch64 give (docs/explanation/results.md#tracking-and-poses has the
  // list); it changes with what perception or localisation computes. g++ 12 with -march=x86-64-v3 gives another: it
  // fuses a rotation's two products (vfmaddsub), whatever -ffp-contract=off says; clang does not.
  CHECK(digest_of_drive(Duration{0}) == 0xd5814b7759b96488ULL);
  CHECK(digest_of_drive(std::chrono::milliseconds(50)) == 0x4a9d44b32b01a026ULL);
}
