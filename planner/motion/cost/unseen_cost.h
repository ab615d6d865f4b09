#pragma once
#include <cmath>

#include "planner/cell/exp_log.h"
#include "planner/motion/cost/prices.h"
#include "planner/motion/situation.h"

namespace jaywalk::motion {

/// Parts of the body where nothing was ever seen.
class UnseenCost {
 public:
  explicit UnseenCost(const Situation& s) : s_(s) {}

  void add(const RobotState& r, const cell::Heading& along, Cost& cost) noexcept {
    if (r.v > 0.0F) driven_m_ += r.v * kStepS;
    int parts = 0;
    for (const Place& p : s_.body.rim) {
      const float x = r.x + p.x * along.x - p.y * along.y, y = r.y + p.x * along.y + p.y * along.x;
      parts += !(s_.is_long() && stood_on(x, y)) && s_.guide.is_unseen(x, y) ? 1 : 0;
    }
    if (parts == 0) return;
    const bool is_dared = s_.goes_by_poses() ? s_.poses->through_unseen : s_.guide.through_unseen;
    const float turned = s_.is_long() ? price::kUnseenTurnedLong : price::kUnseenTurned;
    const float price = is_dared ? price::kUnseenDared + turned * std::fabs(r.w)
                                 : price::kUnseen * cell::exp(-driven_m_ / price::kUnseenFadesM);
    cost.unseen += price * kStepS * static_cast<float>(parts) * 0.125F;
  }

 private:
  /// What a long body stands on and turns over now counts as seen.
  [[nodiscard]] bool stood_on(float x, float y) const noexcept {
    const float dx = x - s_.start.x, dy = y - s_.start.y;
    return dx * dx + dy * dy < price::kStoodOnM * price::kStoodOnM;
  }

  const Situation& s_;
  float driven_m_ = 0.0F;  ///< forward
};

}  // namespace jaywalk::motion
