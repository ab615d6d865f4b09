#pragma once
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>

#include "hal/types/trig.h"

namespace jaywalk::sim {

/// What random numbers are for. Each purpose has a stream of its own, so that adding beams does not change movers.
enum class Purpose : std::uint64_t { kRange, kDropOut, kSlip, kFix, kPlacement, kWanderer, kStick, kDelay, kRain };

/// Random numbers that are the same on every machine: xoshiro256** 1.0 (Blackman and Vigna, 2018), its state filled
/// by SplitMix64 from the run's seed and the purpose.
class Random {
 public:
  /// `index` tells apart several users of one purpose.
  Random(std::uint64_t seed, Purpose purpose, std::uint64_t index = 0) noexcept {
    std::uint64_t mixed = seed;
    mixed = split_mix(mixed) + static_cast<std::uint64_t>(purpose);
    mixed = split_mix(mixed) + index;
    for (std::uint64_t& word : state_) word = split_mix(mixed);
  }

  /// In [0, 1), 53 bits.
  [[nodiscard]] double uniform() noexcept { return static_cast<double>(next() >> 11) * 0x1p-53; }
  [[nodiscard]] double uniform(double low, double high) noexcept { return low + (high - low) * uniform(); }
  /// Mean 0, standard deviation 1 (Box and Muller, 1958).
  [[nodiscard]] double normal() noexcept {
    if (has_spare_) {
      has_spare_ = false;
      return spare_;
    }
    const double radius = std::sqrt(-2.0 * log(1.0 - uniform()));  // 1 - uniform is never 0
    const double angle = 2.0 * kPi * uniform();
    spare_ = radius * sin(angle);
    has_spare_ = true;
    return radius * cos(angle);
  }

 private:
  /// SplitMix64 (Steele, Lea and Flood, 2014): also good from seeds that differ in one bit.
  static std::uint64_t split_mix(std::uint64_t& state) noexcept {
    std::uint64_t z = state += 0x9e3779b97f4a7c15U;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9U;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebU;
    return z ^ (z >> 31);
  }
  std::uint64_t next() noexcept {
    const std::uint64_t result = std::rotl(state_[1] * 5, 7) * 9;
    const std::uint64_t shifted = state_[1] << 17;
    state_[2] ^= state_[0];
    state_[3] ^= state_[1];
    state_[1] ^= state_[2];
    state_[0] ^= state_[3];
    state_[2] ^= shifted;
    state_[3] = std::rotl(state_[3], 45);
    return result;
  }

  std::array<std::uint64_t, 4> state_{};
  double spare_ = 0.0;  ///< Box-Muller makes two at a time
  bool has_spare_ = false;
};

}  // namespace jaywalk::sim
