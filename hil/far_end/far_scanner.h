#pragma once
#include <memory>
#include <vector>

#include "firmware/robot/robot_file.h"
#include "hil/emulators/scanner_server.h"

namespace jaywalk::rig {

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
