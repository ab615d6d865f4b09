#include "tests/drivers/scanner_kinds.h"

#include "drivers/laser/scip.h"
#include "drivers/laser/serial_scanners.h"
#include "drivers/laser/sick.h"
#include "tests/drivers/serial_line.h"

using namespace std::chrono_literals;

namespace jaywalk::tests {

namespace {

using emulators::ColaDialect;

template <class Server, class... Model>
std::unique_ptr<ScannerBench> on_tcp(std::unique_ptr<ScannerProtocol> protocol, const Model&... model) {
  auto line = std::make_unique<emulators::TcpServer>(std::uint16_t{0});
  auto endpoint = wire::tcp_endpoint("127.0.0.1", line->port());
  return std::make_unique<ScannerBench>(std::make_unique<Server>(std::move(line), model...), std::move(endpoint),
                                        std::move(protocol));
}

template <class Server, class... Model>
std::unique_ptr<ScannerBench> on_line(std::unique_ptr<ScannerProtocol> protocol, std::uint32_t baud,
                                      const Model&... model) {
  auto line = serial_line();
  if (line == nullptr) return nullptr;
  auto endpoint = wire::serial_endpoint(line->path(), baud);
  return std::make_unique<ScannerBench>(std::make_unique<Server>(std::move(line), model...), std::move(endpoint),
                                        std::move(protocol));
}

ScannerKind sick(const char* name, MakeScanner make) {
  return {.name = name,
          .make = make,
          .beams = 811,
          .period = duration_from_seconds(1.0 / 15.0),
          .least_scans = 28,
          .early = 1ms,
          .late = 1ms,
          .oldest = duration_from_seconds(2.0 / 15.0),
          .conversation = 20ms,
          .on_network = true,
          .half_bytes = 800,
          .set_error = [](ScannerBench& bench, bool on) { bench.as<emulators::SickServer>().set_unwell(on); },
          .refuse_scans = [](ScannerBench& bench) { bench.as<emulators::SickServer>().refuse("LMDscandata"); }};
}

ScannerKind hokuyo(const char* name, MakeScanner make, bool on_network) {
  return {
      .name = name,
      .make = make,
      .beams = 1081,
      .period = 25ms,
      .least_scans = 77,
      .early = 1ms,
      .late = 1ms,
      .oldest = 50ms,
      .conversation = 20ms,
      .on_network = on_network,
      .half_bytes = 1600,  // of 1081 x 3 characters
      .set_error = [](ScannerBench& bench, bool on) { bench.as<emulators::ScipServer>().set_status(on ? "0L" : ""); },
      .refuse_scans = [](ScannerBench& bench) { bench.as<emulators::ScipServer>().break_laser(); }};
}

std::unique_ptr<ScannerBench> hokuyo_on_line(const ScannerWorld& world) {
  return on_line<emulators::ScipServer>(std::make_unique<scip::ScipProtocol>(), 115200, emulators::ScipModel{}, world);
}

/// A packet comes up to 1 ms late, a step of the bench, or 2.7 ms early or late as its clock of milliseconds is read.
ScannerKind ld() {
  return {.name = "LD19",
          .make = ld_bench,
          .beams = 450,
          .period = 100ms,
          .least_scans = 18,
          .early = 3ms,
          .late = 3ms,
          .conversation = 120ms,
          .whole = false};
}

/// A telegram takes 96.9 ms on its line, of every eighth turn.
ScannerKind lms200() {
  return {
      .name = "LMS200",
      .make = lms200_bench,
      .beams = 181,
      .period = duration_from_seconds(8.0 / 75.0),
      .least_scans = 16,
      .early = 1ms,  // a step of the bench: turns do not begin on whole ones
      .late = 3ms,
      .set_error = [](ScannerBench& bench, bool on) { bench.as<emulators::Lms200Server>().set_status(on ? 3 : 0); }};
}

/// A point comes up to eight points, 2.2 ms, after it was measured.
ScannerKind rplidar() {
  return {.name = "RPLIDAR",
          .make = rplidar_bench,
          .beams = 360,
          .period = 100ms,
          .least_scans = 17,
          .early = 0ms,
          .late = 4ms,
          .whole = false,
          .refuse_scans = [](ScannerBench& bench) { bench.as<emulators::RplidarServer>().break_down(); }};
}

}  // namespace

std::unique_ptr<ScannerBench> sick_bench(const ScannerWorld& world, ColaDialect dialect) {
  const auto cola = dialect == ColaDialect::kText ? sick::Cola::kA : sick::Cola::kB;
  return on_tcp<emulators::SickServer>(std::make_unique<sick::SickProtocol>(cola, sick::ScannerModel{}),
                                       emulators::SickModel{.dialect = dialect}, world);
}
std::unique_ptr<ScannerBench> hokuyo_bench(const ScannerWorld& world, const emulators::ScipModel& model) {
  return on_tcp<emulators::ScipServer>(std::make_unique<scip::ScipProtocol>(), model, world);
}
std::unique_ptr<ScannerBench> lms200_bench(const ScannerWorld& world) {
  return on_line<emulators::Lms200Server>(std::make_unique<lms200::Lms200Protocol>(38400), 38400, std::uint32_t{38400},
                                          world);
}
std::unique_ptr<ScannerBench> rplidar_bench(const ScannerWorld& world) {
  return on_line<emulators::RplidarServer>(std::make_unique<rplidar::RplidarProtocol>(), 115200, world);
}
std::unique_ptr<ScannerBench> ld_bench(const ScannerWorld& world) {
  return on_line<emulators::LdServer>(std::make_unique<ldrobot::LdProtocol>(), 230400, world);
}

const std::vector<ScannerKind>& scanner_kinds() {
  static const std::vector<ScannerKind> kinds{
      sick("SICK CoLa A", [](const ScannerWorld& world) { return sick_bench(world, ColaDialect::kText); }),
      sick("SICK CoLa B", [](const ScannerWorld& world) { return sick_bench(world, ColaDialect::kBinary); }),
      hokuyo(
          "Hokuyo on a network", [](const ScannerWorld& world) { return hokuyo_bench(world); }, true),
      hokuyo("Hokuyo on a line", hokuyo_on_line, false),
      ld(),
      lms200(),
      rplidar()};
  return kinds;
}

}  // namespace jaywalk::tests
