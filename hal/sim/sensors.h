#pragma once
// What the controller gets to see of the world, each device at its own rate, faults included.
#include "hal/hal.h"
#include "hal/sim/laser_sim.h"
#include "hal/sim/world.h"

namespace jaywalk::sim {

/// Encoders are read this often.
inline constexpr Duration kEncoderPeriod{10'000'000};

/// True at the first call at or after each multiple of a period.
class Metronome {
 public:
  explicit Metronome(double rate_hz) : rate_hz_(rate_hz) {}
  [[nodiscard]] bool due(Time now) noexcept;

 private:
  double rate_hz_;
  double beats_ = 0.0;
};

class Sensors {
 public:
  Sensors(const Scenario& scenario, std::uint64_t seed);

  /// Call after every step of the world, and once before the first.
  void sense(World& world) noexcept;

  [[nodiscard]] const LaserScan& scan() const noexcept { return scan_; }
  [[nodiscard]] const WheelState& wheels() const noexcept { return wheels_; }
  [[nodiscard]] const OutsideFix& fix() const noexcept { return fix_; }

 private:
  void look(const World& world) noexcept;
  void turn(const World& world) noexcept;
  void spoil(const World& world) noexcept;
  void locate(const Truth& truth) noexcept;

  PoseSourceSpec pose_source_;
  Metronome laser_beat_, encoder_beat_, fix_beat_;
  LaserSim laser_;
  bool laser_turns_, turning_ = false;
  Random fix_noise_;
  LaserScan scan_;
  WheelState wheels_;
  OutsideFix fix_;
};

}  // namespace jaywalk::sim
