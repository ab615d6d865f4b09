#pragma once
#include <chrono>
#include <deque>
#include <memory>

#include "drivers/laser/scanner_connection.h"
#include "hil/emulators/scanner_server.h"
#include "tests/drivers/hand_clock.h"
#include "tests/support/allocation_guard.h"
#include "tests/support/catch.h"

namespace jaywalk::tests {

/// A connection and an emulated scanner on a real socket or line of this machine, by a clock that a test moves on:
/// a millisecond at a time, first the scanner, then the connection.
class ScannerBench {
 public:
  ScannerBench(std::unique_ptr<emulators::ScannerServer> scanner, wire::Endpoint endpoint,
               std::unique_ptr<ScannerProtocol> protocol)
      : server(std::move(scanner)),
        connection(std::make_unique<wire::ByteLink>(std::move(endpoint)), std::move(protocol), clock) {}

  void run(Duration span) {
    for (const Time end = clock.now() + span; clock.now() < end;) {
      clock.sleep_until(clock.now() + std::chrono::milliseconds(1));
      server->step(clock.now());
      const AllocationGuard guard;
      connection.step();
      static_cast<void>(connection.latest());
      heap_calls += guard.calls();
    }
  }
  /// Until `holds` or for `most`; how long that took.
  template <class Condition>
  Duration run_until(Condition holds, Duration most) {
    const Time began = clock.now();
    while (!holds() && clock.now() - began < most) run(std::chrono::milliseconds(1));
    return clock.now() - began;
  }
  /// Runs until scans come, for 5 s at most, and a little.
  void come_to_life() {
    run_until([this] { return is_well(); }, std::chrono::seconds(5));
    run(std::chrono::milliseconds(100));
    REQUIRE(is_well());
  }
  [[nodiscard]] const LaserScan& scan() { return connection.latest(); }
  [[nodiscard]] ScannerHealth health() { return connection.health(); }
  [[nodiscard]] bool is_well() { return connection.health().trouble == ScannerTrouble::kNone; }
  /// The scanner as the kind that it is.
  template <class Server>
  [[nodiscard]] Server& as() {
    return dynamic_cast<Server&>(*server);
  }

  HandClock clock;
  std::unique_ptr<emulators::ScannerServer> server;
  ScannerConnection connection;
  std::uint64_t heap_calls = 0;
};

}  // namespace jaywalk::tests
