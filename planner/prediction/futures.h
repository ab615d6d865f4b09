#pragma once
// Samples of where movers will be, those that nothing shows yet among them.
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "hal/types/fixed_vector.h"
#include "hal/types/geometry.h"
#include "hal/types/laser_scan.h"
#include "planner/prediction/pedestrian_model.h"
#include "planner/scan/line_of_sight.h"
#include "planner/tracking/track.h"

namespace jaywalk::motion {

inline constexpr int kFutures = 32;             ///< a bit of a word each

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

inline constexpr std::size_t kMostMovers = 64;  ///< nearest first
inline constexpr float kFutureStepS = 0.2F;
inline constexpr int kFutureSteps = 31;  ///< 0 to 6 s

/// Where every mover is in each of the futures, at one time.
struct MoverAt {
  float x[kFutures], y[kFutures];
  float along_x[kFutures], along_y[kFutures];
  std::uint32_t walks;         ///< a bit a future
  float mid_x, mid_y, spread;  ///< a circle that holds the places in all futures
};

/// A pedestrian that has stood for long.
struct StandingDisc {
  float x, y, radius;
};

/// Joint futures of all movers: in each they walk, stop, turn away from walls and from each other, and set out.
/// History in the constructor. Thread: the loop's.
class Futures {
 public:
  Futures() : at_(static_cast<std::size_t>(kFutureSteps) * kMostMovers), walkers_(kMostMovers) {}

  /// Those seen are drawn from what is believed of them; those out of sight are given as they may be, kFutures of each.
  void draw(std::span<const MoverBelief> seen, std::span<const PedestrianSample> hidden, const TurningModel& turning,
            const Guide& guide, std::uint32_t decision) noexcept;

  [[nodiscard]] std::size_t movers() const { return movers_; }
  /// While it stands it is a surface: the map's, if it was never seen to walk, or one of standing().
  [[nodiscard]] bool is_surface(std::size_t mover) const { return surface_[mover]; }
  /// Pedestrians that have stood for long, where they stand: the same in all futures.
  [[nodiscard]] std::span<const StandingDisc> standing() const { return {standing_, standing_count_}; }
  /// Most likely no pedestrian: nothing is owed to it while it stands.
  [[nodiscard]] bool is_newcomer(std::size_t mover) const { return newcomer_[mover]; }
  /// It has stood for long: should it set out, the robot sees that before it drives on.
  [[nodiscard]] bool has_stood(std::size_t mover) const { return stood_[mover]; }
  [[nodiscard]] float radius(std::size_t mover) const { return radius_[mover]; }
  [[nodiscard]] const MoverAt& at(int step, std::size_t mover) const {
    return at_[static_cast<std::size_t>(step) * kMostMovers + mover];
  }

 private:
  void note(int step) noexcept;
  void find_blocked(int step) noexcept;

  std::vector<MoverAt> at_;
  struct Row {
    PedestrianSample in[kFutures];
  };
  std::vector<Row> walkers_;
  float radius_[kMostMovers] = {};
  bool surface_[kMostMovers] = {}, newcomer_[kMostMovers] = {}, stood_[kMostMovers] = {};
  StandingDisc standing_[kMostMovers] = {};
  std::size_t standing_count_ = 0;
  std::uint32_t blocked_[kMostMovers] = {};  ///< a bit a future
  std::size_t movers_ = 0;
};

}  // namespace jaywalk::motion
