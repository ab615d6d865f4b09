#pragma once
#include "drivers/wire/byte_reader.h"

namespace jaywalk::tests {

/// Feeds bytes to one decoder and ends the process where what comes out breaks the decoder's promises.
struct FuzzTarget {
  const char* name;
  void (*run)(wire::Bytes bytes);
};

/// Every decoder of drivers/ that takes bytes from outside.
inline constexpr std::size_t kFuzzTargets = 12;
[[nodiscard]] const FuzzTarget& fuzz_target(std::size_t index);

}  // namespace jaywalk::tests
