#pragma once
// Linux's input events as they are read from /dev/input/event*: struct input_event of <linux/input.h>.
#include <cstdint>
#include <optional>

#include "drivers/wire/byte_queue.h"

namespace jaywalk::panel {

struct InputEvent {
  std::uint16_t type = 0;  ///< EV_KEY, EV_ABS, EV_SYN and others
  std::uint16_t code = 0;  ///< which button or axis
  std::int32_t value = 0;  ///< of a button 0 released, 1 pressed, 2 held; of an axis its position
  bool operator==(const InputEvent&) const = default;
};

/// Cuts what was read into events; the kernel's time in each is passed over.
class EventStream {
 public:
  void append(wire::Bytes bytes) noexcept { queue_.append(bytes); }
  [[nodiscard]] std::optional<InputEvent> next() noexcept;
  void forget() noexcept { queue_.clear(); }

 private:
  wire::ByteQueue<4096> queue_;
};

}  // namespace jaywalk::panel
