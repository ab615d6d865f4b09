#pragma once
#include <charconv>
#include <cstdint>
#include <fstream>
#include <string>
#include <vector>

#include "tests/support/catch.h"

namespace jaywalk {

/// What fuzzing found worth keeping: an input a line, in hexadecimal. Fails the test where a line is not.
inline std::vector<std::vector<std::uint8_t>> kept_inputs(const std::string& path) {
  std::ifstream file(path);
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

}  // namespace jaywalk
