#pragma once
// Three ways in which a body may go on, weighed by how well each foretold what was seen: it stands, it walks straight
// on, or it turns, sets out or stops. An interacting multiple model filter (Blom and Bar-Shalom 1988).
#include <array>

#include "planner/tracking/track.h"

namespace jaywalk {

/// What one model believes. x and y are alike and independent, so one covariance serves both axes.
struct ModelState {
  Vec2 position, velocity;
  AxisCovariance covariance;
  double weight = 0.0;  ///< the probability that the body goes by this model
};

class MotionModels {
 public:
  enum Model : std::size_t { kStands, kWalks, kTurns, kCount };

  MotionModels() = default;
  /// At `track`'s place and speed, as doubtful as it is.
  explicit MotionModels(const Track& track);

  /// Moves every model `dt_s` >= 0 seconds on, and `track` to their mean.
  void predict(Track& track, double dt_s) noexcept;
  /// Takes a position measured `late_s` after the track's stamp, `std_m` > 0 an axis, and weighs the models by it;
  /// `track` becomes their mean, at its stamp.
  void correct(Track& track, Vec2 measured_in_map, double std_m, double late_s = 0.0) noexcept;
  /// What was taken for its stamp was `late_s` after it: back to where it was then, going straight.
  void date_back(Track& track, double late_s) noexcept;
  /// Every model was `by_m` from where it took the body to be.
  void move(Vec2 by_m) noexcept;

  [[nodiscard]] double weight(Model model) const { return models_[model].weight; }

 private:
  void mix(double dt_s) noexcept;
  void report(Track& track) const noexcept;

  std::array<ModelState, kCount> models_{};
};

}  // namespace jaywalk
