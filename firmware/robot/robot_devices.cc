#include "firmware/robot/robot_devices.h"

#include "drivers/laser/sick_protocol.h"
#include "drivers/wire/endpoint.h"
#include "hal/types/errors.h"

namespace jaywalk {
namespace {

std::unique_ptr<ScannerConnection> make_laser(const RobotFile& file, Clock& clock) {
  const sick::ScannerModel model{.range_min_m = static_cast<float>(file.setup.model.laser.range_min_m),
                                 .range_max_m = static_cast<float>(file.setup.model.laser.range_max_m)};
  const sick::Cola dialect = file.laser.kind == LaserKind::kSickColaA ? sick::Cola::kA : sick::Cola::kB;
  return std::make_unique<ScannerConnection>(std::make_unique<wire::TcpEndpoint>(file.laser.host, file.laser.port),
                                             std::make_unique<sick::SickProtocol>(dialect, model), clock);
}

}  // namespace

std::vector<CanFilter> filters_for(const canopen::DriveBaseSetup& setup) {
  std::vector<CanFilter> filters;
  for (const canopen::AxisSetup& axis : setup.axes) {
    for (const std::uint32_t base : {0x080U, 0x180U, 0x280U, 0x580U, 0x700U}) {
      filters.push_back({.id = base + axis.node, .mask = kMaxStandardId});
    }
  }
  return filters;
}

RobotDevices::RobotDevices(const RobotFile& file, Clock& clock)
    : file_(file),
      clock_(clock),
      bus_(open_can(file.drive.can, filters_for(file.drive.base)), clock),
      brake_bus_(open_can(file.drive.can, {}), clock),
      laser_(make_laser(file, clock)),
      drive_(std::make_unique<canopen::CanopenDriveBase>(bus_, clock, file.drive.base)),
      brake_(std::make_unique<canopen::QuickStopper>(
          brake_bus_, std::array{file.drive.base.axes[0].node, file.drive.base.axes[1].node})) {}

void RobotDevices::await_first_scan() {
  laser_->start();
  const Time limit = clock_.now() + file_.laser.first_scan_limit;
  while (laser_->latest().sequence == 0) {
    if (clock_.now() > limit) {
      const auto trouble = laser_->health().trouble;
      throw StartupError(laser_->name() + ": no scan: " + std::string(name(trouble)),
                         "see that the scanner has power and this address, and that nobody else uses it");
    }
    clock_.sleep_until(clock_.now() + std::chrono::milliseconds(5));
  }
  const std::uint32_t beams = laser_->latest().beam_count;
  const LaserModel& model = file_.setup.model.laser;
  if (beams != model.beams) {
    throw StartupError(laser_->name() + ": scans of " + std::to_string(beams) + " beams, and the file says " +
                           std::to_string(model.beams),
                       "correct [laser] beams and fov_deg");
  }
}

}  // namespace jaywalk
