#include <algorithm>

#include "apps/rivals/baseline.h"

namespace jaywalk::baseline {
namespace {

constexpr float kWindow_s = 0.25F;                    ///< velocities that are reached within
constexpr float kStep_s = 0.1F, kHorizon_s = 3.0F;    ///< of an arc
constexpr int kWindowSpeeds = 11, kWindowTurns = 21;  ///< of the window
constexpr float kProgress = 0.6F, kHeading = 0.2F, kClearance = 0.1F, kVelocity = 0.1F;  ///< weights, of 1 in all
constexpr float kFar_m = 1.5F;                                                           ///< clearance that is enough

/// From the robot's circle to the nearest wall or to the nearest track where it is now.
float clearance(const Scene& scene, float x, float y) noexcept {
  float least = scene.guide.room(x, y);
  for (const Track& track : scene.tracks)
    least = std::min(least, offset_to(track, x, y).norm() - static_cast<float>(track.radius_m));
  return least - scene.radius - kMargin_m;
}

struct Arc {
  float free_m = 0.0F;  ///< of way before something is touched
  float clear_m = kFar_m;
  motion::RobotState end;
};

Arc arc_of(const Scene& scene, const motion::Command& to) noexcept {
  Arc arc{0.0F, kFar_m, scene.now};
  for (float t = 0.0F; t < kHorizon_s; t += kStep_s) {
    arc.end.heading += to.w * kStep_s;
    const cell::Heading at = cell::heading_at(arc.end.heading);
    arc.end.x += to.v * kStep_s * at.x, arc.end.y += to.v * kStep_s * at.y;
    const float clear = clearance(scene, arc.end.x, arc.end.y);
    if (clear < 0.0F) return arc.clear_m = 0.0F, arc;
    arc.clear_m = std::min(arc.clear_m, clear);
    arc.free_m += to.v * kStep_s;
  }
  arc.free_m = 1e3F;
  return arc;
}

}  // namespace

motion::Command dwa(const Scene& scene) noexcept {
  const motion::MotionBounds& b = scene.bounds;
  const float low_v = std::max(0.0F, scene.now.v - b.slowing * kWindow_s),
              high_v = std::min({b.speed, scene.now.v + b.accel * kWindow_s, speed_to_goal(scene)});
  const float low_w = std::max(-b.turn, scene.now.w - b.turn_accel * kWindow_s),
              high_w = std::min(b.turn, scene.now.w + b.turn_accel * kWindow_s);
  const float here_s = scene.guide.time_to_go(scene.now.x, scene.now.y);
  const motion::Command turn = driven_along(scene, way_down(scene), 0.0F);
  motion::Command best{0.0F, turn.w};  // where nothing is admissible: turn to the way
  float most = -1e9F;
  for (int i = 0; i < kWindowSpeeds; ++i) {
    for (int j = 0; j < kWindowTurns; ++j) {
      const motion::Command to{low_v + (high_v - low_v) * static_cast<float>(i) / (kWindowSpeeds - 1),
                               low_w + (high_w - low_w) * static_cast<float>(j) / (kWindowTurns - 1)};
      const Arc arc = arc_of(scene, to);
      if (to.v > 0.0F && to.v * to.v > b.slowing * arc.free_m) continue;  // half the braking: the ramp takes the rest
      const float gained_s = here_s - scene.guide.time_to_go(arc.end.x, arc.end.y);
      const cell::Heading down = way_down({arc.end, scene.goal, {}, scene.guide, b, scene.radius});
      const cell::Heading at = cell::heading_at(arc.end.heading);
      const float worth = kProgress * std::clamp(gained_s / kHorizon_s, -1.0F, 1.0F) +
                          kHeading * (down.x * at.x + down.y * at.y) + kClearance * arc.clear_m / kFar_m +
                          kVelocity * to.v / b.speed;
      if (worth > most) most = worth, best = to;
    }
  }
  return best;
}

}  // namespace jaywalk::baseline
