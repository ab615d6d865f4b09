#include "drivers/can/kernel_frame.h"

#include <linux/can/error.h>

#include <algorithm>

namespace jaywalk {

can_frame to_kernel(const CanFrame& frame) noexcept {
  can_frame raw{};
  raw.can_id = frame.id | (frame.extended ? CAN_EFF_FLAG : 0U) | (frame.remote ? CAN_RTR_FLAG : 0U);
  raw.can_dlc = frame.size;
  if (!frame.remote) std::copy_n(frame.bytes.begin(), frame.size, raw.data);
  return raw;
}

// Format and request bit are part of the mask: without the first a filter for 081h lets 29-bit frames through as well.
can_filter to_kernel(const CanFilter& filter) noexcept {
  return {.can_id = filter.id | (filter.extended ? CAN_EFF_FLAG : 0U) | (filter.remote ? CAN_RTR_FLAG : 0U),
          .can_mask = filter.mask | CAN_EFF_FLAG | CAN_RTR_FLAG};
}

std::optional<CanFrame> from_kernel(const can_frame& raw) noexcept {
  if (is_error(raw)) return std::nullopt;
  CanFrame frame;
  frame.extended = (raw.can_id & CAN_EFF_FLAG) != 0;
  frame.remote = (raw.can_id & CAN_RTR_FLAG) != 0;
  frame.id = raw.can_id & CAN_EFF_MASK;
  frame.size = raw.can_dlc;
  if (!is_valid(frame)) return std::nullopt;
  if (!frame.remote) std::copy_n(raw.data, frame.size, frame.bytes.begin());
  return frame;
}

CanState state_after(const can_frame& error, CanState before) noexcept {
  if ((error.can_id & CAN_ERR_BUSOFF) != 0) return CanState::kBusOff;
  if ((error.can_id & CAN_ERR_RESTARTED) != 0) return CanState::kActive;
  if ((error.can_id & CAN_ERR_CRTL) == 0) return before;
  const unsigned status = error.data[1];
  if ((status & (CAN_ERR_CRTL_RX_PASSIVE | CAN_ERR_CRTL_TX_PASSIVE)) != 0) return CanState::kPassive;
  if ((status & (CAN_ERR_CRTL_RX_WARNING | CAN_ERR_CRTL_TX_WARNING)) != 0) return CanState::kWarning;
  if ((status & CAN_ERR_CRTL_ACTIVE) != 0) return CanState::kActive;
  return before;
}

}  // namespace jaywalk
