#include "drivers/panel/input_event.h"

#include <linux/input.h>

#include <cstring>

namespace jaywalk::panel {

std::optional<InputEvent> EventStream::next() noexcept {
  input_event raw;
  const wire::Bytes waiting = queue_.waiting();
  if (waiting.size() < sizeof raw) return std::nullopt;
  std::memcpy(&raw, waiting.data(), sizeof raw);
  queue_.drop(sizeof raw);
  return InputEvent{raw.type, raw.code, raw.value};
}

}  // namespace jaywalk::panel
