#include "planner/prediction/occluded_movers.h"

#include <algorithm>
#include <cmath>

namespace jaywalk::motion {
namespace {
constexpr std::uint32_t kOccludedPurpose = 2;
constexpr int kFewest = 4;             ///< of kFutures left: it is somewhere else
constexpr float kSureWithinM = 12.0F;  ///< beams farther off pass beside a leg
constexpr float kBeyondM = 0.2F;       ///< a beam must go on behind a place to show that it is empty
constexpr float kReturnsWithinM = 0.8F;

/// Whether five beams side by side pass over a place.
bool sees_through(const SeenFrom& seen, float x, float y) {
  const LaserScan& scan = *seen.scan;
  const Pose2& laser = seen.map_from_laser;
  const auto heading_rad = static_cast<float>(laser.heading);
  const float dx = x - static_cast<float>(laser.x), dy = y - static_cast<float>(laser.y);
  const float away = std::sqrt(dx * dx + dy * dy);
  const float bearing = cell::wrapped(cell::angle_of(dx, dy) - heading_rad);
  const float beam = (bearing - scan.first_angle_rad) / scan.angle_step_rad;
  if (!(beam >= 2.0F && beam < static_cast<float>(scan.beam_count) - 3.0F) || away > kSureWithinM) return false;
  const auto middle = static_cast<std::size_t>(beam + 0.5F);
  for (std::size_t k = middle - 2; k <= middle + 2; ++k) {
    const bool passes = scan.is_hit(k) ? scan.range_m[k] > away + kBeyondM : scan.found_nothing(k);
    if (!passes) return false;
  }
  return true;
}

bool sees_through(const OfEach<SeenFrom>& scans, float x, float y) {
  for (const SeenFrom& seen : scans) {
    if (sees_through(seen, x, y)) return true;
  }
  return false;
}

}  // namespace

void OccludedMovers::add(const MoverBelief& belief, const TurningModel& turning, const Guide& guide) noexcept {
  if (!movers_.push_back({belief.id, 0.0F, belief.usual_mps})) return;
  PedestrianSample* walkers = of(movers_.size() - 1);
  for (std::uint32_t k = 0; k < kFutures; ++k) {
    walkers[k] = PedestrianSample::drawn(belief, turning, guide, cell::Draws({0, kOccludedPurpose, belief.id, k}));
  }
}

void OccludedMovers::drop(std::size_t k) noexcept {
  std::copy_n(of(movers_.size() - 1), kFutures, of(k));
  movers_.swap_remove(k);
}

void OccludedMovers::remove(std::uint32_t id) noexcept {
  for (std::size_t k = movers_.size(); k-- > 0;) {
    if (movers_[k].id == id) drop(k);
  }
}

bool OccludedMovers::take(Vec2 place, double& usual_mps) noexcept {
  std::size_t best = movers_.size();
  float least = kReturnsWithinM * kReturnsWithinM;
  for (std::size_t k = 0; k < movers_.size(); ++k) {
    for (int f = 0; f < kFutures; ++f) {
      const float dx = of(k)[f].x - static_cast<float>(place.x), dy = of(k)[f].y - static_cast<float>(place.y);
      if (dx * dx + dy * dy < least) least = dx * dx + dy * dy, best = k;
    }
  }
  if (best == movers_.size()) return false;
  usual_mps = static_cast<double>(movers_[best].usual_mps);
  drop(best);
  return true;
}

void OccludedMovers::update(float dt, const OfEach<SeenFrom>& scans, const TurningModel& turning,
                            const Guide& guide) noexcept {
  for (std::size_t k = movers_.size(); k-- > 0;) {
    PedestrianSample* walkers = of(k);
    int kept = 0;
    for (int f = 0; f < kFutures; ++f) {
      PedestrianSample w = walkers[f];
      w.step(guide, turning, false, dt);
      const bool gone = sees_through(scans, w.x, w.y) || guide.distance(w.x, w.y) < 0.1F;
      if (!gone) walkers[kept++] = w;
    }
    movers_[k].age_s += dt;
    if (kept < kFewest || movers_[k].age_s > kRememberedForS) {
      drop(k);
      continue;
    }
    for (int f = kept; f < kFutures; ++f) {  // the rest copy those left, and draw on their own from here
      walkers[f] = walkers[f % kept];
      walkers[f].draws = cell::Draws(
          {cell::Draws(walkers[f].draws).bits(), kOccludedPurpose, movers_[k].id, static_cast<std::uint32_t>(f)});
    }
  }
}

}  // namespace jaywalk::motion
