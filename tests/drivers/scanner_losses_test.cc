// What each kind of scanner says, on its own wire, of beams that were lost and of beams that found nothing.
#include <chrono>
#include <limits>

#include "hil/emulators/ld_server.h"
#include "hil/emulators/lms200_server.h"
#include "hil/emulators/rplidar_server.h"
#include "hil/emulators/scip_server.h"
#include "hil/emulators/sick_server.h"
#include "drivers/laser/ld_protocol.h"
#include "drivers/laser/lms200_protocol.h"
#include "drivers/laser/rplidar_protocol.h"
#include "drivers/laser/scip_protocol.h"
#include "drivers/laser/sick_protocol.h"
#include "tests/drivers/scanner_bench.h"
#include "tests/drivers/serial_line.h"
#include "tests/support/catch.h"

using namespace jaywalk;
using namespace std::chrono_literals;
using emulators::Window;

namespace {

/// Beams 20 to 59 find nothing in reach, the others a wall at 2 m.
void look(std::size_t first, std::span<float> range_m) {
  for (std::size_t k = 0; k < range_m.size(); ++k) {
    const bool free = first + k >= 20 && first + k < 60;
    range_m[k] = free ? std::numeric_limits<float>::infinity() : 2.0F;
  }
}

template <class Server, class... Model>
std::unique_ptr<tests::ScannerBench<Server>> on_tcp(std::unique_ptr<ScannerProtocol> protocol, const Model&... model) {
  auto line = std::make_unique<emulators::TcpServer>(std::uint16_t{0});
  auto endpoint = std::make_unique<wire::TcpEndpoint>("127.0.0.1", line->port());
  return std::make_unique<tests::ScannerBench<Server>>(std::make_unique<Server>(std::move(line), model..., look),
                                                       std::move(endpoint), std::move(protocol));
}

/// None where this machine has no pseudo terminals.
template <class Server, class... Rest>
std::unique_ptr<tests::ScannerBench<Server>> on_line(std::unique_ptr<ScannerProtocol> protocol, std::uint32_t baud,
                                                     const Rest&... rest) {
  auto line = tests::serial_line();
  if (line == nullptr) return nullptr;
  auto endpoint = std::make_unique<wire::SerialEndpoint>(line->path(), baud);
  return std::make_unique<tests::ScannerBench<Server>>(std::make_unique<Server>(std::move(line), rest..., look),
                                                       std::move(endpoint), std::move(protocol));
}

auto sick_bench(emulators::ColaDialect dialect = emulators::ColaDialect::kBinary) {
  const auto cola = dialect == emulators::ColaDialect::kText ? sick::Cola::kA : sick::Cola::kB;
  return on_tcp<emulators::SickServer>(std::make_unique<sick::SickProtocol>(cola, sick::ScannerModel{}),
                                       emulators::SickModel{.dialect = dialect});
}
auto scip_bench() {
  return on_tcp<emulators::ScipServer>(std::make_unique<scip::ScipProtocol>(), emulators::ScipModel{});
}
auto lms200_bench() {
  return on_line<emulators::Lms200Server>(std::make_unique<lms200::Lms200Protocol>(38400), 38400, std::uint32_t{38400});
}
auto rplidar_bench() { return on_line<emulators::RplidarServer>(std::make_unique<rplidar::RplidarProtocol>(), 115200); }
auto ld_bench() { return on_line<emulators::LdServer>(std::make_unique<ldrobot::LdProtocol>(), 230400); }

/// Beams 20 to 59 are `nothing`; 100 to 119, once lost, are unknown, and nothing else changes.
template <class Bench>
void check_losses(Bench& bench, BeamState nothing) {
  const auto check = [&bench, nothing](bool lost) {
    REQUIRE(bench.is_well());
    for (std::size_t k = 0; k < 150; ++k) {
      INFO(k);
      if (k >= 20 && k < 60) {
        REQUIRE(bench.scan().state(k) == nothing);
      } else if (lost && k >= 100 && k < 120) {
        REQUIRE(bench.scan().state(k) == BeamState::kUnknown);
      } else {
        REQUIRE(bench.scan().state(k) == BeamState::kHit);
      }
    }
  };
  bench.run(1500ms);
  check(false);
  bench.server->lose_beams(100, 20);
  bench.run(500ms);
  check(true);
  bench.server->find_beams();
  bench.run(500ms);
  check(false);
}

/// It warns and measures, then it can measure no more, then it is clean.
template <class Bench>
void check_dirt(Bench& bench) {
  bench.run(1500ms);
  REQUIRE(bench.is_well());
  CHECK(bench.health().protocol.warned == 0);
  REQUIRE(bench.server->set_window(Window::kSoiled));
  bench.run(500ms);
  CHECK(bench.is_well());
  CHECK(bench.health().protocol.warned >= 3);  // the slowest sends nine in a second
  REQUIRE(bench.server->set_window(Window::kDirty));
  bench.run(300ms);  // what was on the line
  const std::uint32_t sequence = bench.scan().sequence;
  bench.run(400ms);
  CHECK(bench.scan().sequence == sequence);
  CHECK(bench.health().trouble == ScannerTrouble::kDirty);
  CHECK(name(bench.health().trouble) == "scanner's window is dirty");
  REQUIRE(bench.server->set_window(Window::kClean));
  bench.run(500ms);
  CHECK(bench.is_well());
  CHECK(bench.heap_calls == 0);
}

}  // namespace

