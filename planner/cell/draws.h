#pragma once
// Random numbers without a state to pass on: what is drawn depends on what it is drawn for, not on when or where.
#include <cstdint>

#include "planner/cell/cell.h"

namespace jaywalk::cell {

/// What a row of numbers is drawn for: 128 bits, all of which count.
struct DrawnFor {
  std::uint32_t decision = 0, purpose = 0, who = 0, future = 0;
};

/// A row of random numbers for one purpose. Philox4x32-10: Salmon, Moraes, Dror and Shaw, "Parallel random numbers: as
/// easy as 1, 2, 3" (2011); multipliers and key steps are theirs.
class Draws {
 public:
  JAYWALK_ANYWHERE explicit Draws(const DrawnFor& what)
      : key_{what.decision, what.purpose}, counter_{0, 0, what.who, what.future}, left_{0} {}

  JAYWALK_ANYWHERE std::uint32_t bits() {
    if (left_ == 0) refill();
    return block_[--left_];
  }
  /// Uniform in (0, 1): 24 bits, never 0.
  JAYWALK_ANYWHERE float uniform() { return (static_cast<float>(bits() >> 8U) + 0.5F) * (1.0F / 16777216.0F); }
  /// Uniform in (-1, 1).
  JAYWALK_ANYWHERE float either_way() { return 2.0F * uniform() - 1.0F; }
  /// Mean 0, variance 1, at most 3.5 in size: four uniform numbers' sum, close enough to normal for a belief.
  JAYWALK_ANYWHERE float normal() {
    const float sum = uniform() + uniform() + uniform() + uniform();
    return (sum - 2.0F) * 1.73205081F;
  }
  /// Time to the first of events that come `per_s` times a second, s; very long where they never do.
  JAYWALK_ANYWHERE float waiting_s(float per_s) { return per_s > 1e-6F ? -cell::log(uniform()) / per_s : 1e6F; }

 private:
  JAYWALK_ANYWHERE void refill() {
    std::uint32_t k0 = key_[0], k1 = key_[1];
    for (int i = 0; i < 4; ++i) block_[i] = counter_[i];
    for (int round = 0; round < 10; ++round) {
      const std::uint64_t p0 = 0xD2511F53ULL * block_[0], p1 = 0xCD9E8D57ULL * block_[2];
      const auto high0 = static_cast<std::uint32_t>(p0 >> 32U), low0 = static_cast<std::uint32_t>(p0);
      const auto high1 = static_cast<std::uint32_t>(p1 >> 32U), low1 = static_cast<std::uint32_t>(p1);
      block_[0] = high1 ^ block_[1] ^ k0;
      block_[1] = low1;
      block_[2] = high0 ^ block_[3] ^ k1;
      block_[3] = low0;
      k0 += 0x9E3779B9U;
      k1 += 0xBB67AE85U;
    }
    ++counter_[0];
    left_ = 4;
  }

  std::uint32_t key_[2];
  std::uint32_t counter_[4];
  std::uint32_t block_[4]{};
  int left_;
};

}  // namespace jaywalk::cell
