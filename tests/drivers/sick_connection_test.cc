#include <algorithm>
#include <chrono>
#include <deque>
#include <string>
#include <vector>

#include "hil/emulators/sick_server.h"
#include "drivers/laser/sick_protocol.h"
#include "hal/types/errors.h"
#include "tests/drivers/data_files.h"
#include "tests/drivers/scanner_bench.h"
#include "tests/support/catch.h"

using namespace jaywalk;
using namespace std::chrono_literals;
using emulators::ColaDialect;
using emulators::ScannerFault;

namespace {

constexpr Duration kPeriod = duration_from_seconds(1.0 / 15.0);

/// A scanner on a TCP port of this machine in the middle of a round room; the radius tells when a beam was measured.
struct Bench {
  explicit Bench(ColaDialect dialect = ColaDialect::kBinary)
      : Bench(std::make_unique<emulators::TcpServer>(std::uint16_t{0}), dialect) {}
  Bench(std::unique_ptr<emulators::TcpServer> wire, ColaDialect dialect)
      : port(wire->port()),
        at(std::make_unique<emulators::SickServer>(
               std::move(wire), emulators::SickModel{.dialect = dialect},
               [this](std::size_t first, std::span<float> range_m) { look(first, range_m); }),
           std::make_unique<wire::TcpEndpoint>("127.0.0.1", port),
           std::make_unique<sick::SickProtocol>(dialect == ColaDialect::kText ? sick::Cola::kA : sick::Cola::kB,
                                                sick::ScannerModel{})) {}

  void look(std::size_t first, std::span<float> range_m) {
    if (first == 0) began.push_back(at.clock.now());
    for (std::size_t k = 0; k < range_m.size(); ++k) {
      range_m[k] = first + k < 800 ? 1.0F + 0.001F * static_cast<float>(first + k) : 0.0F;
    }
  }
  /// Runs until scans come, and a little.
  void come_to_life() {
    at.run_until([this] { return at.is_well(); }, 2s);
    at.run(100ms);
    REQUIRE(at.is_well());
  }
  /// A fault of a second after a second of good scans: what the connection calls it, and how long scans stay away.
  struct Outage {
    ScannerTrouble trouble;
    Duration lasted;
  };
  Outage suffer(ScannerFault fault, Duration lasts) {
    come_to_life();
    at.server->order(fault, lasts);
    at.run_until([this] { return !at.is_well(); }, 4s);
    const Outage outage{at.health().trouble, at.run_until([this] { return at.is_well(); }, 20s)};
    REQUIRE(at.is_well());
    return outage;
  }

  std::uint16_t port;
  std::deque<Time> began;
  tests::ScannerBench<emulators::SickServer> at;
};

}  // namespace

TEST_CASE("a SICK scanner is logged in to and set up and its scans come whole in either dialect") {
  for (const ColaDialect dialect : {ColaDialect::kText, ColaDialect::kBinary}) {
    Bench bench(dialect);
    CHECK(bench.at.scan().sequence == 0);
    bench.at.run(2s);
    const LaserScan& scan = bench.at.scan();
    REQUIRE(scan.beam_count == 811);
    CHECK(scan.first_angle_rad == Approx(-2.3561945));  // -45 degrees of SICK are -135 from straight ahead
    CHECK(scan.angle_step_rad == Approx(0.3333 * kPi / 180.0));
    CHECK(scan.range_m[0] == Approx(1.0));
    CHECK(scan.range_m[799] == Approx(1.799));
    CHECK_FALSE(scan.is_hit(800));
    const ScannerHealth health = bench.at.health();
    CHECK(health.trouble == ScannerTrouble::kNone);
    CHECK(health.scans >= 28);  // 30 in two seconds, less what the conversation took
    CHECK(health.scans == bench.at.server->messages_sent());
    CHECK(scan.sequence == health.scans);
    CHECK(health.connections == 1);
    CHECK(health.malformed + health.late + health.protocol.lost + health.protocol.skipped_bytes == 0);
    CHECK(health.protocol.refused == 0);
    CHECK(bench.at.heap_calls == 0);
  }
}

