#pragma once
#include <cstdint>

namespace jaywalk::wire {

/// Sets an open serial line to 8 data bits, no parity, one stop bit, no flow control, nothing translated, at any rate
/// (termios2; glibc's own calls know but a few). False where it does not take that.
[[nodiscard]] bool set_raw(int line, std::uint32_t baud) noexcept;

}  // namespace jaywalk::wire
