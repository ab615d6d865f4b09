// Where each kind of scanner's beams look and what they say, on its own wire.
#include <chrono>

#include "tests/drivers/scanner_kinds.h"

using namespace jaywalk;
using namespace std::chrono_literals;
using tests::ScannerBench;

namespace {

/// A beam sees a metre and `step_m` a beam more.
tests::ScannerWorld farther_each_beam(double step_m) {
  return [step_m](std::size_t first, std::span<float> range_m) {
    for (std::size_t k = 0; k < range_m.size(); ++k) {
      range_m[k] = static_cast<float>(1.0 + step_m * static_cast<double>(first + k));
    }
  };
}

/// The same, and every tenth sees nothing.
void with_gaps(std::size_t first, std::span<float> range_m) {
  farther_each_beam(0.01)(first, range_m);
  for (std::size_t k = 0; k < range_m.size(); ++k) {
    if ((first + k) % 10 == 9) range_m[k] = 0.0F;
  }
}

/// Walls: 2 m to the left half, 3 m to the right half, an opening of 4 degrees behind.
void two_walls(std::size_t first, std::span<float> range_m) {
  for (std::size_t k = 0; k < range_m.size(); ++k) {
    const double clockwise_deg = static_cast<double>(first + k) * 360.0 / 456.0;
    const bool behind = clockwise_deg > 178.0 && clockwise_deg < 182.0;
    range_m[k] = behind ? 0.0F : clockwise_deg < 180.0 ? 3.0F : 2.0F;
  }
}

std::size_t beam_towards(const LaserScan& scan, double left_deg) {
  const double beams =
      (left_deg * kPi / 180.0 - static_cast<double>(scan.first_angle_rad)) / static_cast<double>(scan.angle_step_rad);
  return static_cast<std::size_t>(beams + 0.5);
}

/// Beams that look from right to left by a quarter degree or a third of one, 135 degrees to either side.
void check_wide(ScannerBench& bench, double step_rad, std::size_t beams, std::size_t blind) {
  bench.come_to_life();
  const LaserScan& scan = bench.scan();
  REQUIRE(scan.beam_count == beams);
  CHECK(scan.first_angle_rad == Approx(-2.3561945));
  CHECK(scan.angle_step_rad == Approx(step_rad));
  CHECK(scan.range_m[0] == Approx(1.0));
  CHECK(scan.range_m[beams - blind - 1] == Approx(1.0 + 0.001 * static_cast<double>(beams - blind - 1)));
  CHECK_FALSE(scan.is_hit(beams - blind));
}

/// The last `blind` of `beams` see nothing.
tests::ScannerWorld blind_at_the_end(std::size_t beams, std::size_t blind) {
  return [beams, blind](std::size_t first, std::span<float> range_m) {
    farther_each_beam(0.001)(first, range_m);
    for (std::size_t k = 0; k < range_m.size(); ++k) {
      if (first + k + blind >= beams) range_m[k] = 0.0F;
    }
  };
}

}  // namespace

TEST_CASE("a SICK scanner is logged in to and set up and its scans come whole in either dialect") {
  for (const auto dialect : {emulators::ColaDialect::kText, emulators::ColaDialect::kBinary}) {
    check_wide(*tests::sick_bench(blind_at_the_end(811, 11), dialect), 0.3333 * kPi / 180.0, 811, 11);
  }
}

TEST_CASE("a Hokuyo says what it is and its scans come whole") {
  for (const tests::ScannerKind& kind : tests::scanner_kinds()) {
    if (kind.beams != 1081) continue;
    const auto bench = kind.make(blind_at_the_end(1081, 10));
    if (bench == nullptr) return;
    check_wide(*bench, 0.0043633, 1081, 10);
    CHECK(bench->scan().range_max_m == Approx(60.0));
    CHECK(bench->scan().period == 25ms);
  }
}

TEST_CASE("a Hokuyo with more steps than a scan may have beams joins neighbours") {
  const auto bench = tests::hokuyo_bench(
      farther_each_beam(0.001), {.steps_per_turn = 4096, .first_step = 100, .last_step = 3171, .front_step = 1636});
  bench->come_to_life();
  const LaserScan& scan = bench->scan();
  REQUIRE(scan.beam_count == 1536);                        // 3072 steps by two
  CHECK(scan.first_angle_rad == Approx(-2.3561945));       // -1536 of 4096 steps to a turn
  CHECK(scan.angle_step_rad == Approx(2.0 * 0.00153398));  // 2 pi / 4096
  CHECK(scan.range_m[100] == Approx(1.2));                 // beams 200 and 201: the nearer
}

TEST_CASE("an LD19 on a serial line is listened to and left is left") {
  const auto bench = tests::ld_bench(two_walls);
  if (bench == nullptr) return;
  bench->run(2s);
  const LaserScan& scan = bench->scan();
  REQUIRE(scan.beam_count == 450);
  CHECK(scan.range_m[beam_towards(scan, -90.0)] == Approx(3.0));   // a quarter clockwise: to the right
  CHECK(scan.range_m[beam_towards(scan, -270.0)] == Approx(2.0));  // three quarters: to the left
  CHECK_FALSE(scan.is_hit(beam_towards(scan, -180.0)));
}

TEST_CASE("an LMS200 on a serial line is told to send and its scans come whole") {
  const auto bench = tests::lms200_bench(with_gaps);
  if (bench == nullptr) return;
  bench->run(2s);
  const LaserScan& scan = bench->scan();
  REQUIRE(scan.beam_count == 181);
  CHECK(scan.range_m[0] == Approx(1.0));
  CHECK(scan.range_m[180] == Approx(2.8));
  CHECK_FALSE(scan.is_hit(9));
  CHECK(to_seconds(scan.period) == Approx(8.0 / 75.0));
}

TEST_CASE("an RPLIDAR on a serial line is started and left is left") {
  const auto bench = tests::rplidar_bench(with_gaps);
  if (bench == nullptr) return;
  bench->run(2s);
  const LaserScan& scan = bench->scan();
  REQUIRE(scan.beam_count == 360);
  CHECK(scan.range_m[0] == Approx(1.0));
  CHECK(scan.range_m[90] == Approx(1.9));  // a quarter clockwise
  CHECK(scan.angle_rad(90) == Approx(-90.5 * kPi / 180.0));
  CHECK_FALSE(scan.is_hit(99));
  CHECK(to_seconds(scan.sweep) == Approx(0.1).margin(0.003));
}