TEST_CASE("a scan's stamp is when its first beam was measured") {
  Bench bench;
  for (int k = 0; k < 200; ++k) {  // the scanner's clock wraps after ten seconds
    bench.at.run(66ms);
    const LaserScan& scan = bench.at.scan();
    if (scan.sequence < 2) continue;
    Duration nearest = 1s;
    for (const Time began : bench.began) nearest = std::min(nearest, std::chrono::abs(scan.stamp - began));
    REQUIRE(nearest <= 1ms);  // a step of the bench
    REQUIRE(bench.at.clock.now() - scan.stamp <= 2 * kPeriod);
  }
  CHECK(bench.at.scan().sequence > 190);
}

TEST_CASE("scans that were held back look as old as they are") {
  Bench bench;
  bench.come_to_life();
  bench.at.server->order(ScannerFault::kHeldBack, 400ms);
  const std::uint32_t before = bench.at.scan().sequence;
  Duration oldest = 0s;
  bench.at.run_until(
      [&] {
        const LaserScan& scan = bench.at.scan();
        if (scan.sequence > before) oldest = std::max(oldest, bench.at.clock.now() - scan.stamp);
        return scan.sequence > before;
      },
      1s);
  // What came at once ends with a scan of the last 67 ms and its sweep of 50 ms.
  CHECK(bench.at.scan().sequence >= before + 5);
  CHECK(oldest <= 2 * kPeriod);
  const std::deque<Time>& began = bench.began;
  CHECK(std::any_of(began.begin(), began.end(),
                    [&](Time t) { return std::chrono::abs(bench.at.scan().stamp - t) <= 1ms; }));
}

TEST_CASE("of scans that come at once on a new connection none is handed out that is no newer than the one before") {
  Bench bench;
  bench.at.server->order(ScannerFault::kHeldBack, 500ms);
  bench.at.run_until([&] { return bench.at.health().scans > 0; }, 2s);
  // Seven had been held; nothing tells when they were taken, so they look simultaneous to a millisecond.
  const ScannerHealth health = bench.at.health();
  CHECK(health.late >= 3);
  CHECK(health.scans + health.late == bench.at.server->messages_sent());
  CHECK(bench.at.scan().sequence == health.scans);
}

TEST_CASE("a wire that begins to hold every scan back for 0.7 s is given up") {
  Bench bench;
  const auto outage = bench.suffer(ScannerFault::kDelayed, 1500ms);
  CHECK(outage.trouble == ScannerTrouble::kLate);
  // The first comes 0.7 s after the last good one; 1 s after that one it is over.
  CHECK(bench.at.health().late >= 4);
  CHECK(bench.at.health().late <= 6);
}

TEST_CASE("a scanner that is not there is looked for until it comes") {
  Bench bench;
  bench.at.server->order(ScannerFault::kGone, 5s);
  bench.at.run(4s);
  CHECK(bench.at.health().trouble == ScannerTrouble::kUnreachable);
  CHECK(name(bench.at.health().trouble) == "scanner unreachable");
  CHECK(bench.at.scan().sequence == 0);
  // Gone for one second more, then at the latest after the longest rest of 1.6 s and a sweep.
  CHECK(bench.at.run_until([&] { return bench.at.is_well(); }, 10s) <= 1s + 1600ms + 2 * kPeriod + 20ms);
}

TEST_CASE("a scanner that goes for ten seconds is found again") {
  Bench bench;
  bench.come_to_life();
  const LaserScan before = bench.at.scan();
  bench.at.server->order(ScannerFault::kGone, 10s);
  bench.at.run(9s);
  CHECK(bench.at.health().trouble == ScannerTrouble::kUnreachable);
  CHECK(bench.at.scan().stamp - before.stamp <= kPeriod + 1ms);  // the last one grows old
  CHECK(bench.at.run_until([&] { return bench.at.is_well(); }, 10s) <= 1s + 1600ms + 2 * kPeriod + 20ms);
  bench.at.run(100ms);
  CHECK(bench.at.scan().sequence > before.sequence);
  CHECK(bench.at.scan().stamp > before.stamp + 9s);
  CHECK(bench.at.health().connections == 2);
  CHECK(bench.at.heap_calls == 0);
}

