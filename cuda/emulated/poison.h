#pragma once
#include <cstddef>
#include <cstring>

namespace jaywalk::emulated {

/// What memory holds that nothing has been written to: no zero, no small number, a float of -4e8.
inline constexpr int kPoison = 0xcd;

inline void poison(void* memory, std::size_t bytes) {
  if (bytes > 0) std::memset(memory, kPoison, bytes);
}

}  // namespace jaywalk::emulated
