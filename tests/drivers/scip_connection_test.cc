#include <chrono>
#include <string>

#include "drivers/laser/scip.h"
#include "tests/drivers/scanner_kinds.h"
#include "tests/drivers/serial_line.h"

using namespace jaywalk;
using namespace std::chrono_literals;

TEST_CASE("a serial line with a scanner that still sends what somebody else asked for is quieted first") {
  auto line = tests::serial_line();
  if (line == nullptr) return;
  auto endpoint = wire::serial_endpoint(line->path(), 115200);
  const wire::Endpoint before = endpoint;
  const auto world = [](std::size_t, std::span<float> range_m) { std::fill(range_m.begin(), range_m.end(), 2.0F); };
  tests::ScannerBench bench(std::make_unique<emulators::ScipServer>(std::move(line), emulators::ScipModel{}, world),
                            std::move(endpoint), std::make_unique<scip::ScipProtocol>());
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
