#pragma once
#include <cstdint>

#include "hal/types/laser_scan.h"
#include "hal/types/robot_model.h"
#include "hal/types/wheels.h"

namespace jaywalk {

/// Notices a scanner that sends what it saw once again and again, with new stamps, while the wheels drive: no two scans
/// of a real one are the same to the last bit. Thread: the loop's.
class FrozenScan {
 public:
  explicit FrozenScan(const DriveModel& drive) : drive_(drive) {}

  /// Once a tick, with the newest scan and reading. True from the third such scan on, once a wheel has rolled 0.1 m
  /// since the first, until one differs. False where no beam hits anything, and without wheels.
  [[nodiscard]] bool is_frozen(const LaserScan& scan, const WheelState& wheels) noexcept;

 private:
  DriveModel drive_;
  std::uint32_t scan_seen_ = 0;
  std::uint64_t digest_ = 0;  ///< of the ranges that hit something; 0: none did
  int alike_ = 0;             ///< scans in a row with that digest
  WheelState at_first_;       ///< the reading when the first of them came
};

}  // namespace jaywalk
