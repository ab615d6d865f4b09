#pragma once
#include <cstddef>
#include <cstdint>
#include <random>
#include <span>
#include <vector>

namespace jaywalk::tests {

/// Bytes for throwing at decoders; the same for the same seed everywhere (the engine is fixed by the standard).
class RandomBytes {
 public:
  explicit RandomBytes(std::uint32_t seed) : engine_(seed) {}

  /// Below `bound`, which is positive; the slight bias does not matter here.
  std::size_t below(std::size_t bound) { return engine_() % bound; }
  std::uint8_t byte() { return static_cast<std::uint8_t>(engine_()); }
  std::vector<std::uint8_t> bytes(std::size_t count) {
    std::vector<std::uint8_t> made(count);
    for (auto& one : made) one = byte();
    return made;
  }
  /// A copy of `good` with up to four bytes changed and, half of the times, its end cut off.
  std::vector<std::uint8_t> damaged(std::span<const std::uint8_t> good) {
    std::vector<std::uint8_t> made(good.begin(), good.end());
    for (std::size_t changes = below(5); changes > 0 && !made.empty(); --changes) made[below(made.size())] = byte();
    if (below(2) == 0) made.resize(below(made.size() + 1));
    return made;
  }

 private:
  std::mt19937 engine_;
};

}  // namespace jaywalk::tests
