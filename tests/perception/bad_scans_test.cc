// What a broken, lying or badly set up scanner may send: seeing survives it, and sees again afterwards.
#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "planner/localization/localizer.h"
#include "planner/tracking/tracker.h"
#include "tests/perception/room.h"
#include "tests/support/allocation_guard.h"
#include "tests/support/catch.h"

using namespace jaywalk;
using namespace jaywalk::test;

namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN(), kInfinity = std::numeric_limits<float>::infinity();

Room room_with_walker(double y) { return with({{{2.0, y}, 0.25}}, {{{-2.0, -5.0}, {-2.0, -2.0}}}); }

/// Localizer and tracker of a robot that stands at the origin.
struct Eyes {
  Localizer localizer{{}};
  Tracker tracker{{.robot_from_laser = {}, .map_side_cells = 256, .map_centre = {}}};
  std::uint32_t scans = 0;
  std::uint64_t allocations = 0;

  void see(LaserScan scan) {
    scan.sequence = ++scans;
    const AllocationGuard guard;
    (void)localizer.update({}, scan, {}, tracker.still(), tracker.moving());
    tracker.update(scan, localizer.map_from_robot_at_scan(), localizer.twist());
    allocations += guard.calls();
  }
  /// A walker at 0.9 m/s, from -2 m to 2 m; scan `k` of a 15 Hz laser.
  void see_walker(std::uint32_t k, std::uint32_t count) {
    for (std::uint32_t i = 0; i < count; ++i) see(scan_of(room_with_walker(-2.0 + 0.06 * i), {}, k + i, 0.01));
  }
  void look_round() {
    for (std::uint32_t k = 1; k <= 30; ++k) see(scan_of(room_with_walker(9.0), {}, k, 0.01));
  }
  [[nodiscard]] bool sound() const {
    const Pose2& p = localizer.map_from_robot_at_scan();
    const auto finite = [](const Track& t) {
      return std::isfinite(norm(t.position_in_map)) && std::isfinite(norm(t.velocity_in_map)) && t.covariance.pp > 0.0;
    };
    return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.heading) &&
           std::all_of(tracker.tracks().begin(), tracker.tracks().end(), finite);
  }
  /// Where it is and who moves, as if nothing had been.
  [[nodiscard]] bool sees_walker() const {
    return norm(localizer.map_from_robot_at_scan().position()) < 0.1 && tracker.moving().size() == 1;
  }
};

std::unique_ptr<Eyes> open_eyes() {
  auto eyes = std::make_unique<Eyes>();
  eyes->look_round();
  return eyes;
}

/// Xorshift (Marsaglia 2003).
struct Dice {
  std::uint64_t state = 88172645463325252ULL;
  std::uint32_t roll(std::uint32_t sides) {
    state ^= state << 13, state ^= state >> 7, state ^= state << 17;
    return static_cast<std::uint32_t>(state >> 33) % sides;
  }
  /// Numbers that break things.
  float odd_number() {
    constexpr float kOdd[] = {0.0F,  -0.0F,  kNan,  kInfinity, -kInfinity, 1e-38F,
                              1e38F, -1e38F, -1.0F, 0.02F,     3.1F,       1e6F};
    return kOdd[roll(12)];
  }
};

void spoil(LaserScan& scan, Dice& dice) {
  for (std::uint32_t k = dice.roll(4); k > 0; --k) {
    switch (dice.roll(9)) {
      case 0: scan.beam_count = dice.roll(3) == 0 ? dice.roll(5) : dice.roll(5000); break;
      case 1: scan.first_angle_rad = dice.odd_number(); break;
      case 2: scan.angle_step_rad = dice.odd_number(); break;
      case 3: scan.range_min_m = dice.odd_number(); break;
      case 4: scan.range_max_m = dice.odd_number(); break;
      case 5: scan.sweep = std::chrono::milliseconds(static_cast<std::int64_t>(dice.roll(4000)) - 2000); break;
      case 6: scan.stamp += std::chrono::milliseconds(static_cast<std::int64_t>(dice.roll(40000)) - 20000); break;
      case 7:
        for (float& r : scan.range_m) r = dice.roll(2) == 0 ? dice.odd_number() : r;
        break;
      default: std::reverse(scan.range_m.begin(), scan.range_m.end()); break;
    }
  }
}

}  // namespace

