// What each kind of scanner says, on its own wire, of beams that were lost and of beams that found nothing.
#include <chrono>
#include <limits>

#include "tests/drivers/scanner_kinds.h"

using namespace jaywalk;
using namespace std::chrono_literals;
using emulators::Window;
using tests::ScannerBench;

namespace {

/// Beams 20 to 59 find nothing in reach, the others a wall at 2 m.
void look(std::size_t first, std::span<float> range_m) {
  for (std::size_t k = 0; k < range_m.size(); ++k) {
    const bool free = first + k >= 20 && first + k < 60;
    range_m[k] = free ? std::numeric_limits<float>::infinity() : 2.0F;
  }
}

/// Beams 20 to 59 are `nothing`; 100 to 119, once lost, are unknown, and nothing else changes.
void check_losses(const std::unique_ptr<ScannerBench>& made, BeamState nothing) {
  if (made == nullptr) return;
  ScannerBench& bench = *made;
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
void check_dirt(const std::unique_ptr<ScannerBench>& made) {
  if (made == nullptr) return;
  ScannerBench& bench = *made;
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

TEST_CASE(
    "nothing in reach is free room only where a scanner has a word for it, and lost beams are not taken for that") {
  check_losses(tests::sick_bench(look), BeamState::kUnknown);  // says the same where it cannot measure
  check_losses(tests::hokuyo_bench(look), BeamState::kFree);   // a UTM-30LX
  check_losses(tests::lms200_bench(look), BeamState::kFree);   // dazzled beams are the lost ones
  check_losses(tests::rplidar_bench(look), BeamState::kUnknown);
}

TEST_CASE("a warning of dirt is counted and the scans taken, but not once the scanner says that it cannot measure") {
  check_dirt(tests::sick_bench(look, emulators::ColaDialect::kText));
  check_dirt(tests::sick_bench(look, emulators::ColaDialect::kBinary));
  check_dirt(tests::lms200_bench(look));
}

TEST_CASE("values that an LMS200 itself calls implausible are no scan") {
  const auto bench = tests::lms200_bench(look);
  if (bench == nullptr) return;
  bench->run(1s);
  bench->as<emulators::Lms200Server>().set_status(0x40);
  bench->run(500ms);
  CHECK(bench->health().trouble == ScannerTrouble::kDeviceError);
}

TEST_CASE("damaged packets of an LD19 leave their sectors unknown and the others as they are") {
  const auto bench = tests::ld_bench(look);
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
