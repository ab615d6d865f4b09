#pragma once
// What a disc of the robot has to do with one mover, in all sampled futures at once.
#include <cmath>
#include <cstdint>

#include "planner/motion/cost/prices.h"
#include "planner/prediction/futures.h"

namespace jaywalk::motion {

inline constexpr float kMoverMarginM = 0.035F;
inline constexpr float kZoneM = 0.5F + 0.1F;  ///< before a mover: where it would turn away, and a margin
inline constexpr float kZoneSideM = 0.013F;

/// Sets of futures are a bit each.
struct Interaction {
  std::uint32_t met = 0;  ///< touched, or in the quarter circle before the mover while that walks
  std::uint32_t touched = 0;
  float nearness = 0.0F;  ///< to those that walk, a sum over futures, m2
  float beside = 0.0F;    ///< the same of those that stand
  float too_fast = 0.0F;  ///< beside it while it stands: m/s over what is polite, a sum over futures
};

/// A disc of the robot, and how fast that drives.
struct MovingDisc {
  float x, y, radius_m, speed_mps;
};

inline Interaction interaction(const MoverAt& at, float mover_m, bool is_surface, const MovingDisc& disc,
                               float comfort_m) noexcept {
  const float touch = mover_m + disc.radius_m + kMoverMarginM, touch2 = touch * touch;
  const float zone = mover_m + kZoneM, edge = disc.radius_m + kZoneSideM;
  const float comfort2 = comfort_m * comfort_m;
  const float reach2 = (zone + edge) * (zone + edge), edge2 = edge * edge;
  alignas(32) std::int32_t hit[kFutures], faced[kFutures];
  alignas(32) float near[kFutures], fast[kFutures];
  for (int k = 0; k < kFutures; ++k) {
    const float dx = disc.x - at.x[k], dy = disc.y - at.y[k], d2 = dx * dx + dy * dy;
    const float ahead = dx * at.along_x[k] + dy * at.along_y[k];
    const float left = dy * at.along_x[k] - dx * at.along_y[k], aside = left < 0.0F ? -left : left;
    // Along the quarter circle's side, and off it; beyond the side a disc still reaches in.
    const float along = (ahead + aside) * 0.70710678F, off = (aside - ahead) * 0.70710678F;
    const float over = edge2 - off * off;
    const float first = along - std::sqrt(over > 0.0F ? over : 0.0F);
    const std::int32_t inside = (aside <= ahead) & (d2 < reach2);
    const std::int32_t beside = (aside > ahead) & (along > 0.0F) & (over > 0.0F) & (first < zone);
    hit[k] = d2 < touch2 ? 1 : 0;
    faced[k] = inside | beside;
    near[k] = d2 < comfort2 ? comfort2 - d2 : 0.0F;
    const float gap = std::sqrt(d2) - mover_m - disc.radius_m;  // it may set out, and be there within a second
    const float polite = gap < price::kPoliteMps ? price::kPoliteMps : gap;
    fast[k] = disc.speed_mps > polite ? disc.speed_mps - polite : 0.0F;
  }
  Interaction sum;
  std::uint32_t touched = 0, in_zone = 0;
  for (int k = 0; k < kFutures; ++k) {
    touched |= static_cast<std::uint32_t>(hit[k]) << k;
    in_zone |= static_cast<std::uint32_t>(faced[k]) << k;
    const bool walks = (at.walks >> k & 1U) != 0;
    sum.nearness += walks ? near[k] : 0.0F;
    sum.beside += walks ? 0.0F : near[k];
    sum.too_fast += walks ? 0.0F : fast[k];
  }
  sum.touched = is_surface ? touched & at.walks : touched;
  sum.met = sum.touched | (in_zone & at.walks);
  return sum;
}

/// Those of `futures` in which the disc is nearer to the mover `at` than it was at `before` to the same mover, `was`.
inline std::uint32_t nearer(std::uint32_t futures, Place disc, const MoverAt& at, Place before,
                            const MoverAt& was) noexcept {
  const auto distance2 = [](Place p, const MoverAt& mover, int k) {
    const float dx = p.x - mover.x[k], dy = p.y - mover.y[k];
    return dx * dx + dy * dy;
  };
  std::uint32_t are = 0;
  for (int k = 0; k < kFutures; ++k)
    are |= static_cast<std::uint32_t>(distance2(disc, at, k) < distance2(before, was, k) ? 1 : 0) << k;
  return futures & are;
}

}  // namespace jaywalk::motion
