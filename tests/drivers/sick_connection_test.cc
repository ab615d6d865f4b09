#include <algorithm>
#include <chrono>
#include <deque>
#include <string>
#include <vector>

#include "drivers/laser/sick.h"
#include "firmware/robot/realtime.h"
#include "hal/types/errors.h"
#include "tests/drivers/data_files.h"
#include "tests/drivers/scanner_kinds.h"

using namespace jaywalk;
using namespace std::chrono_literals;
using emulators::ScannerFault;

namespace {

constexpr Duration kPeriod = duration_from_seconds(1.0 / 15.0);

/// A scanner in the middle of a round room, and when each of its sweeps began.
struct Bench {
  Bench()
      : at(tests::sick_bench([this](std::size_t first, std::span<float> range_m) {
          if (first == 0) began.push_back(at->clock.now());
          std::fill(range_m.begin(), range_m.end(), 1.0F);
        })) {}
  /// A fault after some good scans: what the connection calls it, and how long scans stay away.
  struct Outage {
    ScannerTrouble trouble;
    Duration lasted;
  };
  Outage suffer(ScannerFault fault, Duration lasts) {
    at->come_to_life();
    at->server->order(fault, lasts);
    at->run_until([this] { return !at->is_well(); }, 4s);
    const Outage outage{at->health().trouble, at->run_until([this] { return at->is_well(); }, 20s)};
    REQUIRE(at->is_well());
    return outage;
  }
  [[nodiscard]] emulators::SickServer& sick() { return at->as<emulators::SickServer>(); }

  std::deque<Time> began;
  std::unique_ptr<tests::ScannerBench> at;
};

}  // namespace

TEST_CASE("scans that were held back look as old as they are") {
  Bench bench;
  bench.at->come_to_life();
  bench.at->server->order(ScannerFault::kHeldBack, 400ms);
  const std::uint32_t before = bench.at->scan().sequence;
  Duration oldest = 0s;
  bench.at->run_until(
      [&] {
        const LaserScan& scan = bench.at->scan();
        if (scan.sequence > before) oldest = std::max(oldest, bench.at->clock.now() - scan.stamp);
        return scan.sequence > before;
      },
      1s);
  // What came at once ends with a scan of the last 67 ms and its sweep of 50 ms.
  CHECK(bench.at->scan().sequence >= before + 5);
  CHECK(oldest <= 2 * kPeriod);
  const std::deque<Time>& began = bench.began;
  CHECK(std::any_of(began.begin(), began.end(),
                    [&](Time t) { return std::chrono::abs(bench.at->scan().stamp - t) <= 1ms; }));
}

TEST_CASE("of scans that come at once on a new connection none is handed out that is no newer than the one before") {
  Bench bench;
  bench.at->server->order(ScannerFault::kHeldBack, 500ms);
  bench.at->run_until([&] { return bench.at->health().scans > 0; }, 2s);
  // Seven had been held; nothing tells when they were taken, so they look simultaneous to a millisecond.
  const ScannerHealth health = bench.at->health();
  CHECK(health.late >= 3);
  CHECK(health.scans + health.late == bench.at->server->messages_sent());
  CHECK(bench.at->scan().sequence == health.scans);
}

TEST_CASE("a wire that begins to hold every scan back for 0.7 s is given up") {
  Bench bench;
  const auto outage = bench.suffer(ScannerFault::kDelayed, 1500ms);
  CHECK(outage.trouble == ScannerTrouble::kLate);
  // The first comes 0.7 s after the last good one; 1 s after that one it is over.
  CHECK(bench.at->health().late >= 4);
  CHECK(bench.at->health().late <= 6);
}

TEST_CASE("a scanner that is not there is looked for until it comes") {
  Bench bench;
  bench.at->server->order(ScannerFault::kGone, 5s);
  bench.at->run(4s);
  CHECK(bench.at->health().trouble == ScannerTrouble::kUnreachable);
  CHECK(name(bench.at->health().trouble) == "scanner unreachable");
  CHECK(bench.at->scan().sequence == 0);
  // Gone for one second more, then at the latest after the longest rest of 1.6 s and a sweep.
  CHECK(bench.at->run_until([&] { return bench.at->is_well(); }, 10s) <= 1s + 1600ms + 2 * kPeriod + 20ms);
}

TEST_CASE("a scanner that falls silent is called again and again") {
  Bench bench;
  const auto outage = bench.suffer(ScannerFault::kSilence, 5s);
  CHECK(outage.trouble == ScannerTrouble::kSilent);
  CHECK(bench.at->health().last_trouble == ScannerTrouble::kNoAnswer);  // four commands, a second each
  CHECK(bench.at->health().connections >= 3);
  // Silent for 4 s more; then an answer awaited in vain for 1 s, a rest, the conversation and a sweep.
  CHECK(outage.lasted <= 4s + 1s + 1600ms + 2 * kPeriod + 20ms);
}

