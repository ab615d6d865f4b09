#pragma once
// What a drive leaves for a calibration: the wheels' turns all along, and scans a piece of way apart.
#include <cstdint>
#include <vector>

#include "hal/types/laser_scan.h"
#include "hal/types/robot_model.h"
#include "hal/types/wheels.h"

namespace jaywalk {

/// What both wheels had turned by then (rad).
struct WheelTurns {
  Time stamp = kNever;
  double left_rad = 0.0, right_rad = 0.0;
};

class CalibrationLog {
 public:
  /// `drive`: what is believed; it decides when a scan is far enough from the one before. At most kMostScans are kept.
  explicit CalibrationLog(const DriveModel& drive) : drive_(drive) {}

  static constexpr std::size_t kMostScans = 2000;
  /// A scan is kept after so much way of the middle, or so much turn.
  static constexpr double kApart_m = 0.4, kApart_rad = 0.5;

  /// A tick's newest reading and scan; the same ones again are passed over.
  void take(const WheelState& wheels, const LaserScan& scan);

  [[nodiscard]] const std::vector<WheelTurns>& wheels() const { return wheels_; }
  [[nodiscard]] const std::vector<LaserScan>& scans() const { return scans_; }
  /// Between two readings, and straight on before the first and after the last.
  [[nodiscard]] WheelTurns at(Time stamp) const;
  /// The readings from one time to another, with the turns at both ends; readings that jump or are late leave it empty.
  [[nodiscard]] std::vector<WheelTurns> between(Time from, Time to) const;

 private:
  [[nodiscard]] bool is_far_from_last() const;

  DriveModel drive_;
  std::uint32_t wheel_sequence_ = 0, scan_sequence_ = 0;
  WheelTurns at_last_scan_;
  std::vector<WheelTurns> wheels_;
  std::vector<LaserScan> scans_;
};

}  // namespace jaywalk
