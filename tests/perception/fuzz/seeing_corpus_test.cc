#include <charconv>
#include <fstream>
#include <string>
#include <vector>

#include "tests/perception/fuzz/seeing_target.h"
#include "tests/support/catch.h"

using namespace jaywalk;

namespace {

/// An input a line, in hexadecimal.
std::vector<std::vector<std::uint8_t>> kept_inputs() {
  std::ifstream file(JAYWALK_SEEING_CORPUS);
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

TEST_CASE("seeing keeps its promises over what fuzzing found worth keeping") {
  const auto inputs = kept_inputs();
  CHECK(inputs.size() > 10);
  for (const auto& input : inputs) test::fuzz_seeing(input);  // ends the process where one is broken
}
