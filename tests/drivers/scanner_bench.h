#pragma once
#include <memory>

#include "hil/emulators/scanner_server.h"
#include "drivers/laser/scanner_connection.h"
#include "tests/drivers/hand_clock.h"
#include "tests/support/allocation_guard.h"

namespace jaywalk::tests {

/// A connection and an emulated scanner on a real socket or line of this machine, by a clock that a test moves on:
/// a millisecond at a time, first the scanner, then the connection.
template <class Server>
class ScannerBench {
 public:
  ScannerBench(std::unique_ptr<Server> scanner, std::unique_ptr<wire::Endpoint> endpoint,
               std::unique_ptr<ScannerProtocol> protocol)
      : server(std::move(scanner)), connection(std::move(endpoint), std::move(protocol), clock) {}

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
  [[nodiscard]] const LaserScan& scan() { return connection.latest(); }
  [[nodiscard]] ScannerHealth health() { return connection.health(); }
  [[nodiscard]] bool is_well() { return connection.health().trouble == ScannerTrouble::kNone; }

  HandClock clock;
  std::unique_ptr<Server> server;
  ScannerConnection connection;
  std::uint64_t heap_calls = 0;
};

}  // namespace jaywalk::tests
