#pragma once
// How often those who walk turn or stop where nothing makes them: learned while driving.
namespace jaywalk::motion {

/// Rates with a prior worth half a minute of looking at one walker: cautious until something else is seen.
struct TurningModel {
  static constexpr float kPriorS = 30.0F, kPriorTurnsHz = 0.01F, kPriorStopsHz = 0.03F;
  float watched_s = 0.0F, turns = 0.0F, stops = 0.0F;
  float usual_mps = 0.6F;  ///< of walkers; the mean of those watched

  [[nodiscard]] float turns_hz() const { return (turns + kPriorTurnsHz * kPriorS) / (watched_s + kPriorS); }
  [[nodiscard]] float stops_hz() const { return (stops + kPriorStopsHz * kPriorS) / (watched_s + kPriorS); }
};

}  // namespace jaywalk::motion
