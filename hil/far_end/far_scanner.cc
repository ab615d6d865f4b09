#include "hil/far_end/far_scanner.h"

#include <utility>

#include "hal/types/errors.h"
#include "hil/emulators/ld_server.h"
#include "hil/emulators/lms200_server.h"
#include "hil/emulators/rplidar_server.h"
#include "hil/emulators/scip_server.h"
#include "hil/emulators/sick_server.h"

namespace jaywalk::rig {
namespace {

using namespace emulators;

SickModel sick_model(const LaserModel& laser, ColaDialect dialect) {
  constexpr double kTdegPerRad = 1.8e6 / kPi, kAhead = 900000.0;
  return {.dialect = dialect,
          .beams = laser.beams,
          .first_angle_tdeg = static_cast<std::int32_t>(kAhead - 0.5 * laser.fov_rad * kTdegPerRad),
          .step_tdeg = static_cast<std::uint16_t>(laser.fov_rad / (laser.beams - 1) * kTdegPerRad),
          .rate_hz = laser.rate_hz,
          .range_max_m = laser.range_max_m};
}

ScipModel scip_model(const LaserModel& laser) {
  const auto last = static_cast<std::uint32_t>(laser.beams - 1);
  return {.steps_per_turn = static_cast<std::uint32_t>(2.0 * kPi * last / laser.fov_rad + 0.5),
          .last_step = last,
          .front_step = last / 2,
          .turns_per_minute = static_cast<std::uint32_t>(60.0 * laser.rate_hz + 0.5),
          .range_max_mm = static_cast<std::uint32_t>(1000.0 * laser.range_max_m + 0.5)};
}

}  // namespace

std::unique_ptr<ByteServer> make_far_wire(const ByteWiring& wiring) {
  if (wiring.host.empty()) return std::make_unique<PtyServer>(wiring.device);
  return std::make_unique<TcpServer>(wiring.port);
}

FarWires make_far_wires(const RobotFile& wiring, bool any_port) {
  FarWires wires;
  for (LaserWiring laser : wiring.lasers()) {
    if (laser.kind == ScannerKind::kDds)
      throw StartupError("laser.kind \"dds\" has no emulator", "play the robot with a program on DDS");
    if (any_port) laser.port = 0;
    wires.push_back(make_far_wire(laser));
  }
  return wires;
}

std::unique_ptr<ScannerServer> make_far_scanner(const LaserWiring& wiring, const LaserModel& model,
                                                std::unique_ptr<ByteServer> wire, ScannerServer::World world) {
  switch (wiring.kind) {
    case ScannerKind::kSickColaA:
      return std::make_unique<SickServer>(std::move(wire), sick_model(model, ColaDialect::kText), std::move(world));
    case ScannerKind::kSickColaB:
      return std::make_unique<SickServer>(std::move(wire), sick_model(model, ColaDialect::kBinary), std::move(world));
    case ScannerKind::kHokuyo:
      return std::make_unique<ScipServer>(std::move(wire), scip_model(model), std::move(world));
    case ScannerKind::kLdrobot:
      return std::make_unique<LdServer>(std::move(wire), std::move(world));
    case ScannerKind::kRplidar:
      return std::make_unique<RplidarServer>(std::move(wire), std::move(world));
    case ScannerKind::kLms200:
      return std::make_unique<Lms200Server>(std::move(wire), wiring.baud, std::move(world));
    case ScannerKind::kDds:
      break;
  }
  return nullptr;
}

}  // namespace jaywalk::rig
