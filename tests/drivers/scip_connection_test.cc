#include <chrono>
#include <string>

#include "hil/emulators/scip_server.h"
#include "drivers/laser/scip_protocol.h"
#include "tests/drivers/scanner_bench.h"
#include "tests/drivers/serial_line.h"
#include "tests/support/catch.h"

using namespace jaywalk;
using namespace std::chrono_literals;
using emulators::ScannerFault;
using Bench = tests::ScannerBench<emulators::ScipServer>;

namespace {

constexpr Duration kPeriod = 25ms;

/// A beam sees a metre and a millimetre a beam more; the last ten see nothing.
auto world_of(std::size_t beams) {
  return [beams](std::size_t first, std::span<float> range_m) {
    for (std::size_t k = 0; k < range_m.size(); ++k) {
      range_m[k] = first + k + 10 < beams ? 1.0F + 0.001F * static_cast<float>(first + k) : 0.0F;
    }
  };
}

std::unique_ptr<Bench> bench_on(std::unique_ptr<emulators::ByteServer> line, std::unique_ptr<wire::Endpoint> endpoint,
                                const emulators::ScipModel& model = {}) {
  auto server =
      std::make_unique<emulators::ScipServer>(std::move(line), model, world_of(model.last_step - model.first_step + 1));
  return std::make_unique<Bench>(std::move(server), std::move(endpoint), std::make_unique<scip::ScipProtocol>());
}

std::unique_ptr<Bench> bench_on_tcp(const emulators::ScipModel& model = {}) {
  auto line = std::make_unique<emulators::TcpServer>(std::uint16_t{0});
  const std::uint16_t port = line->port();
  return bench_on(std::move(line), std::make_unique<wire::TcpEndpoint>("127.0.0.1", port), model);
}

/// None where this machine has no pseudo terminals.
std::unique_ptr<Bench> bench_on_serial() {
  auto line = tests::serial_line();
  if (line == nullptr) return nullptr;
  auto endpoint = std::make_unique<wire::SerialEndpoint>(line->path(), 115200);
  return bench_on(std::move(line), std::move(endpoint));
}

void check_whole(Bench& bench) {
  bench.run(1s);
  const LaserScan& scan = bench.scan();
  REQUIRE(scan.beam_count == 1081);
  CHECK(scan.first_angle_rad == Approx(-2.3561945));  // 540 steps of a quarter degree to the right
  CHECK(scan.angle_step_rad == Approx(0.0043633));
  CHECK(scan.range_m[0] == Approx(1.0));
  CHECK(scan.range_m[1070] == Approx(2.07));
  CHECK_FALSE(scan.is_hit(1071));
  CHECK(scan.range_max_m == Approx(60.0));
  CHECK(scan.period == kPeriod);
  const ScannerHealth health = bench.health();
  CHECK(health.trouble == ScannerTrouble::kNone);
  CHECK(health.scans >= 37);  // 40 in a second, less what the conversation took
  CHECK(health.scans == bench.server->messages_sent());
  CHECK(health.malformed + health.late + health.protocol.lost + health.protocol.skipped_bytes == 0);
  CHECK(bench.heap_calls == 0);
}

void come_to_life(Bench& bench) {
  bench.run_until([&] { return bench.is_well(); }, 5s);
  bench.run(100ms);
  REQUIRE(bench.is_well());
}

}  // namespace

TEST_CASE("a Hokuyo on a network says what it is and its scans come whole") { check_whole(*bench_on_tcp()); }

TEST_CASE("a Hokuyo on a serial line says what it is and its scans come whole") {
  const auto bench = bench_on_serial();
  if (bench == nullptr) return;
  check_whole(*bench);
}

TEST_CASE("the stamp of a Hokuyo's scan is when its first beam was measured") {
  const auto bench = bench_on_tcp();
  for (int k = 0; k < 150; ++k) {  // the scanner's clock wraps after two seconds
    bench->run(25ms);
    const LaserScan& scan = bench->scan();
    if (scan.sequence == 0) continue;
    // Sweeps begin at 1 ms, 26 ms, ... of the bench's clock; its steps and the scanner's clock count milliseconds, and
    // a scanner's clock that is trusted for 25 ms may be wrong by 10 us.
    const Duration into = (scan.stamp.time_since_epoch() - 1ms + 2ms) % kPeriod;
    REQUIRE(into >= 1ms);
    REQUIRE(into <= 3ms);
    REQUIRE(bench->clock.now() - scan.stamp <= 2 * kPeriod);
  }
}

