#include <algorithm>
#include <array>
#include <cmath>

#include "apps/rivals/baseline.h"

namespace jaywalk::baseline {
namespace {

constexpr int kSide = 61;        ///< cells; the robot is in the middle
constexpr float kCell_m = 0.2F;  ///< 12 m across: beyond, walls alone count
constexpr int kMostRounds = 12;  ///< of four sweeps
constexpr float kBlocked_s = 2.0F * Guide::kNoWay_s;
constexpr float kDiagonal = 1.41421356F;

/// Times to the goal, past walls and past where every mover is.
class LocalField {
 public:
  explicit LocalField(const Scene& scene) : scene_(scene) {
    for (int j = 0; j < kSide; ++j)
      for (int i = 0; i < kSide; ++i) at(i, j) = is_blocked(x_of(i), y_of(j)) ? kBlocked_s : begin_at(i, j);
    at(kSide / 2, kSide / 2) = Guide::kNoWay_s;  // where the robot is, it may be
    for (int round = 0; round < kMostRounds && sweep(); ++round) {
    }
  }

  /// Half a metre down the field from the robot; false where there is no way.
  [[nodiscard]] bool next(cell::Heading& direction) const {
    int i = kSide / 2, j = kSide / 2;
    for (int step = 0; step < 3; ++step) {
      int best_i = i, best_j = j;
      for (int dj = -1; dj <= 1; ++dj) {
        for (int di = -1; di <= 1; ++di)
          if (time(i + di, j + dj) < time(best_i, best_j)) best_i = i + di, best_j = j + dj;
      }
      i = best_i, j = best_j;
    }
    const float dx = static_cast<float>(i - kSide / 2), dy = static_cast<float>(j - kSide / 2);
    const float size = std::sqrt(dx * dx + dy * dy);
    if (size > 0.0F) direction = {dx / size, dy / size};
    return size > 0.0F && time(i, j) < Guide::kNoWay_s;
  }

 private:
  float& at(int i, int j) { return times_[static_cast<std::size_t>(j * kSide + i)]; }
  [[nodiscard]] float time(int i, int j) const {
    const bool inside = i >= 0 && j >= 0 && i < kSide && j < kSide;
    return inside ? times_[static_cast<std::size_t>(j * kSide + i)] : kBlocked_s;
  }
  [[nodiscard]] float x_of(int i) const { return scene_.now.x + kCell_m * static_cast<float>(i - kSide / 2); }
  [[nodiscard]] float y_of(int j) const { return scene_.now.y + kCell_m * static_cast<float>(j - kSide / 2); }

  [[nodiscard]] bool is_blocked(float x, float y) const {
    if (scene_.guide.room(x, y) < scene_.radius) return true;
    return std::any_of(scene_.tracks.begin(), scene_.tracks.end(), [&](const Track& track) {
      const float radius = scene_.radius + static_cast<float>(track.radius_m) + kMargin_m;
      return offset_to(track, x, y).squaredNorm() < radius * radius;
    });
  }
  /// At the rim, and at the goal, the way is the one past walls alone.
  [[nodiscard]] float begin_at(int i, int j) const {
    const float dx = scene_.goal.x - x_of(i), dy = scene_.goal.y - y_of(j);
    if (dx * dx + dy * dy < kCell_m * kCell_m) return 0.0F;
    const bool rim = i == 0 || j == 0 || i == kSide - 1 || j == kSide - 1;
    return rim ? std::min(scene_.guide.time_to_go(x_of(i), y_of(j)), Guide::kNoWay_s) : Guide::kNoWay_s;
  }
  bool settle(int i, int j) {
    float& here = at(i, j);
    if (here >= kBlocked_s) return false;
    const float step = kCell_m / scene_.bounds.speed;
    float least = here;
    for (int dj = -1; dj <= 1; ++dj) {
      for (int di = -1; di <= 1; ++di) {
        const float over = time(i + di, j + dj) + step * (di != 0 && dj != 0 ? kDiagonal : 1.0F);
        if (di != 0 || dj != 0) least = std::min(least, over);
      }
    }
    return least < here ? here = least, true : false;
  }
  /// In four orders; whether anything changed.
  bool sweep() {
    bool changed = false;
    for (int order = 0; order < 4; ++order) {
      for (int b = 0; b < kSide; ++b)
        for (int a = 0; a < kSide; ++a)
          changed |= settle((order & 1) != 0 ? kSide - 1 - a : a, (order & 2) != 0 ? kSide - 1 - b : b);
    }
    return changed;
  }

  const Scene& scene_;
  std::array<float, static_cast<std::size_t>(kSide* kSide)> times_{};
};

}  // namespace

motion::Command replan(const Scene& scene) noexcept {
  cell::Heading direction;
  if (!LocalField(scene).next(direction)) return {};  // enclosed: wait
  return driven_along(scene, direction, speed_to_goal(scene));
}

}  // namespace jaywalk::baseline
