#pragma once
// Which drives are on a bus, for `jaywalk setup`.
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "drivers/can/can_bus.h"
#include "firmware/robot/drive_wiring.h"
#include "hal/hal.h"

namespace jaywalk {

struct FoundNode {
  std::uint8_t node = 0;
  std::string said;  ///< "vendor 0000029Ch, product 00020192h, ...", or what it was known by
};

struct FoundDrives {
  std::optional<DriveKind> kind;  ///< none: no drives that this program knows
  std::vector<FoundNode> nodes;   ///< of that kind, by number
  std::string remark;             ///< what else there is; empty where nothing is
};

/// Listens for a second: ODrives and VESCs speak by themselves. Where none does, CANopen nodes 1 to 127 are asked what
/// they are (1000h, 1018h); not beside ODrives, to which these questions could be orders (600h + node is axis 48 and
/// up). Nothing is written and nothing moves. Takes about two seconds. Start-up only.
[[nodiscard]] FoundDrives find_drives(CanBus& bus, Clock& clock);

}  // namespace jaywalk