TEST_CASE("a serial line with a scanner that still sends what somebody else asked for is quieted first") {
  auto line = tests::serial_line();
  if (line == nullptr) return;
  auto endpoint = std::make_unique<wire::SerialEndpoint>(line->path(), 115200);
  const wire::SerialEndpoint before(line->path(), 115200);
  const auto bench = bench_on(std::move(line), std::move(endpoint));
  {
    const wire::FileDescriptor somebody = before.open();
    const std::string asked = "BM\nMD0100020001000\n";
    REQUIRE(::write(somebody.get(), asked.data(), asked.size()) == static_cast<ssize_t>(asked.size()));
    bench->server->step(bench->clock.now());
    REQUIRE(bench->server->is_streaming());
  }
  come_to_life(*bench);
  CHECK(bench->scan().beam_count == 1081);
  CHECK(bench->health().malformed == 0);
}

TEST_CASE("a Hokuyo with more steps than a scan may have beams joins neighbours") {
  const auto bench = bench_on_tcp({.steps_per_turn = 4096, .first_step = 100, .last_step = 3171, .front_step = 1636});
  come_to_life(*bench);
  const LaserScan& scan = bench->scan();
  REQUIRE(scan.beam_count == 1536);                        // 3072 steps by two
  CHECK(scan.first_angle_rad == Approx(-2.3561945));       // -1536 of 4096 steps to a turn
  CHECK(scan.angle_step_rad == Approx(2.0 * 0.00153398));  // 2 pi / 4096
  CHECK(scan.range_m[100] == Approx(1.2));                 // beams 200 and 201: the nearer
}

TEST_CASE("a Hokuyo whose laser does not come on is named so and asked again with rests") {
  const auto bench = bench_on_tcp();
  bench->server->break_laser();
  bench->run(3s);
  CHECK(bench->health().last_trouble == ScannerTrouble::kRefused);
  CHECK(bench->health().connections == 4);  // rests of 0.3, 0.6, 1.2 s
}

TEST_CASE("half an answer of a Hokuyo costs one scan") {
  const auto bench = bench_on_tcp();
  come_to_life(*bench);
  const std::uint64_t sent = bench->server->messages_sent();
  const std::uint64_t heard = bench->health().scans;
  bench->server->order(ScannerFault::kHalfTelegram);
  bench->run(1s);
  CHECK(bench->server->messages_sent() - sent == bench->health().scans - heard + 1);
  CHECK(bench->health().protocol.lost == 1);
  CHECK(bench->health().protocol.skipped_bytes > 1600);  // half of 1081 x 3 characters
  CHECK(bench->health().connections == 1);
}

TEST_CASE("scans of a Hokuyo with a damaged byte are never handed out and noise is got over") {
  for (const ScannerFault fault : {ScannerFault::kDamage, ScannerFault::kGarbage}) {
    const auto bench = bench_on_tcp();
    come_to_life(*bench);
    const std::uint32_t before = bench->scan().sequence;
    bench->server->order(fault, 500ms);
    bench->run(510ms);
    CHECK(bench->scan().sequence <= before + 1);
    bench->run(200ms);
    CHECK(bench->scan().sequence > before + 1);
    CHECK(bench->health().malformed + bench->health().protocol.skipped_bytes > 0);
    CHECK(bench->health().connections == 1);
    CHECK(bench->heap_calls == 0);
  }
}

TEST_CASE("a Hokuyo that is reset or silent or gone is found again") {
  for (const bool serial : {false, true}) {
    const auto bench = serial ? bench_on_serial() : bench_on_tcp();
    if (bench == nullptr) return;
    come_to_life(*bench);
    bench->server->order(ScannerFault::kSilence, 2s);
    bench->run(1100ms);
    CHECK(bench->health().trouble == ScannerTrouble::kSilent);
    come_to_life(*bench);
    bench->server->order(ScannerFault::kGone, 10s);
    bench->run(1s);
    CHECK(bench->health().last_trouble == ScannerTrouble::kUnreachable);
    CHECK(bench->run_until([&] { return bench->is_well(); }, 12s) <= 9s + 1600ms + 2 * kPeriod + 20ms);
    CHECK(bench->is_well());
    if (!serial) {
      bench->server->order(ScannerFault::kReset);
      bench->run(10ms);
      CHECK(bench->health().trouble == ScannerTrouble::kClosed);
      come_to_life(*bench);
    }
    CHECK(bench->heap_calls == 0);
  }
}
