#include "firmware/robot/robot_devices.h"

#include <algorithm>
#include <cmath>

#include "drivers/laser/scanner_connection.h"
#include "firmware/robot/preflight.h"
#include "hal/shown_text.h"
#include "hal/types/errors.h"

namespace jaywalk {
namespace {

constexpr const char* kStartNodes = "start the robot's ROS 2 nodes, and jaywalk_dds with this file and their domain";

/// `bus`: of make_bus(), or the same socket once more.
EmergencyBrake make_brake(const DriveWiring& wiring, CanBus& bus) {
  if (wiring.kind == DriveKind::kDds) return [&bus] { static_cast<ros::RosBus&>(bus).brake(); };
  const std::array nodes{wiring.axes()[0].node, wiring.axes()[1].node};
  std::vector<CanFrame> frames;
  if (wiring.kind == DriveKind::kPioneer) frames = arcos::stop_frames();
  if (wiring.kind == DriveKind::kCia402) frames = canopen::quick_stop_frames(nodes);
  for (const std::uint8_t node : nodes) {
    if (wiring.kind == DriveKind::kOdrive) frames.push_back(odrive::set_velocity(node, 0.0F));
    if (wiring.kind == DriveKind::kVesc) frames.push_back(vesc::set_erpm(node, 0));
  }
  return [&bus, frames] {  // a frame that is not taken is ignored: it is said again as long as it has to be
    for (const CanFrame& frame : frames) static_cast<void>(bus.send(frame));
  };
}

/// Throws where a scan's fan is not the file's, by half a step and more: a wrong step bends all that is seen. A turn's
/// last beam may be counted as the first of the next.
void require_fan(ScannerConnection& laser, const LaserModel& model) {
  const LaserScan& scan = laser.latest();
  const double step_rad = std::fabs(static_cast<double>(scan.angle_step_rad));
  const double swept_rad = step_rad * (scan.beam_count - 1.0), least_off_rad = 0.5 * step_rad;
  const bool turns = std::fabs(swept_rad + step_rad - 2.0 * kPi) < least_off_rad;
  const double off_rad = std::fabs(swept_rad - model.fov_rad);
  const bool same = off_rad < least_off_rad || (turns && std::fabs(model.fov_rad - 2.0 * kPi) < least_off_rad);
  if (scan.beam_count == model.beams && same) return;
  const std::string differs =
      formatted(": scans of %u beams over %.1f degrees, and the file says %u over %.1f", scan.beam_count,
                swept_rad * 180.0 / kPi, static_cast<unsigned>(model.beams), model.fov_rad * 180.0 / kPi);
  throw StartupError(laser.name() + differs, "correct [laser] beams and fov_deg");
}

}  // namespace

std::filesystem::path ring_path(const std::string& topic) {
  std::string name = "jaywalk-dds" + topic;
  std::replace(name.begin(), name.end(), '/', '-');
  return own_runtime_folder() / name;
}

std::unique_ptr<ScannerConnection> make_laser(const RobotFile& file, Clock& clock, std::size_t scanner) {
  const LaserWiring& wiring = file.lasers()[scanner];
  const LaserModel& model = file.setup.model.lasers()[scanner];
  return make_scanner({.kind = wiring.kind,
                       .host = wiring.host,
                       .port = wiring.port,
                       .device = wiring.kind == ScannerKind::kDds ? ring_path(wiring.topic).string() : wiring.device,
                       .baud = wiring.baud,
                       .range_min_m = static_cast<float>(model.range_min_m),
                       .range_max_m = static_cast<float>(model.range_max_m),
                       .topic = wiring.topic,
                       .infinity_is_free = wiring.infinity_is_free},
                      clock);
}

std::unique_ptr<CanBus> make_bus(const DriveWiring& wiring, Clock& clock, bool deaf) {
  if (wiring.kind == DriveKind::kDds) {
    const ros::RosBus::Rings rings{ring_path(wiring.ros.odometry), ring_path(wiring.ros.command)};
    return std::make_unique<ros::RosBus>(rings, clock);
  }
  if (wiring.kind == DriveKind::kPioneer) {
    const ByteWiring& line = wiring.line;
    return std::make_unique<ByteBus>(wire::make_byte_link(line.host, line.port, line.device, line.baud), clock);
  }
  return std::make_unique<SocketCan>(open_can(wiring.can, deaf ? std::vector<CanFilter>{} : filters_for(wiring)),
                                     clock);
}

std::unique_ptr<WiredDrive> make_drive(const DriveWiring& wiring, CanBus& bus, Clock& clock) {
  if (wiring.kind == DriveKind::kDds) return std::make_unique<ros::RosBase>(bus, clock, wiring.ros);
  if (wiring.kind == DriveKind::kPioneer) return std::make_unique<arcos::ArcosBase>(bus, clock, wiring.arcos);
  if (wiring.kind == DriveKind::kOdrive) return std::make_unique<odrive::OdriveBase>(bus, clock, wiring.odrive);
  if (wiring.kind == DriveKind::kVesc) return std::make_unique<vesc::VescBase>(bus, clock, wiring.vesc);
  return std::make_unique<canopen::CanopenDriveBase>(bus, clock, wiring.cia402);
}

std::vector<CanFilter> filters_for(const DriveWiring& wiring) {
  // A request to an ODrive feeds its watchdog: only another master sends one.
  if (wiring.kind == DriveKind::kOdrive) return {CanFilter{}, CanFilter{.id = 0, .mask = 0, .remote = true}};
  if (wiring.kind == DriveKind::kVesc) return {CanFilter{.id = 0, .mask = 0, .extended = true}};
  std::vector<CanFilter> filters;
  const auto& axes = wiring.cia402.axes;
  const auto masters =
      canopen::masters_identifiers(wiring.cia402.settings.controller_node, {axes[0].node, axes[1].node});
  for (const std::uint32_t id : masters) filters.push_back({.id = id, .mask = kMaxStandardId, .extended = false});
  for (const CanAxis& axis : axes)
    for (const std::uint32_t base : {0x080U, 0x180U, 0x280U, 0x580U, 0x700U})
      filters.push_back({.id = base + axis.node, .mask = kMaxStandardId, .extended = false});
  return filters;
}

RobotDevices::RobotDevices(const RobotFile& file, Clock& clock)
    : file_(file),
      clock_(clock),
      lock_(file.drive.can),
      bus_(make_bus(file.drive, clock, true)),
      can_(dynamic_cast<SocketCan*>(bus_.get())),
      brake_can_(can_ != nullptr ? std::make_unique<SocketCan>(can_->second(), clock) : nullptr),
      drive_(make_drive(file.drive, *bus_, clock)),
      brake_(make_brake(file.drive, can_ != nullptr ? *brake_can_ : *bus_)) {
  for (std::size_t k = 0; k < file.lasers().size(); ++k) lasers_.push_back(make_laser(file, clock, k));
}

OfOthers<LaserScanner*> RobotDevices::other_lasers() noexcept {
  OfOthers<LaserScanner*> others;
  for (std::size_t k = 1; k < lasers_.size(); ++k) (void)others.push_back(lasers_[k].get());
  return others;
}

void RobotDevices::start() {
  for (std::size_t k = 0; k < lasers_.size(); ++k) await_first_scan(*lasers_[k], file_, clock_, k);
  if (can_ != nullptr) can_->listen(filters_for(file_.drive));
}

void await_first_scan(ScannerConnection& laser, const RobotFile& file, Clock& clock, std::size_t scanner) {
  laser.start(laser_priority(file.realtime));  // the loop's thread tells what is not permitted
  const Time limit = clock.now() + file.lasers()[scanner].first_scan_limit;
  while (laser.latest().sequence == 0) {
    if (clock.now() > limit) {
      const bool is_topic = file.lasers()[scanner].kind == ScannerKind::kDds;
      throw StartupError(
          laser.name() + ": no scan: " + std::string(name(laser.health().trouble)),
          is_topic ? kStartNodes : "see that the scanner has power and this address, and that nobody else uses it");
    }
    clock.sleep_until(clock.now() + std::chrono::milliseconds(5));
  }
  require_fan(laser, file.setup.model.lasers()[scanner]);
}

}  // namespace jaywalk
