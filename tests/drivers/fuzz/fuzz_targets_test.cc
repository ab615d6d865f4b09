#include "tests/drivers/fuzz/fuzz_targets.h"

#include <string>
#include <vector>

#include "tests/drivers/random_bytes.h"
#include "tests/support/allocation_guard.h"
#include "tests/support/catch.h"
#include "tests/support/kept_inputs.h"

using namespace jaywalk;

TEST_CASE("every decoder keeps its promises over made-up bytes") {
  for (std::size_t k = 0; k < tests::kFuzzTargets; ++k) {
    INFO(tests::fuzz_target(k).name);
    tests::RandomBytes random(81);
    for (int round = 0; round < 2000; ++round) tests::fuzz_target(k).run(random.bytes(random.below(200)));
  }
}

TEST_CASE("every decoder keeps its promises over what fuzzing found worth keeping and over the same damaged") {
  for (std::size_t k = 0; k < tests::kFuzzTargets; ++k) {
    const tests::FuzzTarget& target = tests::fuzz_target(k);
    INFO(target.name);
    const auto inputs = kept_inputs(std::string(JAYWALK_FUZZ_CORPUS) + "/" + target.name + ".hex");
    CHECK_FALSE(inputs.empty());
    tests::RandomBytes random(82);
    std::uint64_t heap_calls = 0;
    for (const auto& input : inputs) {
      target.run(input);
      for (int round = 0; round < 350; ++round) {
        const auto bytes = random.damaged(input);
        const AllocationGuard guard;
        target.run(bytes);
        heap_calls += guard.calls();
      }
    }
    // The emulated drive of the first has a map; the second is a reader of files, for tests alone.
    const bool may_allocate = std::string(target.name) == "canopen" || std::string(target.name) == "eds_file";
    CHECK((heap_calls == 0 || may_allocate));
  }
}
