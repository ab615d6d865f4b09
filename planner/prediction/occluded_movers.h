#pragma once
#include <cstdint>
#include <span>

#include "hal/types/fixed_vector.h"
#include "hal/types/geometry.h"
#include "hal/types/laser_scan.h"
#include "planner/prediction/futures.h"
#include "planner/scan/line_of_sight.h"

namespace jaywalk::motion {
/// Movers out of sight: where each may be by now, as kFutures walkers that walk on, less those whose place has been
/// seen to be empty. Gone when hardly one is left, or after kRememberedForS. Thread: the loop's.
class OccludedMovers {
 public:
  static constexpr std::size_t kMost = 16;  ///< when full, newcomers are left out
  static constexpr float kRememberedForS = 8.0F;

  /// Out of sight from now on.
  void add(const MoverBelief& belief, const TurningModel& turning, const Guide& guide) noexcept;
  /// Seen again under its own name.
  void remove(std::uint32_t id) noexcept;
  /// Whether one of them may have come out at a place; it is no longer occluded then, and `usual_mps` is its.
  bool take(Vec2 place, double& usual_mps) noexcept;
  /// `dt` seconds later, with what the scans pass through.
  void update(float dt, const OfEach<SeenFrom>& scans, const TurningModel& turning, const Guide& guide) noexcept;

  /// kFutures of each, one mover after the other.
  [[nodiscard]] std::span<const PedestrianSample> walkers() const {
    return {walkers_.data(), movers_.size() * kFutures};
  }

 private:
  struct Mover {
    std::uint32_t id = 0;
    float age_s = 0.0F, usual_mps = 0.0F;
  };
  void drop(std::size_t k) noexcept;
  [[nodiscard]] PedestrianSample* of(std::size_t k) { return walkers_.data() + k * kFutures; }

  FixedVector<Mover, kMost> movers_;
  std::array<PedestrianSample, kMost * kFutures> walkers_{};
};

}  // namespace jaywalk::motion
