#pragma once
// Emulated drives and scanners at the far end of the wires, as a robot file has them.

#include <array>
#include <memory>
#include <vector>

#include "firmware/robot/robot_file.h"
#include "hil/emulators/motor_node.h"
#include "hil/emulators/scanner_server.h"

namespace jaywalk::rig {

using emulators::WheelDrive;

/// An ODrive's watchdog as docs/tutorial/first-real-robot.md advises it; longer where the loop is slow.
constexpr Duration kOdriveWatchdog = std::chrono::milliseconds(60);

/// The far end of what the controller's side says about its drives: left, right. Each place on the bus outlives its
/// drive; a Pioneer's board is at the left one alone.
[[nodiscard]] std::array<std::unique_ptr<WheelDrive>, 2> make_wheel_drives(const DriveWiring& wiring,
                                                                           const std::array<CanBus*, 2>& buses);

/// One of them, on side 0 (left) or 1; not of a Pioneer.
[[nodiscard]] std::unique_ptr<WheelDrive> make_wheel_drive(const DriveWiring& wiring, std::size_t side, CanBus& bus);

using FarWires = std::vector<std::unique_ptr<emulators::ByteServer>>;

/// The far end of a device's wire: a port of this machine, or a pseudo terminal in place of the serial device. Throws
/// StartupError where it cannot be.
[[nodiscard]] std::unique_ptr<emulators::ByteServer> make_far_wire(const ByteWiring& wiring);

/// One for each scanner of a robot. Those on a network listen at any port that is free where `any_port` says so.
[[nodiscard]] FarWires make_far_wires(const RobotFile& wiring, bool any_port = false);

/// The far end of what the controller's side says about its scanner.
[[nodiscard]] std::unique_ptr<emulators::ScannerServer> make_far_scanner(const LaserWiring& wiring,
                                                                         const LaserModel& model,
                                                                         std::unique_ptr<emulators::ByteServer> wire,
                                                                         emulators::ScannerServer::World world);

}  // namespace jaywalk::rig
