// What every kind of scanner does alike on its own wire: once a row of scanner_kinds.cc.
#include <algorithm>
#include <chrono>
#include <deque>

#include "tests/drivers/scanner_kinds.h"

using namespace jaywalk;
using namespace std::chrono_literals;
using emulators::ScannerFault;
using tests::round_room;
using tests::ScannerBench;
using tests::with_each_scanner;

TEST_CASE("a scanner's scans come whole, in time and without the heap") {
  with_each_scanner(round_room, [](const tests::ScannerKind& kind, ScannerBench& bench) {
    CHECK(bench.scan().sequence == 0);
    bench.run(2s);
    CHECK(bench.scan().beam_count == kind.beams);
    CHECK(std::chrono::abs(bench.scan().period - kind.period) <= 2ms);
    const ScannerHealth health = bench.health();
    CHECK(health.trouble == ScannerTrouble::kNone);
    CHECK(health.scans >= kind.least_scans);
    CHECK(bench.scan().sequence == health.scans);
    CHECK(health.connections == 1);
    CHECK(health.malformed + health.late + health.protocol.lost + health.protocol.skipped_bytes == 0);
    CHECK(health.protocol.refused == 0);
    CHECK(bench.heap_calls == 0);
    if (kind.whole) CHECK(bench.server->messages_sent() - health.scans <= (kind.on_network ? 0 : 1));  // on the line
  });
}

TEST_CASE("a scan's stamp is when its first beam was measured") {
  for (const tests::ScannerKind& kind : tests::scanner_kinds()) {
    CAPTURE(kind.name);
    std::deque<Time> began;
    ScannerBench* running = nullptr;
    const auto bench = kind.make([&](std::size_t first, std::span<float> range_m) {
      if (first == 0) began.push_back(running->clock.now());
      round_room(first, range_m);
    });
    if (bench == nullptr) continue;
    running = bench.get();
    for (int k = 0; k < 350; ++k) {  // clocks of scanners wrap after 2, 10 and 30 seconds
      bench->run(kind.period);
      const LaserScan& scan = bench->scan();
      if (scan.sequence < 2) continue;
      REQUIRE(std::any_of(began.begin(), began.end(),
                          [&](Time at) { return scan.stamp >= at - kind.early && scan.stamp <= at + kind.late; }));
      REQUIRE(bench->clock.now() - scan.stamp <= kind.oldest);
      if (began.size() > 10) began.pop_front();
    }
    CHECK(bench->scan().sequence > 330);
    CHECK(bench->health().late == 0);
  }
}

TEST_CASE("a scanner is found again after damage and noise and silence and a pulled plug") {
  with_each_scanner(round_room, [](const tests::ScannerKind& kind, ScannerBench& bench) {
    bench.come_to_life();
    bench.run(1s);
    for (const ScannerFault fault : {ScannerFault::kHalfTelegram, ScannerFault::kDamage, ScannerFault::kGarbage}) {
      const std::uint32_t before = bench.scan().sequence;
      bench.server->order(fault, 700ms);
      bench.run(720ms);
      const std::uint32_t during = bench.scan().sequence;
      // No scan of a damaged message is handed out; one was on its way.
      if (kind.whole && fault != ScannerFault::kHalfTelegram) CHECK(during <= before + 1);
      bench.run(3 * kind.period);
      CHECK(bench.scan().sequence >= during + 2);
      CHECK(bench.is_well());
    }
    CHECK(bench.health().malformed + bench.health().protocol.skipped_bytes > 23);
    CHECK(bench.health().protocol.skipped_bytes > 10);
    CHECK(bench.health().connections == 1);
    bench.server->order(ScannerFault::kSilence, 1500ms);
    bench.run(1300ms);
    CHECK(bench.health().trouble == ScannerTrouble::kSilent);
    bench.come_to_life();
    const LaserScan last = bench.scan();
    const std::uint64_t connections = bench.health().connections;
    bench.server->order(ScannerFault::kGone, 10s);
    bench.run(100ms);
    CHECK(bench.health().last_trouble == ScannerTrouble::kClosed);
    bench.run(8900ms);
    CHECK(bench.health().trouble == ScannerTrouble::kUnreachable);
    CHECK(bench.scan().stamp - last.stamp <= kind.period + kind.early + kind.late + 1ms);  // the last one grows old
    // Gone for one second more, then at the latest after the longest rest of 1.6 s, the conversation and a sweep.
    CHECK(bench.run_until([&] { return bench.is_well(); }, 12s) <= 1s + 1600ms + kind.conversation + 2 * kind.period);
    bench.run(kind.period);
    CHECK(bench.is_well());
    CHECK(bench.scan().sequence > last.sequence);
    CHECK(bench.scan().stamp > last.stamp + 9s);
    CHECK(bench.health().connections == connections + 1);
    CHECK(bench.heap_calls == 0);
  });
}

