#include "planner/prediction/futures.h"

#include <algorithm>
#include <cmath>

#include "planner/cost_to_go/pose_moves.h"

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

void Futures::draw(std::span<const MoverBelief> seen, std::span<const OccludedMover> hidden,
                   const TurningModel& turning, const Guide& guide, std::uint32_t decision) noexcept {
  movers_.clear();
  standing_.clear();
  for (const MoverBelief& b : seen.first(std::min(seen.size(), kMostMovers))) {
    for (std::uint32_t k = 0; k < kFutures; ++k) {
      walkers_[movers_.size()][k] =
          PedestrianSample::drawn(b, turning, guide, cell::Draws({decision, kPurpose, b.id, k}));
    }
    (void)movers_.push_back({b.radius_m, !b.is_pedestrian || b.has_stood(), b.newcomer, b.has_stood()});
    if (b.stands()) (void)standing_.push_back({b.x, b.y, b.radius_m + jaywalk::price::kFromStanding_m});
  }
  for (const OccludedMover& mover : hidden.first(std::min(hidden.size(), kMostMovers - movers_.size()))) {
    walkers_[movers_.size()] = mover.walkers;
    (void)movers_.push_back({.radius_m = mover.walkers[0].radius, .is_hidden = true});
  }
  for (int step = 0; step < kFutureSteps; ++step) {
    note(step);
    find_blocked(step);
    for (std::size_t m = 0; m < movers_.size(); ++m) {
      for (std::uint32_t k = 0; k < kFutures; ++k) {
        walkers_[m][k].step(guide, turning, (blocked_[m] >> k & 1U) != 0, kFutureStepS);
      }
    }
  }
}

void Futures::note(int step) noexcept {
  for (std::size_t m = 0; m < movers_.size(); ++m) {
    MoverAt& at = at_[static_cast<std::size_t>(step) * kMostMovers + m];
    at.walks = 0;
    float sum_x = 0.0F, sum_y = 0.0F, spread = 0.0F;
    for (std::uint32_t k = 0; k < kFutures; ++k) {
      const PedestrianSample& w = walkers_[m][k];
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
  std::fill_n(blocked_, movers_.size(), 0U);
  for (std::size_t m = 0; m < movers_.size(); ++m) {
    const MoverAt& own = at(step, m);
    for (std::size_t o = 0; o < movers_.size() && own.walks != 0; ++o) {
      if (o == m) continue;
      const MoverAt& other = at(step, o);
      const float dx = other.mid_x - own.mid_x, dy = other.mid_y - own.mid_y;
      const float most = own.spread + other.spread + movers_[m].radius_m + kLookAheadM + movers_[o].radius_m;
      if (dx * dx + dy * dy >= most * most) continue;
      for (std::uint32_t k = 0; k < kFutures; ++k) {
        const PedestrianSample& w = walkers_[m][k];
        if (w.walks && in_way(w, other.x[k] - w.x, other.y[k] - w.y, w.react_m + movers_[o].radius_m))
          blocked_[m] |= 1U << k;
      }
    }
  }
}

}  // namespace jaywalk::motion
