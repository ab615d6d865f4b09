#include "tests/perception/fuzz/seeing_target.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <memory>

#include "planner/localization/localizer.h"
#include "planner/tracking/tracker.h"

namespace jaywalk::test {
namespace {

constexpr DriveModel kDrive{.wheel_radius_m = 0.1, .track_width_m = 0.33, .max_wheel_speed_radps = 14.0};
constexpr std::size_t kMostScans = 200;
constexpr float kNan = std::numeric_limits<float>::quiet_NaN(), kInfinity = std::numeric_limits<float>::infinity();
constexpr std::array<float, 8> kOdd{kNan, kInfinity, -kInfinity, 0.0F, -1.0F, 1e-38F, 1e38F, 1e6F};

void require(bool holds) {
  if (!holds) std::abort();
}

/// Takes numbers from bytes; zeros when there are no more.
class Source {
 public:
  explicit Source(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}
  [[nodiscard]] bool empty() const { return bytes_.empty(); }
  template <class Number>
  Number take() {
    Number number{};
    const std::size_t count = std::min(sizeof number, bytes_.size());
    std::memcpy(&number, bytes_.data(), count);
    bytes_ = bytes_.subspan(count);
    return number;
  }

 private:
  std::span<const std::uint8_t> bytes_;
};

/// Which bits of the first byte ask for what.
enum Choice : std::uint8_t {
  kOddGeometry = 1,
  kOddTime = 2,
  kSweeps = 4,
  kWheels = 8,
  kOddWheels = 16,
  kFix = 32,
  kOddCount = 64,
  kSameRanges = 128
};

struct Eyes {
  Localizer localizer{{.map_from_robot_at_start = {}, .drive = kDrive, .robot_from_laser = {0.1, 0.0, 0.0}}};
  Tracker tracker{{.robot_from_laser = {0.1, 0.0, 0.0}, .map_side_cells = 128, .map_centre = {}}};
  LaserScan scan;
  WheelState wheels;
  OutsideFix fix;

  void turn_wheels(Source& from, bool odd) {
    wheels.sequence += 1;
    wheels.stamp = scan.stamp;
    wheels.left_rad = odd ? from.take<double>() : wheels.left_rad + from.take<std::int8_t>() * 0.01;
    wheels.right_rad = odd ? from.take<double>() : wheels.right_rad + from.take<std::int8_t>() * 0.01;
  }
  void fix_pose(Source& from) {
    fix.sequence += 1;
    fix.stamp = scan.stamp;
    fix.has_pose = true;
    fix.map_from_robot = {from.take<float>(), from.take<float>(), from.take<float>()};
    const auto doubt = from.take<std::uint8_t>();
    const double std = doubt >= 0xF8 ? static_cast<double>(kOdd[doubt - 0xF8U]) : 0.01 * doubt;
    fix.position_std_m = fix.heading_std_rad = fix.mover_std_m = std;
    fix.movers.clear();
    for (unsigned id = from.take<std::uint8_t>() % 4U; id > 0; --id)
      (void)fix.movers.push_back({id, {from.take<float>(), from.take<float>()}, from.take<float>()});
  }
  void aim(Source& from, std::uint8_t choice) {
    scan.sequence += 1;
    scan.stamp += std::chrono::milliseconds((choice & kOddTime) != 0 ? from.take<std::int16_t>() : 67);
    scan.sweep = std::chrono::milliseconds((choice & kSweeps) != 0 ? from.take<std::int16_t>() : 0);
    const bool odd = (choice & kOddGeometry) != 0;
    scan.first_angle_rad = odd ? from.take<float>() : -2.3F;
    scan.angle_step_rad = odd ? from.take<float>() : 0.01F;
    scan.range_min_m = odd ? from.take<float>() : 0.05F;
    scan.range_max_m = odd ? from.take<float>() : 30.0F;
  }
  void fill(Source& from) {
    std::uint32_t beam = 0;
    for (unsigned runs = from.take<std::uint8_t>() % 32U; runs > 0; --runs) {
      const std::uint32_t end = std::min<std::uint32_t>(beam + from.take<std::uint8_t>(), kMaxBeams);
      const auto centimetres = from.take<std::uint16_t>();
      const float range = centimetres >= 0xFFF8 ? kOdd[centimetres - 0xFFF8U] : 0.01F * static_cast<float>(centimetres);
      for (; beam < end; ++beam) scan.range_m[beam] = range;
    }
    scan.beam_count = beam;
  }
  void see(Source& from) {
    const auto choice = from.take<std::uint8_t>();
    aim(from, choice);
    if ((choice & kSameRanges) == 0) fill(from);
    if ((choice & kOddCount) != 0) scan.beam_count = from.take<std::uint16_t>();
    const bool all_round = (choice & kOddGeometry) == 0 && scan.beam_count % 4 == 3;
    if (all_round) scan.angle_step_rad = static_cast<float>(2.0 * kPi / scan.beam_count);
    if ((choice & (kWheels | kOddWheels)) != 0) turn_wheels(from, (choice & kOddWheels) != 0);
    if ((choice & kFix) != 0) fix_pose(from);
    if (!fix.movers.empty()) tracker.update_given(fix);
    judge(localizer.update(wheels, scan, fix, tracker.still(), tracker.moving()));
    tracker.update(scan, localizer.map_from_robot_at_scan(), localizer.twist());
    for (const Track& track : tracker.tracks()) judge(track);
    require(tracker.tracks().size() <= kMaxTracks && tracker.moving().size() <= tracker.tracks().size());
  }
  static void judge(const PoseEstimate& e) {
    require(std::isfinite(e.map_from_robot.x) && std::isfinite(e.map_from_robot.y));
    require(std::fabs(e.map_from_robot.heading) <= kPi);
    require(e.position_std_m >= 0.0 && e.heading_std_rad >= 0.0);
  }
  static void judge(const Track& t) {
    require(std::isfinite(norm(t.position_in_map)) && std::isfinite(norm(t.velocity_in_map)));
    require(t.covariance.pp > 0.0 && t.covariance.vv > 0.0 && std::isfinite(t.covariance.pp + t.covariance.vv));
    require(t.radius_m > 0.0 && t.radius_m <= 1.0);
  }
};

}  // namespace

void fuzz_seeing(std::span<const std::uint8_t> bytes) noexcept {
  const auto eyes = std::make_unique<Eyes>();
  eyes->scan.stamp = time_from_seconds(100.0);
  std::size_t scans = 0;
  for (int round = 0; round < 2; ++round) {
    for (Source source(bytes); !source.empty() && scans < kMostScans; ++scans) eyes->see(source);
  }
}

}  // namespace jaywalk::test
