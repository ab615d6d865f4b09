#include "drivers/canopen/quick_stopper.h"

#include "drivers/canopen/cia402.h"
#include "drivers/canopen/drive_proof.h"

namespace jaywalk::canopen {

QuickStopper::QuickStopper(CanBus& bus, std::array<std::uint8_t, 2> nodes) noexcept
    : bus_(bus), nodes_(nodes), mappings_{command_pdo(nodes[0]).mapping, command_pdo(nodes[1]).mapping} {}

// Whether a frame is taken changes nothing: there is no third way, and it is said again as long as it has to be.
void QuickStopper::brake() noexcept {
  const std::uint16_t stop = controlword_towards(DriveGoal::kQuickStop, DriveState::kOperationEnabled, false);
  for (std::size_t k = 0; k < nodes_.size(); ++k) {
    const std::array<std::uint32_t, 2> values{stop, 0};
    if (const auto frame = pack(mappings_[k], 0x200U + nodes_[k], values)) static_cast<void>(bus_.send(*frame));
  }
  static_cast<void>(bus_.send(sync_frame()));
}

}  // namespace jaywalk::canopen