TEST_CASE("half a message costs one scan") {
  with_each_scanner(round_room, [](const tests::ScannerKind& kind, ScannerBench& bench) {
    if (kind.half_bytes == 0) return;
    bench.come_to_life();
    const std::uint64_t sent = bench.server->messages_sent();
    const std::uint64_t heard = bench.health().scans;
    bench.server->order(ScannerFault::kHalfTelegram);
    bench.run(1s);
    CHECK(bench.server->messages_sent() - sent == bench.health().scans - heard + 1);
    CHECK(bench.health().protocol.lost == 1);
    CHECK(bench.health().protocol.skipped_bytes > kind.half_bytes);
    CHECK(bench.is_well());
    CHECK(bench.health().connections == 1);
  });
}

TEST_CASE("a connection that the scanner resets is made anew") {
  with_each_scanner(round_room, [](const tests::ScannerKind& kind, ScannerBench& bench) {
    if (!kind.on_network) return;
    bench.come_to_life();
    bench.server->order(ScannerFault::kReset);
    bench.run_until([&] { return !bench.is_well(); }, 10ms);
    CHECK(bench.health().trouble == ScannerTrouble::kClosed);
    const Duration lasted = bench.run_until([&] { return bench.is_well(); }, 20s);
    CHECK(lasted <= 300ms + 2 * kind.period + 20ms);  // one rest, the conversation, a sweep under way and a whole one
    CHECK(lasted > 300ms);                            // so long that the robot stops, however soon it is back
    CHECK(bench.health().last_trouble == ScannerTrouble::kClosed);
    CHECK(bench.health().connections == 2);
  });
}

TEST_CASE("a scanner that reports an error is named so until it is well") {
  with_each_scanner(round_room, [](const tests::ScannerKind& kind, ScannerBench& bench) {
    if (!kind.set_error) return;
    bench.come_to_life();
    kind.set_error(bench, true);
    bench.run(100ms + 2 * kind.period);  // what was on the line
    const std::uint32_t sequence = bench.scan().sequence;
    bench.run(2 * kind.period);
    CHECK(bench.health().trouble == ScannerTrouble::kDeviceError);
    CHECK(bench.scan().sequence == sequence);
    kind.set_error(bench, false);
    bench.run(100ms + 2 * kind.period);
    CHECK(bench.is_well());
    CHECK(bench.health().connections == 1);
  });
}

TEST_CASE("a scanner that refuses to send scans is named so and asked again with rests") {
  with_each_scanner(round_room, [](const tests::ScannerKind& kind, ScannerBench& bench) {
    if (!kind.refuse_scans) return;
    kind.refuse_scans(bench);
    bench.run(3s);
    CHECK(bench.health().last_trouble == ScannerTrouble::kRefused);
    // Tries after rests of 0.3, 0.6, 1.2 s: four in three seconds, not one a millisecond.
    CHECK(bench.health().connections == 4);
    CHECK(bench.scan().sequence == 0);
  });
}
