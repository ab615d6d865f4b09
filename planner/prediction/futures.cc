#include "planner/prediction/futures.h"

#include <algorithm>
#include <cmath>

#include "planner/cost_to_go/pose_price.h"

namespace jaywalk::motion {
namespace {
constexpr std::uint32_t kPurpose = 1;  ///< of the draws; a decision's other draws have others

/// Whether a body of radius `reach - react` is in the quarter circle before a walker.
bool in_way(const PedestrianSample& w, float dx, float dy, float reach) {
  if (dx * dx + dy * dy >= reach * reach) return false;
  const float ahead = dx * w.along.x + dy * w.along.y, aside = dy * w.along.x - dx * w.along.y;
  return std::fabs(aside) <= ahead;
}

}  // namespace

void Futures::draw(std::span<const MoverBelief> seen, std::span<const PedestrianSample> hidden,
                   const TurningModel& turning, const Guide& guide, std::uint32_t decision) noexcept {
  movers_ = standing_count_ = 0;
  for (const MoverBelief& belief : seen) {
    if (movers_ == kMostMovers) break;
    for (std::uint32_t k = 0; k < kFutures; ++k) {
      walkers_[movers_].in[k] =
          PedestrianSample::drawn(belief, turning, guide, cell::Draws({decision, kPurpose, belief.id, k}));
    }
    newcomer_[movers_] = belief.newcomer;
    stood_[movers_] = belief.has_stood();
    surface_[movers_] = !belief.is_pedestrian || stood_[movers_];
    if (belief.stands())
      standing_[standing_count_++] = {belief.x, belief.y, belief.radius_m + jaywalk::price::kFromStanding_m};
    radius_[movers_++] = belief.radius_m;
  }
  seen_ = movers_;
  for (std::size_t at = 0; at + kFutures <= hidden.size() && movers_ < kMostMovers; at += kFutures) {
    std::copy_n(hidden.begin() + static_cast<std::ptrdiff_t>(at), kFutures, walkers_[movers_].in);
    surface_[movers_] = newcomer_[movers_] = stood_[movers_] = false;
    radius_[movers_++] = hidden[at].radius;
  }
  for (int step = 0; step < kFutureSteps; ++step) {
    note(step);
    find_blocked(step);
    for (std::size_t m = 0; m < movers_; ++m) {
      for (std::uint32_t k = 0; k < kFutures; ++k) {
        walkers_[m].in[k].step(guide, turning, (blocked_[m] >> k & 1U) != 0, kFutureStepS);
      }
    }
  }
}

void Futures::note(int step) noexcept {
  for (std::size_t m = 0; m < movers_; ++m) {
    MoverAt& at = at_[static_cast<std::size_t>(step) * kMostMovers + m];
    at.walks = 0;
    float sum_x = 0.0F, sum_y = 0.0F, spread = 0.0F;
    for (int k = 0; k < kFutures; ++k) {
      const PedestrianSample& w = walkers_[m].in[k];
      at.x[k] = w.x, at.y[k] = w.y, at.along_x[k] = w.along.x, at.along_y[k] = w.along.y;
      at.walks |= w.walks ? 1U << k : 0U;
      sum_x += w.x, sum_y += w.y;
    }
    at.mid_x = sum_x / kFutures, at.mid_y = sum_y / kFutures;
    for (int k = 0; k < kFutures; ++k) {
      const float dx = at.x[k] - at.mid_x, dy = at.y[k] - at.mid_y;
      spread = std::max(spread, dx * dx + dy * dy);
    }
    at.spread = std::sqrt(spread);
  }
}

/// Movers with another in the quarter circle before them, in which futures; by where all were at the step's begin.
void Futures::find_blocked(int step) noexcept {
  std::fill_n(blocked_, movers_, 0U);
  for (std::size_t m = 0; m < movers_; ++m) {
    const MoverAt& own = at(step, m);
    for (std::size_t o = 0; o < movers_ && own.walks != 0; ++o) {
      if (o == m) continue;
      const MoverAt& other = at(step, o);
      const float dx = other.mid_x - own.mid_x, dy = other.mid_y - own.mid_y;
      const float most = own.spread + other.spread + radius_[m] + kLookAheadM + radius_[o];
      if (dx * dx + dy * dy >= most * most) continue;
      for (std::uint32_t k = 0; k < kFutures; ++k) {
        const PedestrianSample& w = walkers_[m].in[k];
        if (w.walks && in_way(w, other.x[k] - w.x, other.y[k] - w.y, w.react_m + radius_[o])) blocked_[m] |= 1U << k;
      }
    }
  }
}

}  // namespace jaywalk::motion
