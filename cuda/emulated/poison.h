#pragma once
#include <cstddef>
#include <cstring>

namespace jaywalk::emulated {

/// Of what memory holds that nothing has been written to: 0xcd makes floats of -4e8; with even seeds 0xff makes NaNs.
inline int poison_byte = 0xcd;

inline void poison(void* memory, std::size_t bytes) {
  if (bytes > 0) std::memset(memory, poison_byte, bytes);
}

}  // namespace jaywalk::emulated
