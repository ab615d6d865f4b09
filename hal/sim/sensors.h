#pragma once
// What the controller gets to see of the world, each device at its own rate, faults included.
#include <cstdint>
#include <vector>

#include "hal/hal.h"
#include "hal/sim/laser_sim.h"
#include "hal/sim/random.h"
#include "hal/sim/scenario.h"
#include "hal/sim/world.h"
#include "hal/types/fixed_vector.h"
#include "hal/types/operator_input.h"

namespace jaywalk::sim {

/// True at the first call at or after each multiple of a period, put off by a share `phase` of it.
class Metronome {
 public:
  explicit Metronome(double rate_hz, double phase = 0.0) : rate_hz_(rate_hz), beats_(phase) {}
  [[nodiscard]] bool due(Time now) noexcept;

 private:
  double rate_hz_;
  double beats_;
};

class Sensors {
 public:
  Sensors(const Scenario& scenario, std::uint64_t seed);

  /// Call after every step of the world, and once before the first.
  void sense(World& world) noexcept;

  [[nodiscard]] const LaserScan& scan(std::size_t scanner) const noexcept { return scanners_[scanner].scan; }
  [[nodiscard]] const WheelState& wheels() const noexcept { return wheels_; }
  [[nodiscard]] const OutsideFix& fix() const noexcept { return fix_; }

 private:
  /// One of the robot's lasers, with a rate and a clock of its own.
  struct Scanner {
    std::size_t index;
    Metronome beat;
    LaserSim laser;
    Random rain;
    bool turns, turning = false;
    LaserScan scan{};
  };
  static void sense(Scanner& scanner, const World& world) noexcept;
  static void look(Scanner& scanner, const World& world) noexcept;
  static void turn(Scanner& scanner, const World& world) noexcept;
  static void spoil(Scanner& scanner, const World& world) noexcept;
  void locate(const Truth& truth) noexcept;
  void report(World& world) noexcept;
  void deliver_reports(Time now) noexcept;

  ReportSpec reports_;
  PoseSourceSpec pose_source_;
  std::vector<Scanner> scanners_;
  Metronome encoder_beat_, fix_beat_;
  Random fix_noise_, delay_;
  static constexpr std::size_t kMostUnderWay = 256;
  FixedVector<WheelState, kMostUnderWay>
      under_way_;  ///< readings that come late; of [robot.reports]: 1 ms, 200 ms late
  WheelState wheels_;
  OutsideFix fix_;
};

// A person with a stick, scripted: what drives a simulated robot by hand, so that anyone can repeat it.

struct Truth;

/// Holds a stick full ahead whatever comes, points it at the goal, or moves it by a table. What the hand does comes
/// late, and trembles. Thread: the simulation's.
class ScriptedStick {
 public:
  /// Throws StartupError for a table that is none.
  ScriptedStick(const StickSpec& spec, const Scenario& scenario, std::uint64_t seed);

  /// Where the stick stands now; call with times that do not fall.
  [[nodiscard]] Stick at(const Truth& truth) noexcept;

 private:
  struct Row {
    double t_s = 0.0;
    Stick stick;
  };

  [[nodiscard]] Stick meant(const Truth& truth) const noexcept;
  [[nodiscard]] Stick meant_to_goal(const Truth& truth) const noexcept;
  [[nodiscard]] Stick delayed(double now_s) noexcept;
  void tremble(double dt_s) noexcept;

  StickSpec spec_;
  Vec2 goal_;
  double arrives_within_m_;
  std::vector<Row> table_;
  std::vector<Row> meant_;  ///< what was meant within the last second: a ring
  std::size_t next_ = 0;
  Random random_;
  double off_forward_ = 0.0, off_left_ = 0.0;  ///< of the hand
  double before_s_ = 0.0;
};

}  // namespace jaywalk::sim