TEST_CASE("a SICK that finds nothing says the same as one that cannot measure, and neither is free room") {
  check_losses(*sick_bench(), BeamState::kUnknown);
}

TEST_CASE("a Hokuyo UTM-30LX that finds nothing says so, and lost beams are not taken for that") {
  check_losses(*scip_bench(), BeamState::kFree);
}

TEST_CASE("an LMS200 that finds nothing says so, and dazzled beams are not taken for that") {
  if (const auto bench = lms200_bench()) check_losses(*bench, BeamState::kFree);
}

TEST_CASE("an RPLIDAR has no word for nothing in reach") {
  if (const auto bench = rplidar_bench()) check_losses(*bench, BeamState::kUnknown);
}

TEST_CASE("a SICK's warning of dirt is counted and its scans taken, but not once it says that it cannot measure") {
  check_dirt(*sick_bench(emulators::ColaDialect::kText));
  check_dirt(*sick_bench(emulators::ColaDialect::kBinary));
}

TEST_CASE("an LMS200's warning of dirt is counted and its scans taken, but not once it says that it cannot measure") {
  if (const auto bench = lms200_bench()) check_dirt(*bench);
}

TEST_CASE("values that an LMS200 itself calls implausible are no scan") {
  const auto bench = lms200_bench();
  if (bench == nullptr) return;
  bench->run(1s);
  bench->server->set_status(0x40);
  bench->run(500ms);
  CHECK(bench->health().trouble == ScannerTrouble::kDeviceError);
}

TEST_CASE("a Hokuyo whose laser fails while it scans is named so until it is well") {
  const auto bench = scip_bench();
  bench->run(500ms);
  REQUIRE(bench->is_well());
  bench->server->set_status("0L");
  bench->run(100ms);
  const std::uint32_t sequence = bench->scan().sequence;
  bench->run(200ms);
  CHECK(bench->health().trouble == ScannerTrouble::kDeviceError);
  CHECK(bench->scan().sequence == sequence);
  bench->server->set_status("");
  bench->run(200ms);
  CHECK(bench->is_well());
}

TEST_CASE("damaged packets of an LD19 leave their sectors unknown and the others as they are") {
  const auto bench = ld_bench();
  if (bench == nullptr) return;
  bench->run(1s);
  bench->server->damage_share(0.3);
  std::size_t unknown = 0, beams = 0;
  for (std::uint32_t sequence = 0; beams < 20 * 450; bench->run(10ms)) {
    const LaserScan& scan = bench->scan();
    if (scan.sequence == sequence) continue;
    sequence = scan.sequence;
    for (std::size_t k = 65; k < 450; ++k) {  // the others look where nothing is in reach
      if (scan.state(k) == BeamState::kUnknown) ++unknown;
      REQUIRE(scan.state(k) != BeamState::kFree);
      if (scan.state(k) == BeamState::kHit) REQUIRE(scan.range_m[k] == Approx(2.0F));
    }
    beams += 450;
  }
  // 20 turns of 38 packets: 30 percent of the 385 sectors, give or take three times sqrt(0.21 / 650).
  CHECK(static_cast<double>(unknown) / (20.0 * 385.0) == Approx(0.3).margin(0.055));
  bench->server->damage_share(0.0);
  bench->run(300ms);
  for (std::size_t k = 65; k < 450; ++k) REQUIRE(bench->scan().state(k) == BeamState::kHit);
}
