#include <algorithm>
#include <chrono>

#include "hil/emulators/lms200_server.h"
#include "hil/emulators/rplidar_server.h"
#include "drivers/laser/lms200_protocol.h"
#include "drivers/laser/rplidar_protocol.h"
#include "tests/drivers/scanner_bench.h"
#include "tests/drivers/serial_line.h"
#include "tests/support/catch.h"

using namespace jaywalk;
using namespace std::chrono_literals;
using emulators::ScannerFault;

namespace {

/// A beam sees a metre and a centimetre a beam more; every tenth sees nothing.
void look(std::size_t first, std::span<float> range_m) {
  for (std::size_t k = 0; k < range_m.size(); ++k) {
    range_m[k] = (first + k) % 10 == 9 ? 0.0F : 1.0F + 0.01F * static_cast<float>(first + k);
  }
}

using LmsBench = tests::ScannerBench<emulators::Lms200Server>;
using RplidarBench = tests::ScannerBench<emulators::RplidarServer>;

/// None where this machine has no pseudo terminals.
std::unique_ptr<LmsBench> lms200_bench() {
  auto line = tests::serial_line();
  if (line == nullptr) return nullptr;
  auto endpoint = std::make_unique<wire::SerialEndpoint>(line->path(), 38400);
  return std::make_unique<LmsBench>(std::make_unique<emulators::Lms200Server>(std::move(line), 38400, look),
                                    std::move(endpoint), std::make_unique<lms200::Lms200Protocol>(38400));
}

std::unique_ptr<RplidarBench> rplidar_bench() {
  auto line = tests::serial_line();
  if (line == nullptr) return nullptr;
  auto endpoint = std::make_unique<wire::SerialEndpoint>(line->path(), 115200);
  return std::make_unique<RplidarBench>(std::make_unique<emulators::RplidarServer>(std::move(line), look),
                                        std::move(endpoint), std::make_unique<rplidar::RplidarProtocol>());
}

template <class Bench>
void check_faults(Bench& bench) {
  bench.run(1s);
  REQUIRE(bench.is_well());
  for (const ScannerFault fault : {ScannerFault::kHalfTelegram, ScannerFault::kDamage, ScannerFault::kGarbage}) {
    bench.server->order(fault, 300ms);
    bench.run(700ms);
    const std::uint32_t sequence = bench.scan().sequence;
    bench.run(300ms);
    CHECK(bench.scan().sequence >= sequence + 2);
    CHECK(bench.is_well());
  }
  CHECK(bench.health().protocol.skipped_bytes > 10);
  CHECK(bench.health().connections == 1);
  bench.server->order(ScannerFault::kSilence, 1500ms);
  bench.run(1300ms);
  CHECK(bench.health().trouble == ScannerTrouble::kSilent);
  bench.run(3s);
  CHECK(bench.is_well());
  bench.server->order(ScannerFault::kGone, 10s);
  bench.run(8s);
  CHECK(bench.health().trouble == ScannerTrouble::kUnreachable);
  bench.run(5s);
  CHECK(bench.is_well());
  CHECK(bench.heap_calls == 0);
}

}  // namespace

TEST_CASE("an LMS200 on a serial line is told to send and its scans come whole and in time") {
  const auto bench = lms200_bench();
  if (bench == nullptr) return;
  bench->run(2s);
  const LaserScan& scan = bench->scan();
  REQUIRE(scan.beam_count == 181);
  CHECK(scan.range_m[0] == Approx(1.0));
  CHECK(scan.range_m[180] == Approx(2.8));
  CHECK_FALSE(scan.is_hit(9));
  CHECK(to_seconds(scan.period) == Approx(8.0 / 75.0));
  // Sweeps begin each 106.67 ms from 1 ms on; the telegram takes 96.9 ms on its line; the bench steps by 1 ms.
  const Duration period = duration_from_seconds(8.0 / 75.0);
  const Duration into = (scan.stamp.time_since_epoch() - 1ms + 5ms) % period;
  CHECK(into >= 5ms);
  CHECK(into <= 8ms);
  const ScannerHealth health = bench->health();
  CHECK(health.scans >= 16);  // 18 in two seconds, less the conversation and one on the line
  CHECK(health.malformed + health.late + health.protocol.skipped_bytes == 0);
  CHECK(bench->heap_calls == 0);
}

TEST_CASE("an LMS200 is found again after damage and noise and silence and a pulled plug") {
  const auto bench = lms200_bench();
  if (bench != nullptr) check_faults(*bench);
}

TEST_CASE("an LMS200 that reports an error is named so until it is well") {
  const auto bench = lms200_bench();
  if (bench == nullptr) return;
  bench->run(1s);
  bench->server->set_status(3);
  bench->run(500ms);
  CHECK(bench->health().trouble == ScannerTrouble::kDeviceError);
  bench->server->set_status(0);
  bench->run(500ms);
  CHECK(bench->is_well());
}

TEST_CASE("an RPLIDAR on a serial line is started and left is left") {
  const auto bench = rplidar_bench();
  if (bench == nullptr) return;
  bench->run(2s);
  const LaserScan& scan = bench->scan();
  REQUIRE(scan.beam_count == 360);
  CHECK(scan.range_m[0] == Approx(1.0));
  CHECK(scan.range_m[90] == Approx(1.9));  // a quarter clockwise
  CHECK(scan.angle_rad(90) == Approx(-90.5 * kPi / 180.0));
  CHECK_FALSE(scan.is_hit(99));
  CHECK(to_seconds(scan.sweep) == Approx(0.1).margin(0.003));
  // Turns begin each 100 ms from 1 ms on; a point comes up to eight points, 2.2 ms, and a step of 1 ms after it.
  const Duration into = (scan.stamp.time_since_epoch() - 1ms) % 100ms;
  CHECK(into <= 4ms);
  const ScannerHealth health = bench->health();
  CHECK(health.scans >= 17);  // 20 turns, less the conversation, the first and the last
  CHECK(health.malformed + health.late + health.protocol.skipped_bytes == 0);
  CHECK(bench->heap_calls == 0);
}

TEST_CASE("an RPLIDAR is found again after damage and noise and silence and a pulled plug") {
  const auto bench = rplidar_bench();
  if (bench != nullptr) check_faults(*bench);
}

TEST_CASE("an RPLIDAR that is broken is named so and asked again with rests") {
  const auto bench = rplidar_bench();
  if (bench == nullptr) return;
  bench->server->break_down();
  bench->run(3s);
  CHECK(bench->health().last_trouble == ScannerTrouble::kRefused);
  CHECK(bench->health().connections == 4);  // rests of 0.3, 0.6, 1.2 s
  CHECK(bench->scan().sequence == 0);
}
