#pragma once
#include <cstddef>
#include <cstdint>

#include "planner/motion/cost/prices.h"
#include "planner/prediction/futures.h"

namespace jaywalk::motion {

/// Movers in whose way the robot has been, in some futures: one stands there for a while and is gone then, for it has
/// turned away.
class MetMovers {
 public:
  /// The mover as it has reacted so far; valid until the next call.
  const MoverAt& shown(const MoverAt& at, std::size_t mover, float t) noexcept {
    if (mover >= kMost || met_[mover] == 0) return at;
    shown_ = at;
    for (int k = 0; k < kFutures; ++k) {
      if ((met_[mover] >> k & 1U) == 0) continue;
      const Meeting& there = at_[mover][k];
      const bool stands = t < there.t + price::kMeetsForS;
      shown_.x[k] = stands ? there.x : kGone, shown_.y[k] = stands ? there.y : kGone;
    }
    shown_.walks &= ~met_[mover];
    return shown_;
  }

  /// `futures`: in which it has been met just now.
  void note(const MoverAt& at, std::size_t mover, std::uint32_t futures, float t) noexcept {
    if (mover >= kMost) return;
    const std::uint32_t first = futures & ~met_[mover];
    met_[mover] |= first;
    for (int k = 0; k < kFutures && first != 0; ++k) {
      if ((first >> k & 1U) != 0) at_[mover][k] = {at.x[k], at.y[k], t};
    }
  }

 private:
  struct Meeting {
    float x, y, t;
  };
  static constexpr std::size_t kMost = 24;  ///< the nearest
  static constexpr float kGone = 1e5F;
  std::uint32_t met_[kMost] = {};
  Meeting at_[kMost][kFutures];
  MoverAt shown_;
};

}  // namespace jaywalk::motion
