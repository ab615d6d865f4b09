// libFuzzer's entry.
#include <cstddef>

#include "tests/perception/fuzz/seeing_target.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t count) {
  jaywalk::test::fuzz_seeing({bytes, count});
  return 0;
}
