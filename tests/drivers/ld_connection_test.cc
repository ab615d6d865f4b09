#include <chrono>

#include "hil/emulators/ld_server.h"
#include "drivers/laser/ld_protocol.h"
#include "hal/types/errors.h"
#include "tests/drivers/scanner_bench.h"
#include "tests/drivers/serial_line.h"
#include "tests/support/catch.h"

using namespace jaywalk;
using namespace std::chrono_literals;
using emulators::ScannerFault;
using Bench = tests::ScannerBench<emulators::LdServer>;

namespace {

/// Walls: 2 m to the left half, 3 m to the right half, an opening of 4 degrees behind.
void look(std::size_t first, std::span<float> range_m) {
  for (std::size_t k = 0; k < range_m.size(); ++k) {
    const double clockwise_deg = static_cast<double>(first + k) * 360.0 / 456.0;
    const bool behind = clockwise_deg > 178.0 && clockwise_deg < 182.0;
    range_m[k] = behind ? 0.0F : clockwise_deg < 180.0 ? 3.0F : 2.0F;
  }
}

std::unique_ptr<Bench> bench_on_serial() {
  auto line = tests::serial_line();
  if (line == nullptr) return nullptr;
  auto endpoint = std::make_unique<wire::SerialEndpoint>(line->path(), 230400);
  return std::make_unique<Bench>(std::make_unique<emulators::LdServer>(std::move(line), look), std::move(endpoint),
                                 std::make_unique<ldrobot::LdProtocol>());
}

std::size_t beam_towards(const LaserScan& scan, double left_deg) {
  const double beams =
      (left_deg * kPi / 180.0 - static_cast<double>(scan.first_angle_rad)) / static_cast<double>(scan.angle_step_rad);
  return static_cast<std::size_t>(beams + 0.5);
}

}  // namespace

TEST_CASE("an LD19 on a serial line is listened to and left is left") {
  const auto bench = bench_on_serial();
  if (bench == nullptr) return;
  bench->run(2s);
  const LaserScan& scan = bench->scan();
  REQUIRE(scan.beam_count == 450);
  CHECK(scan.range_m[beam_towards(scan, -90.0)] == Approx(3.0));   // a quarter clockwise: to the right
  CHECK(scan.range_m[beam_towards(scan, -270.0)] == Approx(2.0));  // three quarters: to the left
  CHECK_FALSE(scan.is_hit(beam_towards(scan, -180.0)));
  CHECK(to_seconds(scan.period) == Approx(0.1).margin(0.002));
  const ScannerHealth health = bench->health();
  CHECK(health.trouble == ScannerTrouble::kNone);
  CHECK(health.scans >= 18);  // 20 turns less the first, seen in part, and the last
  CHECK(health.late + health.malformed + health.protocol.skipped_bytes == 0);
  CHECK(bench->heap_calls == 0);
}

TEST_CASE("the stamp of an LD19's scan is when its turn began") {
  const auto bench = bench_on_serial();
  if (bench == nullptr) return;
  for (int k = 0; k < 350; ++k) {  // its clock wraps after 30 seconds
    bench->run(100ms);
    const LaserScan& scan = bench->scan();
    if (scan.sequence == 0) continue;
    // Turns begin at 1 ms, 101 ms, ... of the bench's clock. A packet comes up to 1 ms late, a step of the bench, or
    // 2.7 ms early or late as the scanner's clock of milliseconds is read.
    const Duration into = (scan.stamp.time_since_epoch() - 1ms + 5ms) % 100ms;
    REQUIRE(into >= 2ms);
    REQUIRE(into <= 8ms);
  }
  CHECK(bench->health().late == 0);
}

TEST_CASE("an LD19 is found again after damage and noise and silence and a pulled plug") {
  const auto bench = bench_on_serial();
  if (bench == nullptr) return;
  bench->run(1s);
  for (const ScannerFault fault : {ScannerFault::kHalfTelegram, ScannerFault::kDamage, ScannerFault::kGarbage}) {
    bench->server->order(fault, 300ms);
    bench->run(400ms);
    const std::uint32_t sequence = bench->scan().sequence;
    bench->run(300ms);
    CHECK(bench->scan().sequence >= sequence + 2);
    CHECK(bench->is_well());
  }
  CHECK(bench->health().protocol.skipped_bytes > 23);
  CHECK(bench->health().connections == 1);
  bench->server->order(ScannerFault::kSilence, 1500ms);
  bench->run(1300ms);
  CHECK(bench->health().trouble == ScannerTrouble::kSilent);
  bench->run(2s);
  CHECK(bench->is_well());
  bench->server->order(ScannerFault::kGone, 10s);
  bench->run(100ms);
  CHECK(bench->health().last_trouble == ScannerTrouble::kClosed);
  bench->run(8s);
  CHECK(bench->health().trouble == ScannerTrouble::kUnreachable);
  bench->run(4s);
  CHECK(bench->is_well());
  CHECK(bench->heap_calls == 0);
}

TEST_CASE("a rate that no serial line has is refused at start") {
  CHECK_THROWS_AS(wire::SerialEndpoint("/dev/ttyUSB0", 230401), StartupError);
}
