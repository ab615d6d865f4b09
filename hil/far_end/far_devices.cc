#include "hil/far_end/far_devices.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "hal/types/errors.h"
#include "hil/emulators/arcos_board.h"
#include "hil/emulators/cia402_node.h"
#include "hil/emulators/scanners.h"

namespace jaywalk::rig {
namespace {

/// Its heartbeat tells so late that the watchdog expired.
constexpr Duration kOdriveHeartbeat = std::chrono::milliseconds(10);

/// One motor of a Pioneer, on side 0 (left) or 1. Whatever befalls its board befalls both.
class ArcosMotor final : public WheelDrive {
 public:
  ArcosMotor(std::shared_ptr<emulators::ArcosBoard> board, std::size_t side, double mm_per_rad)
      : WheelDrive(mm_per_rad), board_(std::move(board)), side_(side) {}

  void step(Time now) override {
    if (side_ == 0) board_->step(now);
  }
  [[nodiscard]] double velocity() const noexcept override { return board_->velocity(side_); }
  void measure(double velocity, double position) noexcept override { board_->measure(side_, velocity, position); }
  [[nodiscard]] std::string_view state_name() const noexcept override { return board_->state_name(); }
  [[nodiscard]] Time heard_controller() const noexcept override { return board_->heard_controller(); }
  void raise_fault(std::uint32_t) noexcept override { board_->stall(side_, true); }
  void pull_cable() noexcept override { board_->pull_cable(); }
  void plug_cable() noexcept override { board_->plug_cable(); }
  void restart() noexcept override { board_->restart(); }
  void stick() noexcept override { board_->stick(side_); }
  void lose_feedback() noexcept override { board_->mute(); }
  void set_watchdog(Duration time) noexcept override {
    board_->set_watchdog(static_cast<std::uint16_t>(time / std::chrono::milliseconds(1)));
  }
  void press_stop() noexcept override { board_->press_stop(true); }

 private:
  std::shared_ptr<emulators::ArcosBoard> board_;
  std::size_t side_;
};

std::array<std::unique_ptr<WheelDrive>, 2> make_arcos_motors(const arcos::BaseSetup& setup, CanBus& line) {
  auto board = std::make_shared<emulators::ArcosBoard>(line, setup.track_mm);
  board->set_cycle(static_cast<std::uint8_t>(std::lround(1e3 * setup.times.report_s)));
  board->set_ticks(static_cast<std::uint16_t>(setup.ticks_per_mm));
  return {std::make_unique<ArcosMotor>(board, 0, setup.mm_per_rad[0]),
          std::make_unique<ArcosMotor>(board, 1, setup.mm_per_rad[1])};
}

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

std::array<std::unique_ptr<WheelDrive>, 2> make_wheel_drives(const DriveWiring& wiring,
                                                             const std::array<CanBus*, 2>& buses) {
  if (wiring.kind == DriveKind::kPioneer) return make_arcos_motors(wiring.arcos, *buses[0]);
  return {make_wheel_drive(wiring, 0, *buses[0]), make_wheel_drive(wiring, 1, *buses[1])};
}

std::unique_ptr<WheelDrive> make_wheel_drive(const DriveWiring& wiring, std::size_t side, CanBus& bus) {
  const auto [node, per_rad] = wiring.axes()[side];
  if (wiring.kind == DriveKind::kVesc) return std::make_unique<VescNode>(bus, node, per_rad);
  if (wiring.kind != DriveKind::kOdrive) return std::make_unique<Cia402Node>(bus, node, per_rad);
  auto drive = std::make_unique<OdriveNode>(bus, node, per_rad);
  drive->set_watchdog(std::max<Duration>(kOdriveWatchdog, wiring.odrive.watchdog_least + kOdriveHeartbeat));
  return drive;
}

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
    case ScannerKind::kLdrobot: return std::make_unique<LdServer>(std::move(wire), std::move(world));
    case ScannerKind::kRplidar: return std::make_unique<RplidarServer>(std::move(wire), std::move(world));
    case ScannerKind::kLms200: return std::make_unique<Lms200Server>(std::move(wire), wiring.baud, std::move(world));
    case ScannerKind::kDds: break;
  }
  return nullptr;
}

}  // namespace jaywalk::rig
