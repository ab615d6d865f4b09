#include "firmware/safety/sight_loss.h"

namespace jaywalk {
namespace {

constexpr std::uint32_t kShare = 2, kShareAhead = 3;  // one in so many
constexpr Duration kLongestAhead = std::chrono::seconds(1);

}  // namespace

bool SightLoss::is_lost(const BeamCounts& counts, Time now) noexcept {
  if (kShareAhead * counts.lost_ahead <= counts.ahead) {
    lost_ahead_since_ = kNever;
  } else if (lost_ahead_since_ == kNever) {
    lost_ahead_since_ = now;
  }
  const bool ahead = lost_ahead_since_ != kNever && now - lost_ahead_since_ > kLongestAhead;
  return ahead || kShare * counts.lost > counts.lost + counts.measured;
}

}  // namespace jaywalk
