// Scanners as their users report them: dialects and angles that differ from the manual.
#include <chrono>

#include "drivers/laser/scip.h"
#include "drivers/laser/sick.h"
#include "tests/drivers/scanner_kinds.h"
#include "tests/drivers/serial_line.h"

using namespace jaywalk;
using namespace std::chrono_literals;
using tests::round_room;

TEST_CASE("an RPLIDAR whose turns end at 360 degrees or beyond gives a scan a turn") {
  for (const double first_deg : {1.0, 1.5, 5.0}) {
    const auto bench = tests::rplidar_bench(round_room);
    if (bench == nullptr) return;
    bench->as<emulators::RplidarServer>().begin_turns_at(first_deg);
    bench->come_to_life();
    const std::uint64_t before = bench->health().scans;
    bench->run(1s);
    CHECK(bench->health().scans >= before + 9);
    CHECK(bench->health().protocol.skipped_bytes == 0);
    CHECK(bench->scan().range_m[0] == Approx(2.0));
    CHECK(bench->scan().range_m[180] == Approx(2.0));
  }
}

TEST_CASE("a Hokuyo that begins with SCIP 1.1 is told to speak SCIP 2.0") {
  const auto bench = tests::hokuyo_bench(round_room);
  bench->as<emulators::ScipServer>().begin_with_scip_1();
  bench->come_to_life();
  CHECK(bench->health().connections == 1);
}

TEST_CASE("a SICK scanner whose port speaks the other dialect is spoken to in that one, and goes on so") {
  for (const auto dialect : {emulators::ColaDialect::kText, emulators::ColaDialect::kBinary}) {
    const bool is_text = dialect == emulators::ColaDialect::kText;
    auto line = std::make_unique<emulators::TcpServer>(std::uint16_t{0});
    auto endpoint = wire::tcp_endpoint("127.0.0.1", line->port());
    tests::ScannerBench bench(
        std::make_unique<emulators::SickServer>(std::move(line), emulators::SickModel{.dialect = dialect}, round_room),
        std::move(endpoint),
        std::make_unique<sick::SickProtocol>(is_text ? sick::Cola::kB : sick::Cola::kA, sick::ScannerModel{}));
    bench.come_to_life();  // four commands without an answer, a second each
    CHECK(bench.health().connections == 2);
    bench.server->order(emulators::ScannerFault::kGone, 3s);
    bench.run(2s);
    CHECK_FALSE(bench.is_well());
    bench.run(3s);
    CHECK(bench.is_well());
  }
}

TEST_CASE("a serial line with a scanner that still sends what somebody else asked for is quieted first") {
  auto line = tests::serial_line();
  if (line == nullptr) return;
  auto endpoint = wire::serial_endpoint(line->path(), 115200);
  const wire::Endpoint before = endpoint;
  tests::ScannerBench bench(
      std::make_unique<emulators::ScipServer>(std::move(line), emulators::ScipModel{}, round_room), std::move(endpoint),
      std::make_unique<scip::ScipProtocol>());
  {
    const wire::FileDescriptor somebody = before.open();
    const std::string asked = "BM\nMD0100020001000\n";
    REQUIRE(::write(somebody.get(), asked.data(), asked.size()) == static_cast<ssize_t>(asked.size()));
    bench.server->step(bench.clock.now());
    REQUIRE(bench.server->is_streaming());
  }
  bench.come_to_life();
  CHECK(bench.scan().beam_count == 1081);
  CHECK(bench.health().malformed == 0);
}