TEST_CASE("a setting that a scanner refuses is counted and does not keep scans away") {
  Bench bench;
  bench.sick().refuse("LMDscandatacfg");
  bench.at->come_to_life();
  CHECK(bench.at->health().protocol.refused == 1);
}

TEST_CASE("a setting that a scanner does not answer is counted and passed over after a second") {
  Bench bench;
  bench.sick().ignore("LMDscandatacfg");
  CHECK(bench.at->run_until([&] { return bench.at->is_well(); }, 5s) <= 1s + 2 * kPeriod + 20ms);
  CHECK(bench.at->is_well());
  CHECK(bench.at->health().protocol.refused == 1);
  CHECK(bench.at->health().connections == 1);
}

TEST_CASE("a host that nobody knows is refused at start") {
  CHECK_THROWS_AS(wire::tcp_endpoint("no such host.invalid", 2112), StartupError);
}

TEST_CASE("the 16 real telegrams of a TiM come over TCP as they came from it") {
  const auto path = tests::data_file("sick/sick_tim_colaB_16_telegrams.bin");
  if (path.empty()) return;
  const std::vector<std::uint8_t> recorded = tests::read_bytes(path);
  emulators::TcpServer wire(0);
  tests::HandClock clock;
  ScannerConnection connection(std::make_unique<wire::ByteLink>(wire::tcp_endpoint("127.0.0.1", wire.port())),
                               std::make_unique<sick::SickProtocol>(sick::Cola::kB, sick::ScannerModel{}), clock);
  Duration least = 1s, most = 0s;
  Time before = kNever;
  for (std::size_t at = 0; at < recorded.size();) {
    clock.sleep_until(clock.now() + 1ms);
    connection.step();
    // A telegram of 3374 bytes each 67 ms, in the pieces that an Ethernet makes of it; nobody answers commands.
    const std::size_t due = 3374 * (1 + static_cast<std::size_t>((clock.now().time_since_epoch() - 1ms) / 67ms));
    if (!wire.has_peer() || at >= due) continue;
    const std::size_t piece = std::min({std::size_t{1448}, due - at, recorded.size() - at});
    wire.write(wire::Bytes(recorded).subspan(at, piece));
    at += piece;
    connection.step();
    const Time stamp = connection.latest().stamp;
    if (stamp == before) continue;
    if (before == kNever) CHECK(connection.latest().range_m[0] == Approx(0.626F));  // 0272h behind the count 032Bh
    if (before != kNever) least = std::min(least, stamp - before), most = std::max(most, stamp - before);
    before = stamp;
  }
  const LaserScan& scan = connection.latest();
  CHECK(scan.sequence == 16);
  REQUIRE(scan.beam_count == 811);
  CHECK(scan.first_angle_rad == Approx(-2.3561945));
  CHECK(scan.angle_step_rad == Approx(0.0058172).epsilon(1e-4));  // 0.3333 degrees
  CHECK(to_seconds(scan.period) == Approx(1.0 / 15.0));
  CHECK(to_seconds(scan.sweep) == Approx(0.049995));  // 810 of 0.3333 degrees are 269.97: 0.74993 of a period
  int hits = 0, unknown = 0;
  std::uint64_t sum_mm = 0;
  for (std::size_t beam = 0; beam < 811; ++beam) {
    hits += scan.state(beam) == BeamState::kHit ? 1 : 0;
    unknown += scan.state(beam) == BeamState::kUnknown ? 1 : 0;
    sum_mm += static_cast<std::uint64_t>(scan.range_m[beam] * 1000.0F + 0.5F);
  }
  CHECK(hits == 799);
  CHECK(unknown == 12);
  CHECK(sum_mm == 875474);  // added up from its bytes, less the 12 beams that it says 2 for
  const ScannerHealth health = connection.health();
  CHECK(health.malformed + health.late + health.protocol.lost + health.protocol.skipped_bytes == 0);
  // The scanner's own clock put 66.6 to 66.7 ms between them, and 0.8 ms more or less into sending them.
  CHECK(least >= 65ms);
  CHECK(most <= 69ms);
}

TEST_CASE("a connection with a thread of its own brings scans in real time and ends at once") {
  SteadyClock clock;
  auto wire = std::make_unique<emulators::TcpServer>(std::uint16_t{0});
  const std::uint16_t port = wire->port();
  emulators::SickServer server(std::move(wire), {}, tests::round_room);
  const Time began = clock.now();
  Time ends;
  {
    ScannerConnection connection(std::make_unique<wire::ByteLink>(wire::tcp_endpoint("127.0.0.1", port)),
                                 std::make_unique<sick::SickProtocol>(sick::Cola::kB, sick::ScannerModel{}), clock);
    CHECK(connection.start());
    while (connection.latest().sequence < 5) {
      server.step(clock.now());
      clock.sleep_until(clock.now() + 1ms);
    }
    CHECK(connection.latest().range_m[400] == Approx(2.0));
    CHECK(connection.latest().stamp > began);
    CHECK(connection.health().last_trouble == ScannerTrouble::kNone);
    ends = clock.now();
  }
  CHECK(clock.now() < ends + 1s);
}
