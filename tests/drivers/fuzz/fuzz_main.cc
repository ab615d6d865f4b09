// libFuzzer's entry; JAYWALK_FUZZ_TARGET names the decoder.
#include <cstdlib>
#include <string_view>

#include "tests/drivers/fuzz/fuzz_targets.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t count) {
  using namespace jaywalk::tests;
  for (std::size_t k = 0; k < kFuzzTargets; ++k) {
    if (std::string_view(fuzz_target(k).name) != JAYWALK_FUZZ_TARGET) continue;
    fuzz_target(k).run({bytes, count});
    return 0;
  }
  std::abort();
}
