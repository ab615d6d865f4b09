#pragma once
#include <cstdlib>

#include "drivers/wire/byte_reader.h"
#include "hal/types/time.h"

namespace jaywalk::tests {

/// Feeds bytes to one decoder and ends the process where what comes out breaks the decoder's promises.
struct FuzzTarget {
  const char* name;
  void (*run)(wire::Bytes bytes);
};

/// Every decoder of drivers/ that takes bytes from outside.
inline constexpr std::size_t kFuzzTargets = 12;
[[nodiscard]] const FuzzTarget& fuzz_target(std::size_t index);

inline constexpr Time kArrival{std::chrono::seconds(10)};

/// Ends the process, as a fuzzer wants it, where a promise is broken.
inline void require(bool holds) {
  if (!holds) std::abort();
}

void fuzz_sick(wire::Bytes bytes);
void fuzz_scip(wire::Bytes bytes);
void fuzz_ldrobot(wire::Bytes bytes);
void fuzz_lms200(wire::Bytes bytes);
void fuzz_ros(wire::Bytes bytes);
void fuzz_scanner_protocol(wire::Bytes bytes);

}  // namespace jaywalk::tests
