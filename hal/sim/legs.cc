#include "hal/sim/legs.h"

#include <algorithm>
#include <cmath>

namespace jaywalk::sim {
namespace {

constexpr double kWalkRatio = 0.0065 * 60.0;  // m s: a step's length over steps a second
constexpr double kOfTheFoot = 2.0 / 3.0;      // what a shin goes to and fro
// Chosen, not measured: shins in trousers, feet a hand apart, and less than a second from a stride to standing.
constexpr double kLegRadiusM = 0.06;
constexpr double kLegFromMiddleM = 0.1;  // to the side
constexpr double kStepGrowsMps = 1.0;    // a pedestrian starting or stopping changes its steps by this

/// Where the left foot is, in half steps ahead of the middle: it stands on the ground for one step, while the body goes
/// over it, and comes forward with the next.
double left_ahead(double steps) {
  const double of_two = steps - 2.0 * std::floor(0.5 * steps);
  return of_two < 1.0 ? 1.0 - 2.0 * of_two : 2.0 * of_two - 3.0;
}

}  // namespace

void Legs::walk(const MoverTruth& walker, double step_s) noexcept {
  const double speed = norm(walker.velocity), wanted = std::sqrt(kWalkRatio * speed);
  if (wanted > 0.0) steps_ += speed * step_s / wanted;
  step_m_ += std::clamp(wanted - step_m_, -kStepGrowsMps * step_s, kStepGrowsMps * step_s);
}

std::array<Disc, 2> Legs::of(const MoverTruth& walker) const noexcept {
  const Vec2 ahead = direction(walker.heading), left{-ahead.y, ahead.x};
  const Vec2 foot = ahead * (0.5 * kOfTheFoot * step_m_ * left_ahead(steps_)) + left * kLegFromMiddleM;
  return {Disc{walker.position + foot, kLegRadiusM}, Disc{walker.position - foot, kLegRadiusM}};
}

}  // namespace jaywalk::sim
