#pragma once
// What the controller gets to see of the world, each device at its own rate, faults included.
#include <cstdint>
#include <span>
#include <vector>

#include "hal/sim/random.h"
#include "hal/sim/scenario.h"
#include "hal/sim/walls.h"
#include "hal/sim/world.h"
#include "hal/types/fixed_vector.h"
#include "hal/types/laser_scan.h"
#include "hal/types/operator_input.h"
#include "hal/types/robot_model.h"

namespace jaywalk::sim {

/// A planar laser: every beam at once, or one after another as it turns; Gaussian range noise, beams that get lost.
/// Ranges as LaserScan has them. Memory is taken at construction.
class LaserSim {
 public:
  /// `index` tells apart the noise of several.
  LaserSim(const LaserModel& model, std::uint64_t seed, std::uint64_t index = 0);

  /// Writes the sweep of a scanner that measures all beams at once, from where the robot stands. Keeps scan.sequence.
  void sweep(const Walls& walls, std::span<const Disc> movers, const Pose2& map_from_robot, Time now,
             LaserScan& scan) noexcept {
    begin_turn(now);
    turn(walls, movers, map_from_robot, now, scan);
  }

  /// From the first beam to the last: 0 of a scanner that does not turn.
  [[nodiscard]] Duration turn_takes() const noexcept {
    return model_.turns ? duration_from_seconds(model_.fov_rad / (2.0 * kPi) / model_.rate_hz) : Duration{0};
  }
  /// Begins a turn: forgets what was measured.
  void begin_turn(Time now) noexcept { began_ = now, measured_ = 0; }
  /// Measures the beams whose time has come; `movers` are round. With the last it writes the scan, of the turn's begin,
  /// and returns true.
  bool turn(const Walls& walls, std::span<const Disc> movers, const Pose2& map_from_robot, Time now,
            LaserScan& scan) noexcept;

 private:
  void write(LaserScan& scan) noexcept;
  [[nodiscard]] float measured(double range) noexcept {
    const bool lost = loss_.uniform() < model_.drop_out;
    const double noisy = range + model_.noise_m * noise_.normal();
    if (lost || noisy < model_.range_min_m) return 0.0F;
    return noisy <= model_.range_max_m ? static_cast<float>(noisy) : std::numeric_limits<float>::infinity();
  }

  LaserModel model_;
  std::vector<Vec2> in_laser_;  ///< each beam's direction
  std::vector<Vec2> in_map_;
  std::vector<double> range_;  ///< true ranges of the sweep under way
  Time began_ = kNever;        ///< of a turn
  std::size_t measured_ = 0;   ///< beams of it
  Random noise_;
  Random loss_;
};

/// True at the first call at or after each multiple of a period, put off by a share `phase` of it.
class Metronome {
 public:
  explicit Metronome(double rate_hz, double phase = 0.0) : rate_hz_(rate_hz), beats_(phase) {}
  [[nodiscard]] bool due(Time now) noexcept {
    const bool is_due = now >= time_from_seconds(beats_ / rate_hz_);
    if (is_due) beats_ += 1.0;
    return is_due;
  }

 private:
  double rate_hz_, beats_;
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
    bool turning = false;
    LaserScan scan{};
  };
  static void sense(Scanner& scanner, const World& world) noexcept;
  static void look(Scanner& scanner, const World& world) noexcept;
  static void turn(Scanner& scanner, const World& world) noexcept;
  static void spoil(Scanner& scanner, const World& world) noexcept;
  void locate(const Truth& truth) noexcept;
  void report(World& world) noexcept {
    WheelState reading = world.plant().read_encoders(world.now());
    if (reports_.late_s > 0.0) reading.stamp += duration_from_seconds(reports_.late_s * delay_.uniform());
    if (!under_way_.empty()) reading.stamp = std::max(reading.stamp, under_way_.back().stamp);
    (void)under_way_.push_back(reading);
  }
  void deliver_reports(Time now) noexcept {
    std::size_t due = 0;  // stamps do not fall
    while (due < under_way_.size() && under_way_[due].stamp <= now) wheels_ = under_way_[due++];
    if (due == 0) return;
    std::copy(under_way_.begin() + due, under_way_.end(), under_way_.begin());
    under_way_.truncate(under_way_.size() - due);
  }

  ReportSpec reports_;
  PoseSourceSpec pose_source_;
  std::vector<Scanner> scanners_;
  Metronome encoder_beat_, fix_beat_;
  Random fix_noise_, delay_;
  static constexpr std::size_t kMostUnderWay = 256;   ///< of [robot.reports]: 1 ms, 200 ms late
  FixedVector<WheelState, kMostUnderWay> under_way_;  ///< readings that come late
  WheelState wheels_;
  OutsideFix fix_;
};

/// A scripted person who holds a stick full ahead, points it at the goal, or moves it by a table. What the hand does
/// comes late, and trembles. Thread: the simulation's.
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