TEST_CASE("three hundred spoilt scans leave the pose finite and every track sound, and ask nothing of the heap") {
  const auto eyes = open_eyes();
  Dice dice;
  bool sound = true;
  for (std::uint32_t k = 31; k < 331; ++k) {
    LaserScan scan = scan_of(room_with_walker(-2.0 + 0.06 * (k % 66)), {}, k, 0.01);
    spoil(scan, dice);
    eyes->see(scan);
    sound = sound && eyes->sound() && eyes->tracker.tracks().size() <= kMaxTracks;
  }
  CHECK(sound);
  eyes->see_walker(331, 40);
  CHECK(eyes->allocations == 0);
}

TEST_CASE("a storm of NaN blinds for as long as it lasts") {
  const auto eyes = open_eyes();
  for (std::uint32_t k = 31; k < 46; ++k) {
    LaserScan storm = scan_of(room_with_walker(9.0), {}, k);
    storm.range_m.fill(kNan);
    eyes->see(storm);
  }
  CHECK(eyes->tracker.tracks().empty());
  eyes->see_walker(46, 40);
  CHECK(eyes->sees_walker());
}

TEST_CASE("ten seconds without a scan forget who walked and keep the walls") {
  const auto eyes = open_eyes();
  eyes->see_walker(31, 40);
  REQUIRE(eyes->sees_walker());
  const std::uint32_t id = eyes->tracker.moving()[0].id;
  eyes->see_walker(221, 40);
  CHECK(eyes->sees_walker());
  CHECK(eyes->tracker.moving()[0].id != id);
  const EvidenceMap& still = eyes->tracker.still();
  CHECK(still.occupied(still.cell_at({5.99, 1.0})));
}

TEST_CASE("time that goes back five seconds does not take the robot along") {
  const auto eyes = open_eyes();
  eyes->see_walker(100, 30);
  eyes->see_walker(25, 60);
  CHECK(eyes->sound());
  CHECK(eyes->sees_walker());
}

TEST_CASE("who walked before a clock was set back by a minute is no ghost after it") {
  const auto eyes = open_eyes();
  eyes->see_walker(1000, 30);
  REQUIRE(eyes->sees_walker());
  Room behind_a_wall = room_with_walker(-0.2);
  behind_a_wall.walls.push_back({{1.2, -1.0}, {1.2, 1.0}});
  for (std::uint32_t k = 100; k < 145; ++k) eyes->see(scan_of(behind_a_wall, {}, k, 0.01));  // three seconds
  CHECK(eyes->tracker.moving().empty());
  eyes->see_walker(145, 40);
  CHECK(eyes->sees_walker());
}

TEST_CASE("a frozen scanner shows nothing that moves") {
  const auto eyes = open_eyes();
  LaserScan frozen = scan_of(room_with_walker(0.0), {}, 31, 0.01);
  std::size_t most = 0;
  for (std::uint32_t k = 31; k < 91; ++k) {
    frozen.stamp = time_from_seconds((k - 1) / 15.0);
    eyes->see(frozen);
    most = std::max(most, eyes->tracker.moving().size());
  }
  CHECK(most == 0);
  CHECK(norm(eyes->localizer.map_from_robot_at_scan().position()) < 0.05);
}

TEST_CASE("a scanner mounted upside down that says so sees the same room") {
  const auto eyes = std::make_unique<Eyes>();
  for (std::uint32_t k = 1; k <= 70; ++k) {
    LaserScan scan = scan_of(room_with_walker(k <= 30 ? 9.0 : -2.0 + 0.06 * (k - 31)), {}, k, 0.01);
    std::reverse(scan.range_m.begin(), scan.range_m.begin() + scan.beam_count);
    scan.first_angle_rad = -scan.first_angle_rad;
    scan.angle_step_rad = -scan.angle_step_rad;
    eyes->see(scan);
  }
  CHECK(eyes->sees_walker());
  CHECK(eyes->tracker.moving()[0].velocity_in_map.y > 0.7);  // to the left, as it walks
}
