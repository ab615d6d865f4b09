#include "tests/drivers/fuzz/fuzz_targets.h"

#include <string>
#include <vector>

#include "tests/drivers/random_bytes.h"
#include "tests/support/catch.h"

using namespace jaywalk;

TEST_CASE("every decoder keeps its promises over made-up bytes") {
  for (std::size_t k = 0; k < tests::kFuzzTargets; ++k) {
    const tests::FuzzTarget& target = tests::fuzz_target(k);
    INFO(target.name);
    tests::RandomBytes random(81);
    for (int round = 0; round < 2000; ++round) target.run(random.bytes(random.below(200)));
    CHECK(std::string(target.name) != "");
  }
}
