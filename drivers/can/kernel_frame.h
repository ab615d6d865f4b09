#pragma once
// Linux's own form of frames, filters and errors (linux/can.h, linux/can/error.h), to and from ours.
#include <linux/can.h>

#include <optional>

#include "drivers/can/can_bus.h"

namespace jaywalk {

/// Lets through the data frames (or, where `remote`, the requests for them) whose identifier agrees with `id` where
/// `mask` has ones.
struct CanFilter {
  std::uint32_t id = 0;
  std::uint32_t mask = 0;
  bool extended = false;
  bool remote = false;
};

/// `frame` is valid.
[[nodiscard]] can_frame to_kernel(const CanFrame& frame) noexcept;
[[nodiscard]] can_filter to_kernel(const CanFilter& filter) noexcept;

/// Nothing for an error frame and for what is_valid refuses.
[[nodiscard]] std::optional<CanFrame> from_kernel(const can_frame& frame) noexcept;

[[nodiscard]] inline bool is_error(const can_frame& frame) noexcept { return (frame.can_id & CAN_ERR_FLAG) != 0; }

/// The controller's state after the error frame `error`, given the one before. A protocol error alone leaves it.
[[nodiscard]] CanState state_after(const can_frame& error, CanState before) noexcept;

}  // namespace jaywalk
