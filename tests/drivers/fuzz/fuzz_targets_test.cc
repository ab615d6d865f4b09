#include "tests/drivers/fuzz/fuzz_targets.h"

#include <string>
#include <vector>

#include "tests/drivers/random_bytes.h"
#include "tests/support/catch.h"
#include "tests/support/kept_inputs.h"

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

TEST_CASE("every decoder keeps its promises over what fuzzing found worth keeping and over the same damaged") {
  for (std::size_t k = 0; k < tests::kFuzzTargets; ++k) {
    const tests::FuzzTarget& target = tests::fuzz_target(k);
    INFO(target.name);
    const auto inputs = kept_inputs(std::string(JAYWALK_FUZZ_CORPUS) + "/" + target.name + ".hex");
    CHECK_FALSE(inputs.empty());
    tests::RandomBytes random(82);
    for (const auto& input : inputs) {
      target.run(input);
      for (int round = 0; round < 20; ++round) target.run(random.damaged(input));
    }
  }
}
