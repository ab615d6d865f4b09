#pragma once
#include <array>
#include <cstdint>

namespace jaywalk::sim {

/// What random numbers are for. Each purpose has a stream of its own, so that adding beams does not change movers.
enum class Purpose : std::uint64_t { kRange, kDropOut, kSlip, kFix, kPlacement, kWanderer, kStick, kDelay, kRain };

/// Random numbers that are the same on every machine: xoshiro256** 1.0 (Blackman and Vigna, 2018), its state filled
/// by SplitMix64 from the run's seed and the purpose.
class Random {
 public:
  /// `index` tells apart several users of one purpose.
  Random(std::uint64_t seed, Purpose purpose, std::uint64_t index = 0) noexcept;

  /// In [0, 1), 53 bits.
  [[nodiscard]] double uniform() noexcept;
  [[nodiscard]] double uniform(double low, double high) noexcept { return low + (high - low) * uniform(); }
  /// Mean 0, standard deviation 1 (Box and Muller, 1958).
  [[nodiscard]] double normal() noexcept;

 private:
  std::uint64_t next() noexcept;

  std::array<std::uint64_t, 4> state_{};
  double spare_ = 0.0;  ///< Box-Muller makes two at a time
  bool has_spare_ = false;
};

}  // namespace jaywalk::sim
