// What a robot with several scanners records.
#include <memory>

#include "firmware/control_setup.h"
#include "tests/recording/made_ticks.h"
#include "tests/support/catch.h"

namespace jaywalk {
namespace {

/// Tick `n` with a second scan every other tick and a third every fourth.
std::unique_ptr<TickRecord> made(std::uint32_t n) {
  auto record = made_tick(n);
  for (const std::uint32_t every : {2U, 4U}) {
    LaserScan scan = record->scan;
    scan.sequence = 1 + n / every;
    scan.stamp = Time{Duration{500 + scan.sequence}};
    scan.range_m[0] = static_cast<float>(100 * every + n / every);
    scan.scanner = every == 2U ? 1 : 2;
    REQUIRE(record->other_scans.push_back(scan));
  }
  record->verdict.faulty_scanners = static_cast<std::uint8_t>(n % 8);
  return record;
}

TEST_CASE("each scanner's scans come back with the tick that they were new in, and which of them were faulty") {
  TickEncoder encoder;
  TickDecoder decoder;
  std::vector<unsigned char> bytes(kMaxEntryBytes);
  const auto read = std::make_unique<TickRecord>();
  for (std::uint32_t n = 0; n < 40; ++n) {
    const auto written = made(n);
    const std::size_t length = encoder.encode(*written, n, bytes);
    std::uint64_t lost = 0;
    REQUIRE(decoder.decode(std::span(bytes).first(length), *read, lost));
    CHECK(lost == n);
    CHECK(same_bits(*read, *written));
    REQUIRE(read->other_scans.size() == 2);
    for (std::size_t k = 0; k < 2; ++k) {
      CHECK(same_scan(read->other_scans[k], written->other_scans[k]));
      CHECK(read->other_scans[k].scanner == k + 1);
    }
    CHECK(read->verdict.faulty_scanners == n % 8);
  }
}

TEST_CASE("a scan that is not new takes a byte, and one scanner's record none for others") {
  TickEncoder one, several;
  std::vector<unsigned char> bytes(kMaxEntryBytes);
  (void)one.encode(*made_tick(0), 0, bytes), (void)several.encode(*made(0), 0, bytes);
  CHECK(several.encode(*made(1), 0, bytes) == one.encode(*made_tick(1), 0, bytes) + 1 + 4 + 2);
}

TEST_CASE("a record that says it has more scanners than there can be, or none, is refused") {
  const std::size_t count_at = entry_of(*made_tick(0)).size() + 1;
  std::vector<unsigned char> bytes = entry_of(*made(0));
  REQUIRE(record_of(bytes));
  for (const int count : {0, 4}) {
    bytes[count_at] = static_cast<unsigned char>(count);
    CHECK_FALSE(record_of(bytes));
  }
}

TEST_CASE("a setup keeps every scanner with its blanked sectors, and of one alone says nothing of others") {
  ControlSetup setup;
  setup.model = p3dx();
  CHECK(to_text(setup).find("other_lasers") == std::string::npos);
  LaserModel rear = setup.model.laser;
  rear.robot_from_laser = {-0.2, 0.1, 3.0};
  rear.rate_hz = 25.0;
  REQUIRE(rear.blanked.push_back({-0.5, 0.25}));
  REQUIRE(setup.model.other_lasers.push_back(rear));
  const ControlSetup read = setup_from_text(to_text(setup), "here");
  REQUIRE(read.model.lasers().size() == 2);
  const LaserModel& again = read.model.lasers()[1];
  CHECK(again.robot_from_laser == rear.robot_from_laser);
  CHECK(again.rate_hz == 25.0);
  REQUIRE(again.blanked.size() == 1);
  CHECK(again.blanked[0].to_rad == 0.25);
  CHECK(read.model.laser.blanked.empty());
}

}  // namespace
}  // namespace jaywalk