TEST_CASE("a connection that the scanner resets is made anew") {
  Bench bench;
  const auto outage = bench.suffer(ScannerFault::kReset, 0s);
  CHECK(outage.trouble == ScannerTrouble::kClosed);
  CHECK(outage.lasted <= 300ms + 2 * kPeriod + 20ms);  // one rest, the conversation, a sweep under way and a whole one
  CHECK(outage.lasted > 300ms);                        // so long that the robot stops, however soon it is back
  CHECK(bench.at.health().last_trouble == ScannerTrouble::kClosed);
  CHECK(bench.at.health().connections == 2);
}

TEST_CASE("half a telegram costs one scan in either dialect") {
  for (const ColaDialect dialect : {ColaDialect::kText, ColaDialect::kBinary}) {
    Bench bench(dialect);
    bench.come_to_life();
    const std::uint64_t sent = bench.at.server->messages_sent();
    const std::uint64_t heard = bench.at.health().scans;
    bench.at.server->order(ScannerFault::kHalfTelegram);
    bench.at.run(1s);
    CHECK(bench.at.server->messages_sent() - sent == bench.at.health().scans - heard + 1);
    CHECK(bench.at.health().protocol.lost == 1);
    CHECK(bench.at.health().protocol.skipped_bytes > 800);
    CHECK(bench.at.is_well());
    CHECK(bench.at.health().connections == 1);
  }
}

TEST_CASE("a scan with a damaged byte is never handed out") {
  for (const ColaDialect dialect : {ColaDialect::kText, ColaDialect::kBinary}) {
    Bench bench(dialect);
    bench.come_to_life();
    const std::uint32_t before = bench.at.scan().sequence;
    bench.at.server->order(ScannerFault::kDamage, 700ms);
    bench.at.run(720ms);
    CHECK(bench.at.scan().sequence <= before + 1);  // one was on its way
    CHECK(bench.at.health().malformed + bench.at.health().protocol.skipped_bytes > 0);
    bench.at.run(200ms);
    CHECK(bench.at.scan().sequence > before + 1);
    CHECK(bench.at.is_well());
  }
}

TEST_CASE("after noise scans are found again without a new connection") {
  for (const ColaDialect dialect : {ColaDialect::kText, ColaDialect::kBinary}) {
    Bench bench(dialect);
    bench.come_to_life();
    bench.at.server->order(ScannerFault::kGarbage, 700ms);
    bench.at.run(720ms);
    const std::uint32_t during = bench.at.scan().sequence;
    bench.at.run(200ms);
    CHECK(bench.at.scan().sequence > during);
    CHECK(bench.at.health().protocol.skipped_bytes >
          9000);  // ten scans of 1.6 kB or more, some of it taken for a beginning
    CHECK(bench.at.health().connections == 1);
    CHECK(bench.at.heap_calls == 0);
  }
}

TEST_CASE("a scanner that falls silent is called again and again") {
  Bench bench;
  const auto outage = bench.suffer(ScannerFault::kSilence, 5s);
  CHECK(outage.trouble == ScannerTrouble::kSilent);
  CHECK(bench.at.health().last_trouble == ScannerTrouble::kNoAnswer);  // four commands, a second each
  CHECK(bench.at.health().connections >= 3);
  // Silent for 4 s more; then an answer awaited in vain for 1 s, a rest, the conversation and a sweep.
  CHECK(outage.lasted <= 4s + 1s + 1600ms + 2 * kPeriod + 20ms);
}

TEST_CASE("a setting that a scanner refuses is counted and does not keep scans away") {
  Bench bench;
  bench.at.server->refuse("LMDscandatacfg");
  bench.come_to_life();
  CHECK(bench.at.health().protocol.refused == 1);
}

