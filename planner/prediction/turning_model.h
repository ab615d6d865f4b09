#pragma once
// How often walkers turn or stop where nothing makes them, and how many newcomers that stand walk off: learned while
// driving.
namespace jaywalk::motion {

/// Rates with a prior worth half a minute of looking at one walker: cautious until something else is seen.
struct TurningModel {
  static constexpr float kPriorS = 30.0F, kPriorTurnsHz = 0.01F, kPriorStopsHz = 0.03F;
  float watched_s = 0.0F, turns = 0.0F, stops = 0.0F;
  float usual_mps = 0.6F;  ///< of walkers; the mean of those watched

  /// What is new, stands and is as wide as a body: a prior worth five of them. Among posts it is soon known for posts.
  static constexpr float kPriorNewcomers = 5.0F, kPriorWalkOff = 0.2F, kNewForS = 4.0F;
  float newcomers = 0.0F, walked_off = 0.0F;

  [[nodiscard]] float turns_hz() const { return (turns + kPriorTurnsHz * kPriorS) / (watched_s + kPriorS); }
  [[nodiscard]] float stops_hz() const { return (stops + kPriorStopsHz * kPriorS) / (watched_s + kPriorS); }
  /// Of one newcomer, within kNewForS.
  [[nodiscard]] float walks_off_hz() const {
    return (walked_off + kPriorWalkOff * kPriorNewcomers) / ((newcomers + kPriorNewcomers) * kNewForS);
  }
};

}  // namespace jaywalk::motion
