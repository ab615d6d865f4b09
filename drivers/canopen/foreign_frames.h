#pragma once
// Frames on the drives' bus that only a master sends (CiA 301). Own frames do not come back (can_bus.h): one that comes
// in was sent by another program or machine.
#include <array>
#include <cstdint>
#include <string>

#include "drivers/can/can_frame.h"
#include "hal/types/fixed_vector.h"

namespace jaywalk::canopen {

using Identifiers = FixedVector<std::uint32_t, 16>;

/// NMT commands, SYNC, LSS; the heartbeat under the controller's node; RPDOs 1 to 4 and SDO requests of both drives.
[[nodiscard]] Identifiers masters_identifiers(std::uint8_t controller_node,
                                              const std::array<std::uint8_t, 2>& drives) noexcept;

/// "heartbeat with the controller's node (701#05)". Not for the loop.
[[nodiscard]] std::string describe_foreign(const CanFrame& frame);

}  // namespace jaywalk::canopen