TEST_CASE("a setting that a scanner does not answer is counted and passed over after a second") {
  Bench bench;
  bench.at.server->ignore("LMDscandatacfg");
  CHECK(bench.at.run_until([&] { return bench.at.is_well(); }, 5s) <= 1s + 2 * kPeriod + 20ms);
  CHECK(bench.at.is_well());
  CHECK(bench.at.health().protocol.refused == 1);
  CHECK(bench.at.health().connections == 1);
}

TEST_CASE("a scanner that refuses to send scans is named so") {
  for (const ColaDialect dialect : {ColaDialect::kText, ColaDialect::kBinary}) {
    Bench bench(dialect);
    bench.at.server->refuse("LMDscandata");
    bench.at.run(3s);
    CHECK(bench.at.health().last_trouble == ScannerTrouble::kRefused);
    // Tries after rests of 0.3, 0.6, 1.2 s: four in three seconds, not one a millisecond.
    CHECK(bench.at.health().connections == 4);
    CHECK(bench.at.scan().sequence == 0);
  }
}

TEST_CASE("a scanner that reports an error is named so until it is well") {
  Bench bench;
  bench.come_to_life();
  bench.at.server->set_unwell(true);
  bench.at.run(200ms);
  CHECK(bench.at.health().trouble == ScannerTrouble::kDeviceError);
  bench.at.server->set_unwell(false);
  bench.at.run(200ms);
  CHECK(bench.at.is_well());
  CHECK(bench.at.health().connections == 1);
}

TEST_CASE("a host that nobody knows is refused at start") {
  CHECK_THROWS_AS(wire::TcpEndpoint("no such host.invalid", 2112), StartupError);
}

TEST_CASE("the 16 real telegrams of a TiM come over TCP as they came from it") {
  const auto path = tests::data_file("sick/sick_tim_colaB_16_telegrams.bin");
  if (path.empty()) return;
  const std::vector<std::uint8_t> recorded = tests::read_bytes(path);
  emulators::TcpServer wire(0);
  tests::HandClock clock;
  ScannerConnection connection(std::make_unique<wire::TcpEndpoint>("127.0.0.1", wire.port()),
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
    if (before != kNever) least = std::min(least, stamp - before), most = std::max(most, stamp - before);
    before = stamp;
  }
  CHECK(connection.latest().sequence == 16);
  CHECK(connection.latest().beam_count == 811);
  const ScannerHealth health = connection.health();
  CHECK(health.malformed + health.late + health.protocol.lost + health.protocol.skipped_bytes == 0);
  // The scanner's own clock put 66.6 to 66.7 ms between them, and 0.8 ms more or less into sending them.
  CHECK(least >= 65ms);
  CHECK(most <= 69ms);
}

TEST_CASE("a connection with a thread of its own brings scans in real time and ends at once") {
  struct RealClock final : Clock {
    [[nodiscard]] Time now() noexcept override { return Time{std::chrono::steady_clock::now().time_since_epoch()}; }
    void sleep_until(Time wake) noexcept override { std::this_thread::sleep_for(wake - now()); }
  } clock;
  auto wire = std::make_unique<emulators::TcpServer>(std::uint16_t{0});
  const std::uint16_t port = wire->port();
  const auto world = [](std::size_t, std::span<float> range_m) { std::fill(range_m.begin(), range_m.end(), 2.0F); };
  emulators::SickServer server(std::move(wire), {}, world);
  const Time began = clock.now();
  {
    ScannerConnection connection(std::make_unique<wire::TcpEndpoint>("127.0.0.1", port),
                                 std::make_unique<sick::SickProtocol>(sick::Cola::kB, sick::ScannerModel{}), clock);
    CHECK(connection.start());
    while (connection.latest().sequence < 5 && clock.now() < began + 5s) {
      server.step(clock.now());
      clock.sleep_until(clock.now() + 1ms);
    }
    CHECK(connection.latest().sequence >= 5);
    CHECK(connection.latest().range_m[400] == Approx(2.0));
    CHECK(age(connection.latest().stamp, clock.now()) < 1s);
    CHECK(connection.health().trouble == ScannerTrouble::kNone);
  }
  CHECK(clock.now() < began + 6s);
}
