#include "tests/drivers/fuzz/fuzz_targets.h"

#include <charconv>
#include <fstream>
#include <string>
#include <vector>

#include "tests/drivers/random_bytes.h"
#include "tests/support/catch.h"

using namespace jaywalk;

namespace {

/// An input a line, in hexadecimal.
std::vector<std::vector<std::uint8_t>> kept_inputs(const std::string& decoder) {
  std::ifstream file(std::string(JAYWALK_FUZZ_CORPUS) + "/" + decoder + ".hex");
  std::vector<std::vector<std::uint8_t>> inputs;
  for (std::string line; std::getline(file, line);) {
    std::vector<std::uint8_t> bytes(line.size() / 2);
    for (std::size_t k = 0; k < bytes.size(); ++k) {
      const char* const digits = line.data() + 2 * k;
      REQUIRE(std::from_chars(digits, digits + 2, bytes[k], 16).ptr == digits + 2);
    }
    inputs.push_back(bytes);
  }
  return inputs;
}

}  // namespace

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
    const auto inputs = kept_inputs(target.name);
    CHECK_FALSE(inputs.empty());
    tests::RandomBytes random(82);
    for (const auto& input : inputs) {
      target.run(input);
      for (int round = 0; round < 20; ++round) target.run(random.damaged(input));
    }
  }
}
