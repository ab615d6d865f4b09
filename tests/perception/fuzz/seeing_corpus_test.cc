#include "tests/perception/fuzz/seeing_target.h"
#include "tests/support/catch.h"
#include "tests/support/kept_inputs.h"

using namespace jaywalk;

TEST_CASE("seeing keeps its promises over what fuzzing found worth keeping") {
  const auto inputs = kept_inputs(JAYWALK_SEEING_CORPUS);
  CHECK(inputs.size() > 10);
  for (const auto& input : inputs) test::fuzz_seeing(input);  // ends the process where one is broken
}
